//! The daemon as one program sees it. `Repeat` and `Following` decide what is sent.

use std::future::Future;
use std::sync::OnceLock;
use std::time::{Duration, Instant, SystemTime};

use tokio::runtime::Handle;
use tokio::sync::watch;
use tokio::task::JoinHandle;
use tokio::time::sleep;

use crate::api;
use crate::api::{Call, CallContext, Changing};
use crate::channel::Channel;
use crate::errors::{Error, Result};
use crate::failure::{undelivered, Failure};
use crate::following::{own, Following};
use crate::repeat::Repeat;
use crate::target::Target;

/// A Connection sends and waits.
///
/// Stops have a channel of their own, which is open from the start, so that no other call delays them.
pub struct Connection {
    pub target: Target,
    /// Half of the time limit of a call. A request is sent again in the first half, and the second is for its answer.
    pub half: Duration,
    pub calls: Channel,
    stops: Channel,
    runtime: Handle,
    /// Has a receiver for each task in the background.
    tasks: watch::Sender<()>,
}

impl Connection {
    pub fn new(target: Target, timeout: Duration) -> Result<Connection> {
        let calls = Channel::new(&target, session())?;
        let stops = Channel::new(&target, session())?;
        let (runtime, tasks) = (Handle::current(), watch::channel(()).0);
        Ok(Connection { target, half: timeout / 2, calls, stops, runtime, tasks })
    }

    /// Runs a task that is not dropped with its caller.
    pub fn spawn<T: Send + 'static>(&self, task: impl Future<Output = T> + Send + 'static) -> JoinHandle<T> {
        let running = self.tasks.subscribe();
        self.runtime.spawn(async move {
            let result = task.await;
            drop(running);
            result
        })
    }

    /// Waits until no task runs in the background.
    pub async fn settled(&self) {
        self.tasks.closed().await;
    }

    /// Connects the channel for stops, and lists the devices. Fails at once if no daemon answers.
    pub async fn connect(&self) -> Result<api::ListDevicesResponse> {
        let repeat = Repeat::question(Instant::now(), &self.target.address, self.half);
        let request = api::ListDevicesRequest {};
        self.send(repeat, |limit| self.stops.once(&request, limit)).await
    }

    /// Returns the answer to a question, which is repeated while no daemon answers.
    pub async fn ask<Q: Call>(&self, request: &Q) -> Result<Q::Answer> {
        self.ask_for(request, self.half).await
    }

    /// Returns the answer to a question, which is repeated for `patience` while no daemon answers.
    pub async fn ask_for<Q: Call>(&self, request: &Q, patience: Duration) -> Result<Q::Answer> {
        let repeat = Repeat::question(Instant::now() + patience, &self.target.address, self.half);
        self.send(repeat, |limit| self.calls.once(request, limit)).await
    }

    /// Sends a request that changes something, so that it acts at most once, and returns its answer. `patience` is the
    /// time that the request may wait for something.
    pub async fn change<Q: Changing>(&self, mut request: Q, token: &[u8], patience: Duration) -> Result<Q::Answer> {
        let (context, repeat) = self.prepare(token, patience).await?;
        request.set_context(context);
        self.send(repeat, |limit| self.calls.once(&request, limit)).await
    }

    /// Sends a request that starts a motion, so that it acts at most once, and returns the motion. `attempt` sends the
    /// request with a context, and returns the motion of the answer.
    pub async fn start<F>(
        &self,
        token: &[u8],
        patience: Duration,
        attempt: impl Fn(CallContext, Duration) -> F,
    ) -> Result<api::Motion>
    where
        F: Future<Output = Result<Option<api::Motion>, Failure>>,
    {
        let (context, repeat) = self.prepare(token, patience).await?;
        let motion = self.send(repeat, |limit| attempt(context.clone(), limit)).await?;
        own(received(motion)?, &context.request_id)
    }

    /// Returns the context of a request that changes something, and when to send the request again.
    pub async fn prepare(&self, token: &[u8], patience: Duration) -> Result<(CallContext, Repeat)> {
        let listed = self.ask(&api::ListDevicesRequest {}).await?;
        let request_memory = if listed.requests_kept { listed.request_memory } else { String::new() };
        let patience = patience + self.half;
        let now = SystemTime::now();
        let daemon_now = if self.target.is_local() { now } else { daemon_time(&listed.devices).unwrap_or(now) };
        let repeat =
            Repeat::action(Instant::now() + patience, &self.target.address, self.half, !request_memory.is_empty());
        let context = CallContext {
            request_id: new_uuid(),
            lease_token: token.to_vec(),
            request_memory,
            not_after: Some((daemon_now + patience).into()),
            ..CallContext::default()
        };
        Ok((context, repeat))
    }

    /// Sends a stop over its own channel.
    pub async fn stop<Q: Call>(&self, request: &Q) -> Result<Q::Answer> {
        let repeat = Repeat::action(Instant::now() + self.half, &self.target.address, self.half, true);
        self.send(repeat, |limit| self.stops.once(request, limit)).await.map_err(undelivered)
    }

    /// Sends a request, and sends it again as `repeat` decides. Returns the answer, or the error with which it ends.
    pub async fn send<A, F>(&self, mut repeat: Repeat, attempt: impl Fn(Duration) -> F) -> Result<A>
    where
        F: Future<Output = Result<A, Failure>>,
    {
        loop {
            match attempt(repeat.timeout(Instant::now())).await {
                Ok(answer) => return Ok(answer),
                Err(failure) => sleep(repeat.after(&failure, Instant::now())?).await,
            }
        }
    }

    /// Returns the motion with its outcome, or as it is at `end`. None: no limit.
    pub async fn follow(&self, motion: api::Motion, end: Option<Instant>) -> Result<api::Motion> {
        let mut following = Following::new(motion, &self.target.address, Instant::now());
        while following.motion.end_time.is_none() {
            let left = end.map(|end| end.saturating_duration_since(Instant::now()));
            let (request, limit) = following.question(left);
            match self.calls.once(&request, limit).await {
                Ok(answer) => following.take(answer.motion.unwrap_or_default(), Instant::now())?,
                Err(failure) => sleep(following.after(&failure, Instant::now())?).await,
            }
            if left.is_some_and(|left| left.is_zero()) {
                break;
            }
        }
        Ok(following.motion)
    }
}

