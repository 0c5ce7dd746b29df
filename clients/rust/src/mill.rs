use std::time::Duration;

use crate::api;
use crate::api::operate_mill_request::Act;
use crate::connect::{Connect, Connectable};
use crate::connection::received;
use crate::device::device_functions;
use crate::errors::Result;
use crate::job::{Job, NewJob};
use crate::session::Session;
use crate::units::Distance;
use crate::updates::{begin, Feed, Updates};

/// A Mill is the connection to one mill. Its clones share the connection.
///
/// A mill never answers, so the progress of a job is a range that the daemon computes. A job is sent to the queue,
/// confirmed by a person at the mill, started, and reported as done. Not a safety function: use the mill's own emergency
/// stop.
///
/// ```no_run
/// # async fn run(board: Vec<u8>) -> axisgate::Result<()> {
/// use axisgate::{Mill, NewJob};
///
/// let mill = Mill::connect().await?;
/// let job = mill.send(NewJob::new("board").part("T1", &board)).await?;
/// let job = mill.confirm(&job).await?; // a person has set up the mill
/// mill.start(&job).await?;
/// # Ok(())
/// # }
/// ```
#[derive(Clone)]
pub struct Mill {
    pub(crate) session: Session,
}

device_functions!(Mill);

impl Connectable for Mill {
    const CAPABILITY: api::Capability = api::Capability::Jobs;
    const KIND: &'static str = "mill";

    fn of(session: Session, _: &api::Device) -> Mill {
        Mill { session }
    }
}

/// A MillState is the state of a mill.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct MillState {
    /// True if the line is open.
    pub line_open: bool,
    /// Jobs in the order of the queue, with the running job and the jobs that wait for a person.
    pub jobs: Vec<Job>,
    /// Names of the configured tools.
    pub tools: Vec<String>,
    /// Names of the configured origins.
    pub origins: Vec<String>,
    /// Job that left the queue last, in its final state. None: none since the daemon started.
    pub ended: Option<Job>,
}

impl MillState {
    fn of(mill: api::Mill) -> MillState {
        MillState {
            line_open: mill.line_open,
            jobs: mill.jobs.into_iter().map(Job::of).collect(),
            tools: mill.tools,
            origins: mill.origins,
            ended: mill.ended.map(Job::of),
        }
    }
}

/// The feed of Mill::watch().
struct MillStates(api::WatchMillRequest);

impl Feed for MillStates {
    type Request = api::WatchMillRequest;
    type Item = MillState;

    fn request(&self) -> api::WatchMillRequest {
        self.0.clone()
    }

    fn item(&mut self, answer: api::WatchMillResponse) -> Option<MillState> {
        answer.mill.map(MillState::of)
    }
}

impl Mill {
    /// Connects to the daemon, as [`Stage::connect`](crate::Stage::connect) does.
    pub fn connect() -> Connect<Mill> {
        Connect::new()
    }

    /// Returns the state of the mill: its queue, tools and origins.
    pub async fn state(&self) -> Result<MillState> {
        let answer = self.session.ask(api::GetMillRequest { device: self.device() }).await?;
        received(answer.mill).map(MillState::of)
    }

    /// Returns the state of the mill, now and after every change, also over broken connections.
    pub async fn watch(&self) -> Result<Updates<MillState>> {
        let request = api::WatchMillRequest { device: self.device() };
        begin(self.session.connection.clone(), MillStates(request)).await
    }

    /// Puts a job into the queue, once, even if an answer is lost.
    ///
    /// Fails with `Refused` if the check of the job finds an error, or a warning that the job does not accept.
    pub async fn send(&self, job: NewJob) -> Result<Job> {
        job.send(&self.session).await
    }

    /// Confirms that a person has set up the mill as the job needs, for the next job or its next part.
    pub async fn confirm(&self, job: &Job) -> Result<Job> {
        let (job, seen) = (job.name.clone(), job.setup.clone());
        Job::received(self.session.change(api::ConfirmJobRequest { job, seen, ..Default::default() }).await?.job)
    }

    /// Starts a confirmed job, or its next part.
    pub async fn start(&self, job: &Job) -> Result<Job> {
        let request = api::StartJobRequest { job: job.name.clone(), ..Default::default() };
        Job::received(self.session.change(request).await?.job)
    }

    /// Sends no more of the running job. The mill executes what it has received; with `raise_tool`, the tool is then
    /// raised.
    pub async fn pause(&self, raise_tool: bool) -> Result<()> {
        let request = api::PauseJobRequest { device: self.device(), raise_tool, ..Default::default() };
        self.session.change(request).await.map(drop)
    }

    /// Continues a job that was paused with the tool in the cut.
    pub async fn resume(&self) -> Result<()> {
        let request = api::ResumeJobRequest { device: self.device(), ..Default::default() };
        self.session.change(request).await.map(drop)
    }

    /// Aborts the running job. Sent over its own connection, even if the future is dropped once it was polled.
    pub async fn abort(&self) -> Result<()> {
        let request = api::AbortJobRequest { context: self.session.lease_context(), device: self.device() };
        self.session.stop(request).await.map(drop)
    }

    /// Removes a job that does not run from the queue.
    pub async fn cancel(&self, job: &Job) -> Result<()> {
        let request = api::CancelJobRequest { job: job.name.clone(), ..Default::default() };
        self.session.change(request).await.map(drop)
    }

    /// Reports that a person has seen the workpiece of a job that is FED.
    pub async fn report_done(&self, job: &Job) -> Result<()> {
        let request = api::ReportJobDoneRequest { job: job.name.clone(), ..Default::default() };
        self.session.change(request).await.map(drop)
    }

    /// Moves the tool by hand. Z grows upward. Nothing checks where a step leads.
    ///
    /// Returns the longest time until the mill has done it.
    pub async fn step(&self, x: Distance, y: Distance, z: Distance) -> Result<Duration> {
        let (x, y, z) = (Some(x.message()?), Some(y.message()?), Some(z.message()?));
        self.operate(Act::Step(api::JogStep { x, y, z, speed: None })).await
    }

    /// Sets Z0 at the height of the tool. Returns as [`Mill::step`].
    pub async fn set_z0(&self) -> Result<Duration> {
        self.operate(Act::Surface(api::SetZ0::default())).await
    }

    /// Sets Z0 at the height of a configured origin. Returns as [`Mill::step`].
    pub async fn set_z0_of_origin(&self, origin: impl Into<String>) -> Result<Duration> {
        self.operate(Act::Surface(api::SetZ0 { origin: origin.into(), z: None })).await
    }

    /// Sets Z0 at a machine coordinate. Returns as [`Mill::step`].
    pub async fn set_z0_at(&self, z: Distance) -> Result<Duration> {
        self.operate(Act::Surface(api::SetZ0 { origin: String::new(), z: Some(z.message()?) })).await
    }

    /// Starts or stops the spindle. Returns as [`Mill::step`].
    pub async fn spindle(&self, on: bool) -> Result<Duration> {
        self.operate(Act::Spindle(on)).await
    }

    /// Raises the tool to the top, with the spindle stopped. Returns as [`Mill::step`].
    pub async fn raise_tool(&self) -> Result<Duration> {
        self.operate(Act::RaiseTool(api::RaiseTool {})).await
    }

    async fn operate(&self, act: Act) -> Result<Duration> {
        let request = api::OperateMillRequest { device: self.device(), act: Some(act), ..Default::default() };
        let longest = self.session.change(request).await?.longest_time;
        Ok(longest.and_then(|time| time.try_into().ok()).unwrap_or_default())
    }

    fn device(&self) -> String {
        self.session.device.to_string()
    }
}
