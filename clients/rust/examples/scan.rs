//! Runs the axis x of the local stage over 2 mm, with a trigger pulse every 10 um, and prints the numbers of pulses.

use axisgate::{mm, um, Result, Stage};

#[tokio::main(flavor = "current_thread")]
async fn main() -> Result<()> {
    let stage = Stage::connect().await?;
    let scan = stage.scan("x", mm(0), mm(2), um(10)).speed(um(200).per_second());
    if let Some(pulses) = scan.await?.scan {
        println!("{:?} of {:?} pulses", pulses.observed, pulses.expected);
    }
    Ok(())
}
