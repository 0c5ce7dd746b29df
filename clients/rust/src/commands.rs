use std::time::Duration;

use futures_util::stream;

use crate::api;
use crate::api::execute_response::Change;
use crate::api::CallContext;
use crate::connection::new_uuid;
use crate::errors::{Error, Result};
use crate::failure::Failure;
use crate::motion::Motion;
use crate::stage::{names, Stage};

const TIMEOUT: Duration = Duration::from_secs(20);
/// Time for the answers, in addition to the time limit of the lines.
const ANSWER_TIME: Duration = Duration::from_secs(5);

/// Executed are the answers of the controller to lines.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Executed {
    /// Answers, in the order of the lines.
    pub answers: Vec<String>,
    /// Motion that the lines started, which may continue. None: no motion.
    pub motion: Option<Motion>,
}

/// Lines are what is known of lines that were sent.
#[derive(Default)]
struct Lines {
    answers: Vec<String>,
    motion: String,
}

impl Stage {
    /// Sends lines in the controller's own language, once, as one transaction, and returns their answers. They have 20 s.
    ///
    /// Fails with `Refused` if nothing moved; otherwise with `Stopped`, `MotionFailed` or `OutcomeUnknown`.
    ///
    /// ```no_run
    /// # async fn run(stage: axisgate::Stage) -> axisgate::Result<()> {
    /// if let Some(motion) = stage.execute(["M:1+P100", "G:1"]).await?.motion {
    ///     println!("{}", motion.await?);
    /// }
    /// # Ok(())
    /// # }
    /// ```
    pub async fn execute<L: ToString>(&self, lines: impl IntoIterator<Item = L>) -> Result<Executed> {
        let request_id = new_uuid();
        let context = CallContext {
            request_id: request_id.clone(),
            lease_token: self.session.token.to_vec(),
            ..CallContext::default()
        };
        let request = api::ExecuteRequest {
            context: Some(context),
            device: self.session.device.to_string(),
            lines: names(lines),
            timeout: Some(api::duration(TIMEOUT)),
            ..api::ExecuteRequest::default()
        };
        let mut lines = Lines::default();
        let ended = tokio::time::timeout(TIMEOUT + ANSWER_TIME, self.send_lines(request, &mut lines)).await;
        if let Err(failure) = ended.unwrap_or_else(|_| Err(Failure::of_ended_stream())) {
            return Err(error_of(&failure, !lines.motion.is_empty(), &self.session.connection.target.address));
        }
        let name = Some(lines.motion).filter(|name| !name.is_empty());
        let message = name.map(|name| api::Motion { name, request_id, ..api::Motion::default() });
        let motion = message.map(|message| Motion::new(self.session.clone(), message));
        Ok(Executed { answers: lines.answers, motion })
    }

    async fn send_lines(&self, request: api::ExecuteRequest, lines: &mut Lines) -> Result<(), Failure> {
        let request = stream::once(std::future::ready(request));
        let mut answers = self.session.connection.calls.stream(request, TIMEOUT + ANSWER_TIME).await?;
        while let Some(answer) = answers.next().await? {
            match answer.change {
                Some(Change::Motion(name)) if lines.motion.is_empty() => lines.motion = name,
                Some(Change::Reply(reply)) => lines.answers.push(reply.answer),
                _ => {}
            }
        }
        Ok(())
    }
}

/// Returns the error. It is not Refused, which means that nothing moved, if lines were sent that may move.
fn error_of(failure: &Failure, moves: bool, target: &str) -> Error {
    let error = failure.error(target);
    let is_uncertain = error.is_unavailable() || failure.is("DEADLINE_PASSED");
    match error {
        Error::Refused(problem) if moves && failure.problem.is_some() => {
            if is_uncertain {
                Error::OutcomeUnknown(problem)
            } else {
                Error::MotionFailed(problem)
            }
        }
        other => other,
    }
}
