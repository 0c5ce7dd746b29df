use std::future::{Future, IntoFuture};

use crate::api;
use crate::errors::Result;
use crate::motion::Motion;
use crate::results::MotionResult;
use crate::session::{Boxed, Session};

/// A Plan is a motion that has not been started.
///
/// Awaiting the Plan starts the motion and waits for its outcome. It fails with `Refused`, `Stopped`, `MotionFailed` or
/// `OutcomeUnknown` unless the motion succeeds. If the future is dropped before, the motion is cancelled in the
/// background: `tokio::time::timeout` and `tokio::select!` stop the axes. [`Stage::close`](crate::Stage::close) waits
/// until that is done.
///
/// [`Plan::start`] starts the motion, which then continues whatever this program does.
#[derive(Debug)]
#[must_use = "nothing moves until the plan is awaited or started"]
pub struct Plan<M> {
    session: Session,
    pub(crate) request: Result<M>,
}

/// A Startable request starts a motion.
pub trait Startable: Send + Sized + 'static {
    /// Starts the motion.
    fn begin(self, session: &Session) -> impl Future<Output = Result<api::Motion>> + Send;
}

impl<M: Startable> Plan<M> {
    pub(crate) fn new(session: &Session, request: Result<M>) -> Plan<M> {
        Plan { session: session.clone(), request }
    }

    pub(crate) fn into_parts(self) -> (Session, Result<M>) {
        (self.session, self.request)
    }

    /// Changes the request, unless an argument was wrong already.
    pub(crate) fn with(mut self, change: impl FnOnce(&mut M) -> Result<()>) -> Plan<M> {
        self.request = self.request.and_then(|mut request| change(&mut request).map(|()| request));
        self
    }

    /// Starts the motion. If the returned future is dropped, it stays open whether the motion starts.
    pub async fn start(self) -> Result<Motion> {
        let message = self.request?.begin(&self.session).await?;
        Ok(Motion::new(self.session, message))
    }
}

impl<M: Startable> IntoFuture for Plan<M> {
    type Output = Result<MotionResult>;
    type IntoFuture = Boxed<MotionResult>;

    fn into_future(self) -> Self::IntoFuture {
        let session = self.session.clone();
        Box::pin(async move { session.finish(Box::pin(self.start())).await })
    }
}
