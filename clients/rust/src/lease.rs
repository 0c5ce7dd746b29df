use std::future::IntoFuture;
use std::ops::Deref;
use std::sync::Arc;
use std::time::{Duration, Instant};

use tokio::sync::watch;
use tokio::task::JoinHandle;
use tokio::time::{interval_at, timeout};

use crate::api;
use crate::api::CallContext;
use crate::connection::received;
use crate::errors::{Error, Problem, Reason, Result};
use crate::session::{Boxed, Session};
use crate::stage::{names, Stage};

const USUAL_TTL: Duration = Duration::from_secs(10);

/// A Leasable is a kind of device.
pub trait Leasable: Clone + Send + 'static {
    fn session(&self) -> &Session;

    /// Returns the device with calls that carry the token of a lease.
    fn under(self, token: Arc<[u8]>) -> Self;
}

/// LeaseTerms are a lease that is acquired once they are awaited. The future fails with [`Reason::LEASE_HELD`] if the
/// axes are not free.
#[derive(Debug)]
#[must_use = "nothing is acquired until the terms are awaited"]
pub struct LeaseTerms<D = Stage> {
    device: D,
    wait: Duration,
    ttl: Duration,
    terms: api::LeaseTerms,
}

impl<D: Leasable> LeaseTerms<D> {
    pub(crate) fn new<A: ToString>(device: D, axes: impl IntoIterator<Item = A>) -> LeaseTerms<D> {
        let (axes, at_loss) = (names(axes), api::AtLoss::Stop as i32);
        let terms = api::LeaseTerms { axes, at_loss, ..api::LeaseTerms::default() };
        LeaseTerms { device, wait: Duration::ZERO, ttl: USUAL_TTL, terms }
    }

    /// Sets the longest wait for the axes. Without it, do not wait.
    pub fn wait(mut self, limit: Duration) -> Self {
        self.wait = limit;
        self
    }

    /// Sets the time after which the lease ends when the program or the connection has failed. Without it: 10 s.
    pub fn ttl(mut self, time: Duration) -> Self {
        self.ttl = time;
        self
    }

    /// Lets a running motion end first when the lease is lost. Without it, the motion is stopped.
    pub fn finish_at_loss(mut self) -> Self {
        self.terms.at_loss = api::AtLoss::Finish as i32;
        self
    }

    /// Sets a text for other callers: "scan of sample 12".
    pub fn purpose(mut self, text: impl Into<String>) -> Self {
        self.terms.purpose = text.into();
        self
    }

    async fn acquire(self) -> Result<Lease<D>> {
        let session = self.device.session();
        let request = api::AcquireLeaseRequest {
            device: session.device.to_string(),
            terms: Some(api::LeaseTerms { time_to_live: Some(api::duration(self.ttl)), ..self.terms }),
            wait: (!self.wait.is_zero()).then(|| api::duration(self.wait)),
            ..api::AcquireLeaseRequest::default()
        };
        let lease = received(session.change_for(request, self.wait).await?.lease)?;
        let device = self.device.under(lease.token.into());
        let (loss, lost) = watch::channel(None);
        let keeping = tokio::spawn(keep(device.session().clone(), self.ttl, loss));
        Ok(Lease { device, axes: lease.axes, lost, keeping, released: false })
    }
}

impl<D: Leasable> IntoFuture for LeaseTerms<D> {
    type Output = Result<Lease<D>>;
    type IntoFuture = Boxed<Lease<D>>;

    fn into_future(self) -> Self::IntoFuture {
        Box::pin(self.acquire())
    }
}

/// A Lease is the exclusive right to move some axes. It is kept alive in the background until it is released or dropped.
///
/// A Lease is also the device, like the guard of a mutex is its content: the calls that are made through it carry the
/// lease.
///
/// ```no_run
/// # async fn run(stage: axisgate::Stage) -> axisgate::Result<()> {
/// use axisgate::mm;
///
/// let lease = stage.lease(["x", "y"]).purpose("scan of sample 12").await?;
/// lease.axis("x")?.move_to(mm("1.5")).await?;
/// lease.release().await?;
/// # Ok(())
/// # }
/// ```
///
/// A lease is lost if it cannot be kept alive, or if an administrator takes the axes over. Motion under it then fails
/// with [`Reason::LEASE_LOST`]. Dropping a Lease releases it in the background.
#[derive(Debug)]
pub struct Lease<D: Leasable = Stage> {
    device: D,
    axes: Vec<i32>,
    lost: watch::Receiver<Option<Problem>>,
    keeping: JoinHandle<()>,
    released: bool,
}

