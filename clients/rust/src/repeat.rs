//! The decision whether a request is sent again.

use std::time::{Duration, Instant};

use crate::errors::{Error, Result};
use crate::failure::Failure;

const FIRST_PAUSE: Duration = Duration::from_millis(250);
const LONGEST_PAUSE: Duration = Duration::from_secs(5);

/// A Backoff is a series of pauses, each twice as long as the previous one. It begins with the shortest.
#[derive(Default)]
pub struct Backoff(Duration);

impl Backoff {
    pub fn pause(&mut self) -> Duration {
        self.0 = (2 * self.0).clamp(FIRST_PAUSE, LONGEST_PAUSE);
        self.0
    }
}

/// A Repeat decides after each failed attempt whether the same request is sent again. It has no clock and no
/// connection.
pub struct Repeat {
    /// Latest time of an attempt.
    pub until: Instant,
    /// The daemon's address.
    pub target: String,
    /// Time for the answer to an attempt.
    pub answer: Duration,
    /// False for a question, which may always be repeated.
    pub acts: bool,
    /// False if the daemon does not remember requests: a request that acts is then not repeated once it may have reached
    /// the daemon.
    pub remembered: bool,
    backoff: Backoff,
    may_have_acted: bool,
}

impl Repeat {
    /// Returns the decisions for a question.
    pub fn question(until: Instant, target: &str, answer: Duration) -> Repeat {
        let target = target.to_string();
        let backoff = Backoff::default();
        Repeat { until, target, answer, acts: false, remembered: false, backoff, may_have_acted: false }
    }

    /// Returns the decisions for a request that acts.
    pub fn action(until: Instant, target: &str, answer: Duration, remembered: bool) -> Repeat {
        Repeat { acts: true, remembered, ..Repeat::question(until, target, answer) }
    }

    /// Returns the time limit of the attempt that is sent now.
    pub fn timeout(&self, now: Instant) -> Duration {
        self.until.saturating_duration_since(now) + self.answer
    }

    /// Returns the pause after which the same request is sent again, or the error with which the call ends.
    pub fn after(&mut self, failure: &Failure, now: Instant) -> Result<Duration> {
        self.may_have_acted |= self.acts && failure.lost() && failure.sent;
        if self.may_be_repeated(failure) {
            let pause = self.backoff.pause().min(self.until.saturating_duration_since(now));
            if !pause.is_zero() {
                return Ok(pause);
            }
        }
        Err(self.error(failure))
    }

    fn may_be_repeated(&self, failure: &Failure) -> bool {
        if self.may_have_acted && !self.remembered {
            return false;
        }
        failure.passing() || (self.may_have_acted && failure.is("QUEUE_FULL"))
    }

    fn error(&self, failure: &Failure) -> Error {
        if !self.acts && failure.lost() {
            return failure.unavailable(&self.target);
        }
        let error = failure.error(&self.target);
        if !self.may_have_acted || failure.decides_repeat() || matches!(error, Error::OutcomeUnknown(_)) {
            return error;
        }
        let message = format!("the answer to the request was lost, and a repeat was refused: {error}");
        Error::look_first(message, &failure.code_name())
    }
}
