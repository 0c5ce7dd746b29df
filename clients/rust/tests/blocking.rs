//! A program without a runtime of its own.

#![cfg(feature = "blocking")]

mod daemon;

use std::time::Duration;

use axisgate::blocking::{items, Blocking};
use axisgate::{mm, Result, Stage};
use daemon::Daemon;

#[test]
fn calls_wait_without_a_runtime() -> Result<()> {
    let daemon = Daemon::new().blocking();
    let stage = Stage::connect().target(daemon.socket()).blocking()?;
    let lease = stage.lease(["x"]).ttl(Duration::from_secs(1)).blocking()?;
    std::thread::sleep(Duration::from_millis(2500)); // longer than the lease lasts unless it is kept alive
    assert_eq!(lease.axis("x")?.move_to(mm(1)).blocking()?.to_string(), "x 1 mm");
    drop(lease); // is released in the background
    stage.clone().close().blocking();
    daemon.other(&["move", "x=0mm"]).blocking().expect("a move of a free axis");
    let motion = stage.axis("x")?.move_to(mm(1)).start().blocking()?;
    assert!(items(motion.progress(Duration::from_millis(20))).all(|progress| progress.is_ok()));
    motion.blocking().map(drop)
}
