//! Translates the acts of the conformance scenario into calls of the crate, one JSON object on a line each way.

mod act;
mod verbs;

use std::error::Error as StdError;
use std::io::BufRead;

use axisgate::{Error, MotionResult};
use serde_json::{json, Map, Value};

use act::Act;
use verbs::Runner;

/// Error of a point of a path, as the scenario wants it.
type AnyError = Box<dyn StdError + Send + Sync>;

fn shown(result: &MotionResult) -> Value {
    let positions = result.positions.iter().map(|one| (one.axis.clone(), json!(one.value)));
    json!({"outcome": "done", "positions": positions.collect::<Map<String, Value>>()})
}

fn reply_to(error: &Error) -> Value {
    let outcome = match error {
        Error::Refused(_) => "refused",
        Error::Stopped(_) => "stopped",
        Error::MotionFailed(_) => "failed",
        Error::OutcomeUnknown(_) => "unknown",
        _ => "local",
    };
    match error.problem() {
        Some(p) => json!({"outcome": outcome, "reason": p.reason.as_str(), "message": p.message, "hint": p.hint,
                          "axis": p.axis}),
        None => json!({"outcome": outcome, "message": error.to_string()}),
    }
}

#[tokio::main]
async fn main() -> Result<(), AnyError> {
    let mut runner = Runner::default();
    for line in std::io::stdin().lock().lines() {
        let act = Act(serde_json::from_str(&line?)?);
        println!("{}", runner.reply(&act).await.unwrap_or_else(|error| reply_to(&error)));
    }
    Ok(())
}
