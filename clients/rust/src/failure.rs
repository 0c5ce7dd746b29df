//! Failed calls, and the errors that they become.

use prost::Message;
use tonic::{Code, Status};

use crate::api;
use crate::errors::{Error, Problem, Reason};
use crate::hints::with_functions;

/// Reasons that the daemon may give before it compares the request's id with earlier requests.
const BEFORE_MEMORY: [&str; 9] = [
    "INVALID_REQUEST",
    "UNKNOWN_DEVICE",
    "UNKNOWN_AXIS",
    "QUEUE_FULL",
    "NOT_ALLOWED",
    "UNAUTHENTICATED",
    "LEASE_LOST",
    "INTERNAL",
    "REQUEST_ID_REUSED",
];

/// A Failure is a call that ended without an answer.
#[derive(Clone, Debug)]
pub struct Failure {
    pub code: Code,
    pub text: String,
    /// None: the daemon did not report a problem.
    pub problem: Option<Box<api::Problem>>,
    /// False if no byte of the request can have reached the daemon.
    pub sent: bool,
}

/// Details is the part of `google.rpc.Status` in which the daemon reports a problem.
#[derive(Clone, PartialEq, Message)]
struct Details {
    #[prost(message, repeated, tag = "3")]
    details: Vec<prost_types::Any>,
}

impl Failure {
    pub fn new(status: &Status, sent: bool) -> Failure {
        let details = Details::decode(status.details()).unwrap_or_default().details;
        let problem = details.iter().find(|detail| detail.type_url.ends_with("/axisgate.v1.Problem"));
        let problem = problem.and_then(|detail| api::Problem::decode(&*detail.value).ok()).map(Box::new);
        Failure { code: status.code(), text: status.message().to_string(), problem, sent }
    }

    /// Returns the failure of a stream that the daemon ended without a reason.
    pub fn of_ended_stream() -> Failure {
        Failure { code: Code::Unknown, text: "the daemon ended the answer".to_string(), problem: None, sent: true }
    }

    /// Returns the reason, or None if the answer was lost.
    pub fn reason(&self) -> Option<Reason> {
        match &self.problem {
            Some(problem) => Some(reason_of(problem.reason)),
            None => early(self.code).map(Reason::new),
        }
    }

    pub fn is(&self, reason: &str) -> bool {
        self.reason().is_some_and(|own| own == *reason)
    }

    /// Reports whether the answer was lost, so that the request may have acted.
    pub fn lost(&self) -> bool {
        self.problem.is_none() && early(self.code).is_none()
    }

    /// Reports whether the same request may succeed a moment later.
    pub fn passing(&self) -> bool {
        self.lost() || self.code == Code::Unavailable
    }

    /// Reports whether this refusal of a repeat means that the first request did not act either.
    pub fn decides_repeat(&self) -> bool {
        !self.passing() && !self.reason().is_some_and(|reason| BEFORE_MEMORY.contains(&reason.as_str()))
    }

    pub fn code_name(&self) -> String {
        format!("{:?}", self.code)
    }

    /// Returns the error of a call that is not repeated. `target` is the daemon's address.
    pub fn error(&self, target: &str) -> Error {
        match (&self.problem, self.reason()) {
            (Some(problem), _) => classified(problem_of(problem, self.code_name())),
            (None, Some(reason)) => {
                let (message, code) = (self.text.clone(), self.code_name());
                Error::Refused(Box::new(Problem { reason, message, code, ..Problem::default() }))
            }
            (None, None) if !self.sent => self.unavailable(target),
            (None, None) => {
                let message = format!("the answer of the daemon at {target} was lost: {}", self.text);
                Error::look_first(message, &self.code_name())
            }
        }
    }

    /// Returns the error of a request that acted nowhere because the daemon did not answer.
    pub fn unavailable(&self, target: &str) -> Error {
        Error::Refused(Box::new(Problem {
            reason: Reason::UNAVAILABLE,
            message: format!("no daemon answers at {target}: {}", self.text),
            hint: "start axisgated, or set AXISGATE_TARGET to its address".to_string(),
            code: self.code_name(),
            ..Problem::default()
        }))
    }
}

/// Returns the reason of a call that the daemon refuses before it can send a problem. RESOURCE_EXHAUSTED has none: tonic
/// also reports it for a stream that was reset.
fn early(code: Code) -> Option<&'static str> {
    match code {
        Code::Unauthenticated => Some("UNAUTHENTICATED"),
        Code::PermissionDenied => Some("NOT_ALLOWED"),
        Code::Unimplemented => Some("UNIMPLEMENTED"),
        _ => None,
    }
}

pub fn reason_of(number: i32) -> Reason {
    match api::Reason::try_from(number) {
        Ok(reason) => Reason::new(reason.as_str_name().trim_start_matches("REASON_")),
        Err(_) => Reason::new(format!("REASON {number}")),
    }
}

/// Returns the public form of a problem. An empty code: the problem is not the answer to a call.
pub fn problem_of(problem: &api::Problem, code: String) -> Problem {
    Problem {
        reason: reason_of(problem.reason),
        message: problem.message.clone(),
        hint: with_functions(&problem.hint, problem.axis),
        axis: problem.axis,
        sent: problem.sent.clone(),
        wire_reply: problem.wire_reply.clone(),
        code,
    }
}

/// Returns the error for a problem. Most reasons are refusals.
pub fn classified(problem: Problem) -> Error {
    let problem = Box::new(problem);
    match problem.reason.as_str() {
        "STOPPED" => Error::Stopped(problem),
        "TARGET_NOT_REACHED" => Error::MotionFailed(problem),
        "OUTCOME_UNKNOWN" | "REQUEST_MEMORY_LOST" => Error::OutcomeUnknown(problem),
        _ => Error::Refused(problem),
    }
}

/// Returns the error of a stop. A stop that reached no daemon is not Refused: the axes may be moving.
pub fn undelivered(error: Error) -> Error {
    match error {
        Error::Refused(problem) if Error::Refused(problem.clone()).is_unavailable() => {
            Error::OutcomeUnknown(Box::new(Problem {
                message: format!("the stop was not delivered: {}", problem.message),
                hint: "press the emergency stop at the device".to_string(),
                ..*problem
            }))
        }
        other => other,
    }
}
