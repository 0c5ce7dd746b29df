use std::fmt;
use std::time::Duration;

use crate::api;
use crate::api::CallContext;
use crate::connection::received;
use crate::errors::{Error, Result};
use crate::failure::Failure;
use crate::session::Session;
use crate::units::Distance;

const PIECE_BYTES: usize = 1 << 19;
/// Smallest number of bytes that are sent in a second. The time for them is added to the limit of the request.
const BYTES_PER_SECOND: f64 = 1e6;

/// A NewJob is a job that has not been sent. See [`Mill::send`](crate::Mill::send).
#[derive(Clone, Debug, Default)]
pub struct NewJob {
    header: api::JobHeader,
    content: Vec<u8>,
    wrong: Option<String>,
}

impl NewJob {
    /// Returns a job without parts. The title has 1 to 100 bytes.
    pub fn new(title: impl Into<String>) -> NewJob {
        let header = api::JobHeader { title: title.into(), ..api::JobHeader::default() };
        NewJob { header, ..NewJob::default() }
    }

    /// Adds a part: the name of its tool, and the content of its file. The operator changes the tool between two parts.
    pub fn part(mut self, tool: impl Into<String>, content: &[u8]) -> NewJob {
        self.header.parts.push(api::JobPart { tool: tool.into(), bytes: content.len() as i64 });
        self.content.extend_from_slice(content);
        self
    }

    /// Names a configured origin. Without it: the origin that is set at the panel.
    pub fn origin(mut self, name: impl Into<String>) -> NewJob {
        self.header.origin = name.into();
        self
    }

    /// Accepts a warning of the check, such as "drags-tool".
    pub fn accept_warning(mut self, name: impl Into<String>) -> NewJob {
        self.header.accepted_warnings.push(name.into());
        self
    }

    /// Sets the size of the workpiece.
    pub fn stock(mut self, x: Distance, y: Distance, z: Distance) -> NewJob {
        match (x.message(), y.message(), z.message()) {
            (Ok(x), Ok(y), Ok(z)) => self.header.stock = Some(api::Stock { x: Some(x), y: Some(y), z: Some(z) }),
            (Err(error), _, _) | (_, Err(error), _) | (_, _, Err(error)) => self.wrong = Some(error.to_string()),
        }
        self
    }

    pub(crate) async fn send(mut self, session: &Session) -> Result<Job> {
        if let Some(wrong) = self.wrong {
            return Err(Error::InvalidArgument(wrong));
        }
        if self.header.parts.is_empty() {
            return Err(Error::invalid("a job needs at least one part"));
        }
        self.header.device = session.device.to_string();
        let patience = Duration::from_secs_f64(self.content.len() as f64 / BYTES_PER_SECOND);
        let (context, repeat) = session.connection.prepare(&session.token, patience).await?;
        let job = &self;
        let context = &context;
        session.connection.send(repeat, |limit| job.send_pieces(session, context, limit)).await.map(Job::of)
    }

    /// Sends the job from the byte on that the daemon does not have yet.
    async fn send_pieces(
        &self,
        session: &Session,
        context: &CallContext,
        limit: Duration,
    ) -> Result<api::Job, Failure> {
        let header = Some(api::JobHeader { context: Some(context.clone()), ..self.header.clone() });
        let mut from = 0;
        loop {
            let end = self.content.len().min(from + PIECE_BYTES);
            let data = self.content[from.min(end)..end].to_vec();
            let (header, last) = (header.clone(), end == self.content.len());
            let piece = api::SendJobPieceRequest { header, offset: from as i64, data, last };
            let answer = session.connection.calls.once(&piece, limit).await?;
            if let Some(job) = answer.job {
                return Ok(job);
            }
            from = usize::try_from(answer.received).unwrap_or_default();
        }
    }
}

/// A Job is one job in the queue of a mill, as last received.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Job {
    /// Name of the job: "devices/mill/jobs/7".
    pub name: String,
    /// Title given by the owner.
    pub title: String,
    /// State: "QUEUED", "CONFIRMED", "RUNNING", "FED", "TOOL_CHANGE", "PAUSED", "DONE", ...
    pub state: String,
    /// Names of the tools, one for each part.
    pub tools: Vec<String>,
    /// Number of the part that runs or is to run next, from 1.
    pub part: i32,
    /// Shortest time that the rest of the job takes. None: unknown.
    pub shortest_time: Option<Duration>,
    /// Longest time that the rest of the job takes. None: unknown.
    pub longest_time: Option<Duration>,
    pub(crate) setup: Option<api::JobSetup>,
}

impl Job {
    pub(crate) fn of(job: api::Job) -> Job {
        Job {
            name: job.name,
            title: job.title,
            state: api::enum_name(job.state, "JOB_STATE_", api::JobState::as_str_name),
            tools: job.parts.into_iter().map(|part| part.tool).collect(),
            part: job.part,
            shortest_time: job.shortest_time.and_then(|time| time.try_into().ok()),
            longest_time: job.longest_time.and_then(|time| time.try_into().ok()),
            setup: job.setup,
        }
    }

    pub(crate) fn received(job: Option<api::Job>) -> Result<Job> {
        received(job).map(Job::of)
    }
}

impl fmt::Display for Job {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} {}", self.name, self.state)
    }
}
