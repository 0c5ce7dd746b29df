use std::fmt;
use std::future::IntoFuture;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

use crate::api;
use crate::errors::Result;
use crate::progress::{progress, Progress};
use crate::results::{outcome_of, MotionResult};
use crate::session::{Boxed, Session};
use crate::updates::Updates;

/// States of a motion. The last four are outcomes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum MotionState {
    /// The daemon has accepted the motion, and has not started it yet.
    Queued,
    /// The controller has accepted the start.
    Running,
    /// A stop was requested. The axes are not stationary yet.
    Stopping,
    /// The motion has reached its target.
    Succeeded,
    /// A stop ended the motion, or prevented it.
    Stopped,
    /// The motion ended with an error.
    Failed,
    /// The end could not be seen.
    Unknown,
    /// State of a newer daemon, by its number.
    Other(i32),
}

impl MotionState {
    pub(crate) fn of(number: i32) -> MotionState {
        match api::MotionState::try_from(number) {
            Ok(api::MotionState::Queued) => MotionState::Queued,
            Ok(api::MotionState::Running) => MotionState::Running,
            Ok(api::MotionState::Stopping) => MotionState::Stopping,
            Ok(api::MotionState::Succeeded) => MotionState::Succeeded,
            Ok(api::MotionState::Stopped) => MotionState::Stopped,
            Ok(api::MotionState::Failed) => MotionState::Failed,
            Ok(api::MotionState::Unknown) => MotionState::Unknown,
            Ok(api::MotionState::Unspecified) | Err(_) => MotionState::Other(number),
        }
    }
}

/// A Motion was started, and continues whatever this program does. Its clones are the same motion.
///
/// Awaiting a Motion waits for its outcome, as [`Motion::wait`] does. Dropping it, or the future of its outcome, stops
/// nothing.
#[derive(Clone)]
pub struct Motion {
    session: Session,
    message: Arc<Mutex<api::Motion>>,
}

impl Motion {
    pub(crate) fn new(session: Session, message: api::Motion) -> Motion {
        Motion { session, message: Arc::new(Mutex::new(message)) }
    }

    pub(crate) fn message(&self) -> MutexGuard<'_, api::Motion> {
        self.message.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Returns the name of the motion: "devices/stage/motions/12".
    pub fn name(&self) -> String {
        self.message().name.clone()
    }

    /// Returns the number of the motion. Numbers ascend.
    pub fn id(&self) -> i64 {
        self.name().rsplit('/').next().and_then(|id| id.parse().ok()).unwrap_or_default()
    }

    /// Returns the state as last received.
    pub fn state(&self) -> MotionState {
        MotionState::of(self.message().state)
    }

    /// Returns the id of the request that started the motion.
    pub fn request_id(&self) -> String {
        self.message().request_id.clone()
    }

    /// Reports whether the motion has its outcome. Asks the daemon if the outcome is not known yet.
    pub async fn is_done(&self) -> Result<bool> {
        self.follow(Some(Instant::now())).await?;
        Ok(self.is_over())
    }

    /// Waits for the outcome, also over broken connections and restarts of the daemon.
    ///
    /// Fails with `Stopped`, `MotionFailed` or `OutcomeUnknown` unless the motion succeeds. A time limit stops nothing:
    ///
    /// ```no_run
    /// # async fn wait(motion: axisgate::Motion) -> axisgate::Result<()> {
    /// let limit = std::time::Duration::from_secs(60);
    /// if let Ok(result) = tokio::time::timeout(limit, motion.wait()).await {
    ///     println!("{}", result?);
    /// }
    /// # Ok(())
    /// # }
    /// ```
    pub async fn wait(&self) -> Result<MotionResult> {
        self.follow(None).await?;
        outcome_of(&self.message())
    }

    /// Stops the motion, or drops it if it has not started. Has no effect on a motion with an outcome. The request is
    /// sent even if the future is dropped once it was polled.
    pub async fn cancel(&self) -> Result<()> {
        let request = api::CancelMotionRequest { context: None, motion: self.name() };
        self.session.surely(request).await.map(drop)
    }

    /// Returns the progress at each interval, until the motion has its outcome.
    pub fn progress(&self, interval: Duration) -> Updates<Progress> {
        progress(self.clone(), self.session.clone(), interval)
    }

    /// Waits for the outcome until `end`. None: no limit.
    pub(crate) async fn follow(&self, end: Option<Instant>) -> Result<()> {
        let motion = self.message().clone();
        let motion = self.session.connection.follow(motion, end).await?;
        let mut newest = self.message();
        if newest.end_time.is_none() {
            *newest = motion;
        }
        Ok(())
    }

    pub(crate) fn is_over(&self) -> bool {
        self.message().end_time.is_some()
    }
}

impl IntoFuture for Motion {
    type Output = Result<MotionResult>;
    type IntoFuture = Boxed<MotionResult>;

    fn into_future(self) -> Self::IntoFuture {
        Box::pin(async move { self.wait().await })
    }
}

impl fmt::Display for Motion {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} {:?}", self.name(), self.state())
    }
}

impl fmt::Debug for Motion {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "Motion({self})")
    }
}
