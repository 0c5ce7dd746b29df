use std::borrow::Cow;
use std::error::Error as StdError;
use std::fmt;

/// Result of a call of this crate.
pub type Result<T, E = Error> = std::result::Result<T, E>;

/// An Error says how a call ended, and what that means for the axes.
#[derive(Debug)]
#[non_exhaustive]
pub enum Error {
    /// The request was refused: nothing moved. [`Error::is_unavailable`] tells refusals because nobody answers.
    Refused(Box<Problem>),
    /// A stop ended the motion, or prevented it.
    Stopped(Box<Problem>),
    /// The motion ended with an error of the stage.
    MotionFailed(Box<Problem>),
    /// The outcome is unknown. The axes may be moving: look at the stage before you repeat the request.
    OutcomeUnknown(Box<Problem>),
    /// An argument is wrong. Nothing was sent.
    InvalidArgument(String),
    /// The iterator of a path returned this error. Nothing was sent.
    Points(Box<dyn StdError + Send + Sync>),
}

impl Error {
    /// Returns the problem that the daemon reports, or that the connection to it causes.
    pub fn problem(&self) -> Option<&Problem> {
        match self {
            Error::Refused(p) | Error::Stopped(p) | Error::MotionFailed(p) | Error::OutcomeUnknown(p) => Some(p),
            Error::InvalidArgument(_) | Error::Points(_) => None,
        }
    }

    /// Reports whether the request was refused because the daemon or the controller cannot be reached.
    pub fn is_unavailable(&self) -> bool {
        matches!(self, Error::Refused(problem) if UNAVAILABLE.contains(&problem.reason.as_str()))
    }

    pub(crate) fn invalid(message: impl Into<String>) -> Error {
        Error::InvalidArgument(message.into())
    }

    /// Returns the error of a request that may have acted.
    pub(crate) fn look_first(message: String, code: &str) -> Error {
        let hint = "look at the stage before you repeat the request".to_string();
        let code = code.to_string();
        let problem = Problem { reason: Reason::OUTCOME_UNKNOWN, message, hint, code, ..Problem::default() };
        Error::OutcomeUnknown(Box::new(problem))
    }
}

const UNAVAILABLE: [&str; 8] = [
    "UNAVAILABLE",
    "LINK_DOWN",
    "NOT_SENT",
    "REPLY_TIMED_OUT",
    "LINE_FAULT",
    "COMPLETION_OUTSTANDING",
    "JOURNAL_UNAVAILABLE",
    "DAEMON_ENDING",
];

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Error::Refused(p) | Error::Stopped(p) | Error::MotionFailed(p) | Error::OutcomeUnknown(p) => p.fmt(f),
            Error::InvalidArgument(message) => f.write_str(message),
            Error::Points(error) => write!(f, "the points of the path cannot be computed: {error}"),
        }
    }
}

impl StdError for Error {
    fn source(&self) -> Option<&(dyn StdError + 'static)> {
        match self {
            Error::Points(error) => Some(error.as_ref()),
            _ => None,
        }
    }
}

/// A Problem is what happened, where, why, and what the caller can do.
#[derive(Clone, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct Problem {
    /// Stable name of what went wrong. Programs should compare it, never the message.
    pub reason: Reason,
    /// One sentence for people.
    pub message: String,
    /// Advice to the caller, in the terms of this crate. May be empty.
    pub hint: String,
    /// Number of the axis, from 1. None: the problem does not concern a single axis.
    pub axis: Option<i32>,
    /// Command line concerned. May be empty.
    pub sent: String,
    /// The controller's reply. May be empty.
    pub wire_reply: String,
    /// Name of the gRPC code, such as "OutOfRange". Empty: the error is not the answer to a call.
    pub code: String,
}

impl fmt::Display for Problem {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: {}", self.reason, self.message)?;
        if self.hint.is_empty() {
            return Ok(());
        }
        write!(f, " ({})", self.hint)
    }
}

/// A Reason is the stable name of what went wrong: "OUTSIDE_TRAVEL". A reason that this crate does not know is
/// "REASON 99". The enum `Reason` of the API's `common.proto` lists all reasons.
///
/// ```
/// # use axisgate::{Error, Reason};
/// # fn handle(error: Error) {
/// match error {
///     Error::Refused(p) if p.reason == Reason::LEASE_HELD => println!("later: {}", p.message),
///     Error::Refused(p) if p.reason == "TOO_FAST" => println!("slower: {}", p.hint),
///     other => println!("{other}"),
/// }
/// # }
/// ```
#[derive(Clone, Debug, Default, PartialEq, Eq, Hash)]
pub struct Reason(Cow<'static, str>);

impl Reason {
    /// The target is outside the travel limits of the axis.
    pub const OUTSIDE_TRAVEL: Reason = Reason(Cow::Borrowed("OUTSIDE_TRAVEL"));
    /// The axis must be homed before any other motion.
    pub const NOT_HOMED: Reason = Reason(Cow::Borrowed("NOT_HOMED"));
    /// Another caller holds the axes, or moves them.
    pub const LEASE_HELD: Reason = Reason(Cow::Borrowed("LEASE_HELD"));
    /// The lease of this program has ended.
    pub const LEASE_LOST: Reason = Reason(Cow::Borrowed("LEASE_LOST"));
    /// Another caller stopped the axes. Call [`Stage::rearm`](crate::Stage::rearm) before the next motion.
    pub const STOPPED_BY: Reason = Reason(Cow::Borrowed("STOPPED_BY"));
    /// The caller's role does not allow the request.
    pub const NOT_ALLOWED: Reason = Reason(Cow::Borrowed("NOT_ALLOWED"));
    /// The token is wrong, expired or revoked, or a required token is missing.
    pub const UNAUTHENTICATED: Reason = Reason(Cow::Borrowed("UNAUTHENTICATED"));
    /// No daemon answers.
    pub const UNAVAILABLE: Reason = Reason(Cow::Borrowed("UNAVAILABLE"));
    /// The outcome is unknown.
    pub const OUTCOME_UNKNOWN: Reason = Reason(Cow::Borrowed("OUTCOME_UNKNOWN"));

    pub(crate) fn new(name: impl Into<Cow<'static, str>>) -> Reason {
        Reason(name.into())
    }

    /// Returns the name.
    pub fn as_str(&self) -> &str {
        &self.0
    }
}

impl fmt::Display for Reason {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}

impl PartialEq<str> for Reason {
    fn eq(&self, name: &str) -> bool {
        self.0 == name
    }
}

impl PartialEq<&str> for Reason {
    fn eq(&self, name: &&str) -> bool {
        self.0 == *name
    }
}
