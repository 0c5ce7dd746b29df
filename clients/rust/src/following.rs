//! The check of a started motion, and the questions for its outcome.

use std::time::{Duration, Instant};

use crate::api;
use crate::errors::{Error, Problem, Reason, Result};
use crate::failure::Failure;
use crate::repeat::Backoff;

/// Time without an answer after which the outcome of a motion counts as unknown.
pub const LOST_LIMIT: Duration = Duration::from_secs(60);
/// Longest wait of one question for an outcome.
const WAIT_PART: Duration = Duration::from_secs(10);
/// Time for the answer to a question, in addition to its wait.
const ANSWER_TIME: Duration = Duration::from_secs(5);

/// A Following asks for the outcome of one motion, also over broken connections and restarts of the daemon. It has no
/// clock and no connection.
pub struct Following {
    pub motion: api::Motion,
    target: String,
    answered: Instant,
    backoff: Backoff,
}

impl Following {
    pub fn new(motion: api::Motion, target: &str, now: Instant) -> Following {
        Following { motion, target: target.to_string(), answered: now, backoff: Backoff::default() }
    }

    /// Returns the next request, which waits at most `wait`, and its time limit. None: no limit.
    pub fn question(&self, wait: Option<Duration>) -> (api::WaitMotionRequest, Duration) {
        let wait = wait.map_or(WAIT_PART, |wait| wait.min(WAIT_PART));
        let request = api::WaitMotionRequest { motion: self.motion.name.clone(), max_wait: Some(api::duration(wait)) };
        (request, wait + ANSWER_TIME)
    }

    /// Takes an answer. Fails if the answer is about another motion: a daemon without a journal gives the names of
    /// motions again after a restart.
    pub fn take(&mut self, motion: api::Motion, now: Instant) -> Result<()> {
        self.answered = now;
        self.backoff = Backoff::default();
        if motion.request_id != self.motion.request_id {
            return Err(self.unknown("the daemon was restarted, and no longer has the motion"));
        }
        self.motion = motion;
        Ok(())
    }

    /// Returns the pause after which the daemon is asked again, or the error with which following ends.
    pub fn after(&mut self, failure: &Failure, now: Instant) -> Result<Duration> {
        if !failure.passing() && !failure.is("QUEUE_FULL") {
            return Err(self.unknown(&format!("its outcome cannot be read: {}", failure.error(&self.target))));
        }
        if now.saturating_duration_since(self.answered) > LOST_LIMIT {
            return Err(self.unknown(&format!("the daemon has not answered for {} s", LOST_LIMIT.as_secs())));
        }
        Ok(self.backoff.pause())
    }

    fn unknown(&self, why: &str) -> Error {
        Error::OutcomeUnknown(Box::new(Problem {
            reason: Reason::OUTCOME_UNKNOWN,
            message: format!("the outcome of {} is unknown: {why}", self.motion.name),
            hint: "look at the stage before you repeat the motion".to_string(),
            ..Problem::default()
        }))
    }
}

/// Returns the motion, or an error if another request started it.
pub fn own(motion: api::Motion, request_id: &str) -> Result<api::Motion> {
    if motion.request_id == request_id {
        return Ok(motion);
    }
    Err(Error::look_first(format!("the daemon answered with {}, which another request started", motion.name), ""))
}
