use std::time::Duration;

use futures_util::stream;
use tokio::sync::watch;

use crate::api;
use crate::channel::Answers;
use crate::connection::received;
use crate::errors::Result;
use crate::failure::Failure;
use crate::motion::Motion;
use crate::results::MotionResult;
use crate::stage::Stage;
use crate::units::Speed;

/// Time between two messages. The daemon stops the axes after 500 ms without a message.
const INTERVAL: Duration = Duration::from_millis(100);

/// A Jog runs axes until it is stopped or dropped. The axes are also stopped if the program ends, or its runtime is
/// blocked for 500 ms.
///
/// ```no_run
/// # async fn run(stage: axisgate::Stage) -> axisgate::Result<()> {
/// use axisgate::um;
///
/// let jog = stage.jog([("x", um(-200).per_second())]).await?;
/// tokio::time::sleep(std::time::Duration::from_secs(2)).await;
/// println!("{}", jog.stop().await?);
/// # Ok(())
/// # }
/// ```
#[derive(Debug)]
#[must_use = "the axes stop when the jog is dropped"]
pub struct Jog {
    motion: Motion,
    answers: Answers<api::JogResponse>,
    /// Its end is the end of the messages.
    running: watch::Sender<()>,
}

impl Stage {
    /// Runs axes at speeds. A negative speed is one in the minus direction. Returns once the axes run.
    pub async fn jog<A: ToString>(&self, speeds: impl IntoIterator<Item = (A, Speed)>) -> Result<Jog> {
        let axes = speeds.into_iter().map(|(axis, speed)| axis_jog(axis.to_string(), speed));
        let first = api::JogRequest {
            context: self.session.lease_context(),
            device: self.session.device.to_string(),
            axes: axes.collect::<Result<_>>()?,
        };
        let connection = &self.session.connection;
        let (running, stopped) = watch::channel(());
        let failed = |failure: Failure| failure.error(&connection.target.address);
        let limit = 2 * connection.half;
        let mut answers = connection.calls.stream(messages(first, stopped), limit).await.map_err(failed)?;
        let begun =
            tokio::time::timeout(limit, answers.next()).await.unwrap_or_else(|_| Err(Failure::of_ended_stream()));
        let motion = received(begun.map_err(failed)?.and_then(|answer| answer.motion))?;
        Ok(Jog { motion: Motion::new(self.session.clone(), motion), answers, running })
    }
}

impl Jog {
    /// Returns the motion of the jog.
    pub fn motion(&self) -> &Motion {
        &self.motion
    }

    /// Ends the jog: the axes slow down. Waits for the outcome, and fails with `Stopped`, `MotionFailed` or
    /// `OutcomeUnknown` if something else has ended the jog.
    pub async fn stop(self) -> Result<MotionResult> {
        let Jog { motion, mut answers, running } = self;
        drop(running);
        while let Ok(Some(_)) = answers.next().await {} // the outcome says why they end
        motion.wait().await
    }
}

/// Returns the messages that keep the axes running until the sender of `stopped` is dropped.
fn messages(
    first: api::JogRequest,
    stopped: watch::Receiver<()>,
) -> impl futures_util::Stream<Item = api::JogRequest> + Send + 'static {
    let ticks = tokio::time::interval(INTERVAL);
    stream::unfold((Some(first), ticks, stopped), |(first, mut ticks, mut stopped)| async move {
        tokio::select! {
            biased;
            _ = stopped.changed() => None,
            _ = ticks.tick() => Some((first.unwrap_or_default(), (None, ticks, stopped))),
        }
    })
}

pub fn axis_jog(axis: String, speed: Speed) -> Result<api::AxisJog> {
    use api::axis_jog::Direction;
    let (direction, speed) = if speed.is_negative() { (Direction::Minus, -speed) } else { (Direction::Plus, speed) };
    Ok(api::AxisJog { axis, direction: direction as i32, speed: Some(speed.message()?) })
}
