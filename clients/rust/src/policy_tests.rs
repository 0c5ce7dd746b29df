//! Tests of what decides: repeats, following, the cursor, and the errors of failed calls.

use std::time::{Duration, Instant};

use prost::Message;
use tonic::{Code, Status};

use crate::api;
use crate::cursor::Cursor;
use crate::errors::{Error, Reason, Result};
use crate::failure::{reason_of, Failure};
use crate::following::{own, Following, LOST_LIMIT};
use crate::hints::with_functions;
use crate::repeat::Repeat;
use crate::results::outcome_of;
use crate::session::inherited_token;

fn broken() -> Failure {
    Failure { code: Code::Unavailable, text: "the connection was reset".to_string(), problem: None, sent: true }
}

fn never() -> Failure {
    Failure { sent: false, ..broken() }
}

fn refusal(reason: &str, code: Code) -> Failure {
    let number = api::Reason::from_str_name(&format!("REASON_{reason}")).expect("a known reason") as i32;
    refusal_of(number, code)
}

fn refusal_of(reason: i32, code: Code) -> Failure {
    let problem = api::Problem { reason, message: "a sentence.".to_string(), ..api::Problem::default() };
    Failure { code, text: String::new(), problem: Some(Box::new(problem)), sent: true }
}

fn action(start: Instant, remembered: bool) -> Repeat {
    Repeat::action(start + Duration::from_secs(5), "here", Duration::from_secs(3), remembered)
}

/// Returns the pauses in ms until the error, on a clock that only pauses move.
fn pauses(mut repeat: Repeat, failure: &Failure, start: Instant) -> (Vec<u128>, Error) {
    let (mut now, mut all) = (start, Vec::new());
    loop {
        match repeat.after(failure, now) {
            Ok(pause) => {
                now += pause;
                all.push(pause.as_millis());
            }
            Err(error) => return (all, error),
        }
    }
}

#[test]
fn a_lost_answer_is_repeated() {
    let start = Instant::now();
    let (all, error) = pauses(action(start, true), &broken(), start);
    assert_eq!(all, [250, 500, 1000, 2000, 1250]);
    assert!(matches!(error, Error::OutcomeUnknown(_)));
}

#[test]
fn the_time_limit_covers_the_answer() {
    let start = Instant::now();
    let repeat = action(start, true);
    assert_eq!(repeat.timeout(start + Duration::from_secs(1)), Duration::from_secs(7));
    assert_eq!(repeat.timeout(start + Duration::from_secs(9)), Duration::from_secs(3));
}

#[test]
fn without_any_connection_nothing_acted() {
    let start = Instant::now();
    let (all, error) = pauses(action(start, true), &never(), start);
    assert_eq!(all.len(), 5);
    assert!(error.is_unavailable());
}

#[test]
fn no_connection_after_a_lost_answer() {
    let start = Instant::now();
    let mut repeat = action(start, true);
    assert!(repeat.after(&broken(), start).is_ok());
    assert!(matches!(pauses(repeat, &never(), start).1, Error::OutcomeUnknown(_)));
}

#[test]
fn a_refusal_is_final() {
    let start = Instant::now();
    let error = action(start, true).after(&refusal("OUTSIDE_TRAVEL", Code::OutOfRange), start).unwrap_err();
    assert!(matches!(&error, Error::Refused(p) if p.reason == Reason::OUTSIDE_TRAVEL) && !error.is_unavailable());
}

#[test]
fn unavailable_is_repeated() {
    let start = Instant::now();
    let (all, error) = pauses(action(start, true), &refusal("LINK_DOWN", Code::Unavailable), start);
    assert!(all.len() == 5 && error.is_unavailable());
}

#[test]
fn a_refusal_after_a_lost_answer() {
    let decided = [("OUTSIDE_TRAVEL", true), ("DEADLINE_PASSED", true)];
    let open = [("LEASE_LOST", false), ("UNAUTHENTICATED", false), ("REQUEST_MEMORY_LOST", false)];
    for (reason, decides) in decided.into_iter().chain(open) {
        let start = Instant::now();
        let mut repeat = action(start, true);
        assert!(repeat.after(&broken(), start).is_ok());
        let error = repeat.after(&refusal(reason, Code::FailedPrecondition), start).unwrap_err();
        assert_eq!(matches!(error, Error::Refused(_)), decides, "{error}");
        assert_eq!(matches!(error, Error::OutcomeUnknown(_)), !decides, "{error}");
    }
}

#[test]
fn without_a_memory_a_lost_answer_is_not_repeated() {
    let start = Instant::now();
    let mut repeat = action(start, false);
    assert!(repeat.after(&never(), start).is_ok());
    assert!(matches!(repeat.after(&broken(), start), Err(Error::OutcomeUnknown(_))));
}

#[test]
fn a_question_is_repeated() {
    let start = Instant::now();
    let repeat = Repeat::question(start + Duration::from_secs(5), "here", Duration::from_secs(3));
    let (all, error) = pauses(repeat, &broken(), start);
    assert!(all.len() == 5 && error.is_unavailable());
}

fn motion(request_id: &str) -> api::Motion {
    let name = "devices/stage/motions/1".to_string();
    api::Motion { name, request_id: request_id.to_string(), ..api::Motion::default() }
}

fn is_unknown<T>(result: Result<T>) -> bool {
    matches!(result, Err(Error::OutcomeUnknown(_)))
}