/// Returns the result of a task that runs even if its caller is dropped.
pub async fn joined<T>(task: JoinHandle<Result<T>>) -> Result<T> {
    task.await.unwrap_or_else(|error| Err(Error::look_first(format!("the call was ended: {error}"), "")))
}

/// Returns a field that the daemon always sets.
pub fn received<T>(field: Option<T>) -> Result<T> {
    field.ok_or_else(|| Error::look_first("the daemon's answer is incomplete".to_string(), ""))
}

/// Returns the session of this process: the daemon treats all of its connections as one program.
fn session() -> &'static str {
    static SESSION: OnceLock<String> = OnceLock::new();
    SESSION.get_or_init(new_uuid)
}

/// Returns a random UUID.
pub fn new_uuid() -> String {
    let mut id = [0; 16];
    getrandom::fill(&mut id).expect("the system has random numbers");
    let id = u128::from_be_bytes(id) & !(0xf << 76) & !(0x3 << 62) | (0x4 << 76) | (0x2 << 62);
    let text = format!("{id:032x}");
    [&text[..8], &text[8..12], &text[12..16], &text[16..20], &text[20..]].join("-")
}

/// Returns the daemon's time just after the devices were listed. None: nothing was read from any device yet.
fn daemon_time(devices: &[api::Device]) -> Option<SystemTime> {
    devices.iter().find_map(|device| {
        let age = Duration::try_from(device.age?).ok()?;
        Some(SystemTime::try_from(device.read_time?).ok()? + age)
    })
}
