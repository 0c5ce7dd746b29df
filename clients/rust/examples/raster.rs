//! Measures at each point of a raster, all night long. Survives a connection that is broken for up to a minute: no move
//! is lost, and none is made twice. Ends if the stage needs a person. Ctrl-C cancels the present move.

use std::time::Duration;

use axisgate::{um, Distance, Lease, MotionResult, Result, Stage};

/// Longest time without a connection.
const OUTAGE: Duration = Duration::from_secs(60);

#[tokio::main]
async fn main() -> Result<()> {
    let stage = Stage::connect().timeout(2 * OUTAGE).await?;
    let terms = stage.lease(["x", "y"]).ttl(2 * OUTAGE).finish_at_loss().purpose("overnight raster");
    let lease = terms.await?;
    tokio::select! {
        measured = measure_all(&lease) => measured?,
        _ = tokio::signal::ctrl_c() => println!("the raster is cancelled"),
    }
    lease.release().await?;
    stage.close().await; // a cancellation is sent before the program ends
    Ok(())
}

async fn measure_all(stage: &Lease) -> Result<()> {
    stage.home_if_needed(["x", "y"]).await?;
    let mut visited = stage.visit(["x", "y"], raster(10, 10));
    while let Some(result) = visited.next().await {
        measure(&result?);
    }
    Ok(())
}

fn raster(columns: i32, rows: i32) -> impl Iterator<Item = [Distance; 2]> {
    (0..rows).flat_map(move |y| (0..columns).map(move |x| [um(20 * x), um(20 * y)]))
}

/// Stands for what a program does at each point.
fn measure(at: &MotionResult) {
    println!("{at}");
}