#[test]
fn waits_in_parts() {
    let following = Following::new(motion("a"), "here", Instant::now());
    for (left, wait) in [(None, 10), (Some(100), 10), (Some(3), 3), (Some(0), 0)] {
        let (request, limit) = following.question(left.map(Duration::from_secs));
        assert_eq!(request.max_wait.map(|wait| wait.seconds), Some(wait as i64));
        assert_eq!(limit, Duration::from_secs(wait + 5));
    }
}

#[test]
fn follows_over_broken_connections() {
    let start = Instant::now();
    let mut following = Following::new(motion("a"), "here", start);
    let pauses = [0; 7].map(|_| following.after(&broken(), start).unwrap().as_millis());
    assert_eq!(pauses, [250, 500, 1000, 2000, 4000, 5000, 5000]);
    let answered = start + Duration::from_secs(50);
    following.take(motion("a"), answered).unwrap();
    let second = Duration::from_secs(1);
    assert_eq!(following.after(&never(), answered + LOST_LIMIT - second).unwrap().as_millis(), 250);
    assert!(is_unknown(following.after(&never(), answered + LOST_LIMIT + second)));
}

#[test]
fn a_motion_that_is_no_longer_kept_is_unknown() {
    let mut following = Following::new(motion("a"), "here", Instant::now());
    assert!(is_unknown(following.after(&refusal("NOT_FOUND", Code::NotFound), Instant::now())));
    assert!(is_unknown(following.take(motion("b"), Instant::now())));
}

#[test]
fn a_motion_of_another_request_is_not_taken() {
    assert!(is_unknown(own(motion("b"), "a")));
}

#[test]
fn every_reason_has_an_error() {
    for number in 0..60 {
        let failure = refusal_of(number, Code::FailedPrecondition);
        let error = failure.error("here");
        assert_eq!(error.problem().map(|problem| problem.reason.clone()), Some(reason_of(number)));
    }
    assert_eq!(reason_of(999), "REASON 999");
}

#[test]
fn the_details_of_an_error_are_read() {
    let problem = api::Problem {
        reason: api::Reason::LeaseHeld as i32,
        message: "a sentence.".to_string(),
        hint: "acquire it: `AcquireLease`".to_string(),
        axis: Some(2),
        ..api::Problem::default()
    };
    let type_url = b"type.googleapis.com/axisgate.v1.Problem";
    let any = prost_types::Any { type_url: String::from_utf8_lossy(type_url).into(), value: problem.encode_to_vec() };
    // google.rpc.Status: field 3, details
    let any = any.encode_to_vec();
    let mut details = vec![3 << 3 | 2];
    prost::encoding::encode_varint(any.len() as u64, &mut details);
    details.extend(any);
    let status = Status::with_details(Code::FailedPrecondition, "text", details.into());
    let error = Failure::new(&status, true).error("here");
    assert_eq!(error.to_string(), "LEASE_HELD: a sentence. (acquire it: `stage.lease([2])`)");
    assert!(error.problem().is_some_and(|problem| problem.axis == Some(2) && problem.code == "FailedPrecondition"));
}

#[test]
fn early_refusals_have_reasons() {
    for (code, reason) in [(Code::Unauthenticated, "UNAUTHENTICATED"), (Code::PermissionDenied, "NOT_ALLOWED")] {
        let failure = Failure { code, ..broken() };
        assert!(!failure.lost() && matches!(failure.error("here"), Error::Refused(p) if p.reason == reason));
    }
    assert!(Failure { code: Code::ResourceExhausted, ..broken() }.lost());
}

#[test]
fn outcomes_are_errors() {
    let ended = |state: api::MotionState| outcome_of(&api::Motion { state: state as i32, ..motion("a") });
    assert!(matches!(ended(api::MotionState::Stopped), Err(Error::Stopped(_))));
    assert!(matches!(ended(api::MotionState::Failed), Err(Error::MotionFailed(_))));
    assert!(is_unknown(ended(api::MotionState::Unknown)));
}

#[test]
fn hints_name_functions() {
    assert_eq!(with_functions("home it: `Home`", Some(1)), "home it: `stage.home([1])`");
    assert_eq!(with_functions("see `ListHistory` or `Rearm`", None), "see `ListHistory` or `stage.rearm()`");
}

#[test]
fn the_cursor_resumes_after_the_last_event() {
    let mut cursor = Cursor { device: "devices/stage".to_string(), first: 0, run: String::new() };
    assert_eq!(cursor.request().from_revision, Some(0));
    cursor.take(7, "a".to_string());
    assert_eq!((cursor.request().from_revision, cursor.request().run.as_str()), (Some(8), "a"));
    let mut compacted = refusal("COMPACTED", Code::OutOfRange);
    let metadata = &mut compacted.problem.as_mut().unwrap().metadata;
    metadata.insert("resume_revision".to_string(), "40".to_string());
    assert_eq!(cursor.gap_after(&compacted), Some(40));
    assert_eq!((cursor.request().from_revision, cursor.request().run.as_str()), (Some(40), ""));
    assert_eq!(cursor.gap_after(&broken()), None);
}

#[test]
fn an_inherited_lease_is_checked() {
    assert!(inherited_token("").unwrap().is_empty());
    assert_eq!(inherited_token(&"0f".repeat(24)).unwrap().len(), 24);
    for wrong in ["zz", "00ff", "+1", "ä"] {
        assert!(matches!(inherited_token(wrong), Err(Error::InvalidArgument(_))));
    }
}