impl<D: Leasable> Lease<D> {
    /// Returns the token of the lease. It is a secret: every program that has it can use the lease.
    pub fn token(&self) -> &[u8] {
        &self.device.session().token
    }

    /// Returns the numbers of the axes. Empty: the whole device.
    pub fn leased_axes(&self) -> &[i32] {
        &self.axes
    }

    /// Returns why the lease was lost, or None.
    pub fn problem(&self) -> Option<Problem> {
        self.lost.borrow().clone()
    }

    /// Waits until the lease is lost, and returns why. A move can be cancelled then:
    ///
    /// ```no_run
    /// # async fn run(lease: axisgate::Lease) -> axisgate::Result<()> {
    /// tokio::select! {
    ///     result = lease.axis("x")?.move_to(axisgate::mm(1)) => println!("{}", result?),
    ///     problem = lease.lost() => println!("{problem}"),
    /// }
    /// # Ok(())
    /// # }
    /// ```
    pub async fn lost(&self) -> Problem {
        let mut lost = self.lost.clone();
        let problem = lost.wait_for(Option::is_some).await.ok().and_then(|problem| problem.clone());
        match problem {
            Some(problem) => problem,
            None => std::future::pending().await, // the keeping has ended, so the lease is not lost any later
        }
    }

    /// Gives the axes to a waiting caller, such as "unix anna". The lease then ends.
    ///
    /// Fails with `Refused` if this caller does not wait for exactly these axes, or while a motion runs under the lease.
    pub async fn hand_over(&mut self, caller: impl Into<String>) -> Result<()> {
        let (device, caller) = (self.device.session().device.to_string(), caller.into());
        let request = api::HandOverLeaseRequest { device, caller, ..Default::default() };
        self.device.session().surely(request).await?;
        self.released = true;
        self.keeping.abort();
        Ok(())
    }

    /// Ends the lease. A motion that runs under it continues. Has no effect on a lease that has ended.
    pub async fn release(mut self) -> Result<()> {
        match self.end() {
            Some(request) => self.device.session().surely(request).await.map(drop),
            None => Ok(()),
        }
    }

    /// Ends the keeping. Returns the request with which the lease ends, unless it has ended.
    fn end(&mut self) -> Option<api::ReleaseLeaseRequest> {
        self.keeping.abort();
        let is_first = !std::mem::replace(&mut self.released, true);
        let device = self.device.session().device.to_string();
        (is_first && self.problem().is_none()).then(|| api::ReleaseLeaseRequest { device, ..Default::default() })
    }
}

impl<D: Leasable> Deref for Lease<D> {
    type Target = D;

    fn deref(&self) -> &D {
        &self.device
    }
}

impl<D: Leasable> Drop for Lease<D> {
    /// Releases the lease in the background. If the runtime has ended, the lease expires.
    fn drop(&mut self) {
        let Some(request) = self.end() else { return };
        let session = self.device.session().clone();
        let connection = session.connection.clone();
        connection.spawn(async move {
            if let Err(error) = session.change(request).await {
                tracing::warn!(%error, "the lease was not released");
            }
        });
    }
}

/// Renews the lease until it is lost.
async fn keep(session: Session, ttl: Duration, loss: watch::Sender<Option<Problem>>) {
    let mut kept = Instant::now();
    let mut ticks = interval_at(tokio::time::Instant::now() + ttl / 3, ttl / 3);
    loop {
        ticks.tick().await;
        let problem = match timeout(ttl, renew(&session)).await {
            Ok(Ok(())) => {
                kept = Instant::now();
                continue;
            }
            Ok(Err(error)) if passes(&error) => error.to_string(),
            Ok(Err(error)) => return lose(&loss, error.problem().cloned().unwrap_or_default()),
            Err(late) => late.to_string(),
        };
        if kept.elapsed() > ttl {
            let message = format!("the lease has expired: {problem}");
            return lose(&loss, Problem { reason: Reason::LEASE_LOST, message, ..Problem::default() });
        }
    }
}

async fn renew(session: &Session) -> Result<()> {
    let context = Some(CallContext { lease_token: session.token.to_vec(), ..CallContext::default() });
    let request = api::RenewLeaseRequest { context, device: session.device.to_string() };
    session.connection.ask_for(&request, Duration::ZERO).await.map(drop)
}

/// Reports whether a renewal that failed may succeed a moment later.
fn passes(error: &Error) -> bool {
    error.is_unavailable() || error.problem().is_some_and(|problem| problem.reason == "QUEUE_FULL")
}

fn lose(loss: &watch::Sender<Option<Problem>>, problem: Problem) {
    tracing::warn!(%problem, "the lease was lost");
    loss.send_replace(Some(problem));
}
