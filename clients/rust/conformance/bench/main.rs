//! Compares the crate with a bare client that sends the same messages, alternately in one process, over the connection
//! that AXISGATE_TARGET names. Prints the median times in microseconds as JSON.

mod bare;

use std::error::Error as StdError;
use std::time::{Duration, Instant};

use axisgate::{pulses, Stage};
use serde_json::{json, Value};

use bare::Bare;

type AnyError = Box<dyn StdError + Send + Sync>;

const WARM_UP: usize = 20;
const QUESTIONS: usize = 300;
const MOVES: usize = 60;

/// Times are those of the same calls through the crate and through the bare client.
#[derive(Default)]
struct Times {
    package: Vec<Duration>,
    bare: Vec<Duration>,
}

impl Times {
    /// Returns the medians of the calls after the warm-up.
    fn medians(self) -> Value {
        json!({"package_us": median_us(self.package), "bare_us": median_us(self.bare)})
    }
}

fn median_us(mut times: Vec<Duration>) -> u128 {
    let measured = &mut times[WARM_UP..];
    measured.sort();
    measured[measured.len() / 2].as_micros()
}

/// Waits for the result of a call, and adds the time that it took.
async fn timed<T, E: Into<AnyError>>(
    times: &mut Vec<Duration>,
    call: impl std::future::IntoFuture<Output = Result<T, E>>,
) -> Result<(), AnyError> {
    let begun = Instant::now();
    call.await.map_err(Into::into)?;
    times.push(begun.elapsed());
    Ok(())
}

async fn questions(stage: &Stage, bare: &Bare) -> Result<Times, AnyError> {
    let mut times = Times::default();
    for _ in 0..WARM_UP + QUESTIONS {
        timed(&mut times.package, stage.status()).await?;
        timed(&mut times.bare, bare.get_device()).await?;
    }
    Ok(times)
}

/// Moves the axis x by one pulse each, forth and back.
async fn moves(stage: &Stage, bare: &Bare) -> Result<Times, AnyError> {
    let x = stage.axis("x")?;
    let mut times = Times::default();
    for number in 0..WARM_UP + MOVES {
        let distance = if number % 2 == 0 { 1 } else { -1 };
        timed(&mut times.package, x.move_by(pulses(distance))).await?;
        timed(&mut times.bare, bare.move_by(distance, format!("{:0>36}", format!("bench {number}")))).await?;
    }
    Ok(times)
}

#[tokio::main]
async fn main() -> Result<(), AnyError> {
    let stage = Stage::connect().await?;
    let bare = Bare::connect(&std::env::var("AXISGATE_TARGET")?).await?;
    let (questions, moves) = (questions(&stage, &bare).await?, moves(&stage, &bare).await?);
    println!("{}", json!({"get_device": questions.medians(), "move": moves.medians()}));
    Ok(())
}
