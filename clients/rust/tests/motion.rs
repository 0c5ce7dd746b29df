//! Moves and their ends, against the daemon.

mod daemon;

use std::time::Duration;

use axisgate::{mm, pulses, um, Error, MotionState, Problem, Reason, Result, Stage, ALL};
use daemon::relay::Relay;
use daemon::{until_async, Daemon};
use tokio::time::timeout;

/// Returns the problem of a call that was refused.
fn refusal<T: std::fmt::Debug>(result: Result<T>) -> Problem {
    match result {
        Err(Error::Refused(problem)) => *problem,
        other => panic!("{other:?} is not Refused"),
    }
}

fn is_unknown<T>(result: &Result<T>) -> bool {
    matches!(result, Err(Error::OutcomeUnknown(_)))
}

fn is_stopped<T>(result: &Result<T>) -> bool {
    matches!(result, Err(Error::Stopped(problem)) if problem.reason == "STOPPED")
}

#[tokio::test]
async fn moves() -> Result<()> {
    let daemon = Daemon::new().await;
    let stage = daemon.connect().await;
    let x = stage.axis(1)?;
    assert_eq!(x.move_to(mm("1.5")).await?.to_string(), "x 1.5 mm");
    let back = x.move_by(um(-250)).speed(mm(5).per_second()).approach(um(10));
    assert_eq!(back.await?.to_string(), "x 1.25 mm");
    assert_eq!(stage.move_to([("x", mm(1)), ("y", um(-100))]).await?.to_string(), "x 1 mm, y -0.1 mm");
    let both = stage.move_by([("x", mm(0.1 + 0.2)), ("y", pulses(5))]).await?;
    assert_eq!(both.to_string(), "x 1.3 mm, y -0.09995 mm");
    assert_eq!(refusal(x.move_to(mm("0.123456789")).await).reason, "NOT_REPRESENTABLE");
    assert_eq!(refusal(x.move_to(mm(20)).await).reason, Reason::OUTSIDE_TRAVEL);
    assert_eq!(refusal(x.move_to(mm(20)).check().await).reason, Reason::OUTSIDE_TRAVEL);
    x.move_to(mm(1)).check().await?;
    assert!(matches!(x.move_to(mm(f64::NAN)).await, Err(Error::InvalidArgument(_))));
    assert!(matches!(stage.axis("z"), Err(Error::InvalidArgument(_))));
    let state = x.state().await?;
    assert_eq!(state.position.to_string(), "x 1.3 mm");
    assert_eq!(state.maximum, Some(mm("15")));
    assert_eq!(x.home().await?.to_string(), "x 0 mm");
    assert_eq!(stage.home_if_needed(["x"]).await?.positions, []);
    assert_eq!(stage.home_if_needed(ALL).await?.to_string(), "y 0 mm, 3 0 um");
    let other = Stage::connect().target(daemon.socket()).device("other").await;
    assert!(matches!(other, Err(Error::InvalidArgument(_))));
    Ok(())
}

#[tokio::test]
async fn ends() -> Result<()> {
    let daemon = Daemon::new().await;
    let stage = daemon.connect().await;
    let x = stage.axis("x")?;
    let motion = x.move_to(mm(14)).start().await?;
    assert!(timeout(Duration::from_millis(200), motion.wait()).await.is_err());
    assert!(!motion.is_done().await? && motion.state() == MotionState::Running);
    let report = x.stop().await?;
    assert!(!report.stays_open && report.problem.is_none() && report.axes[0].stationary == Some(true));
    assert!(is_stopped(&motion.await));

    let motion = x.move_to(mm(14)).start().await?; // a stop of the same program latches nothing
    motion.cancel().await?;
    assert!(is_stopped(&motion.await));

    let motion = x.move_to(mm(14)).start().await?;
    daemon.other(&["stop"]).await.expect("a stop");
    assert!(is_stopped(&motion.await));
    let refused = refusal(x.move_to(mm(0)).start().await);
    assert!(refused.reason == Reason::STOPPED_BY && refused.hint.contains("stage.rearm()"), "{refused}");
    assert_eq!(stage.rearm().await?, [1]);

    let motion = x.move_to(mm(14)).start().await?;
    stage.emergency_stop().await?;
    assert!(motion.await.is_err());
    assert_eq!(refusal(x.move_to(mm(0)).start().await).reason, "EMERGENCY_STOPPED");
    stage.clear_errors(ALL).await
}

#[tokio::test]
async fn a_dropped_move_is_cancelled() -> Result<()> {
    let daemon = Daemon::new().await;
    let stage = daemon.connect().await;
    let x = stage.axis("x")?;
    drop(x.move_to(mm(14))); // was not polled
    assert!(timeout(Duration::from_millis(300), x.move_to(mm(14))).await.is_err());
    assert!(timeout(Duration::ZERO, x.move_to(mm(-14))).await.is_err()); // is dropped before its start is answered
    stage.clone().close().await;
    let motions = stage.motions().await?;
    assert_eq!(motions.len(), 2);
    for motion in motions {
        assert!(is_stopped(&motion.await));
    }
    Ok(())
}

#[tokio::test]
async fn lost_answers() -> Result<()> {
    let daemon = Daemon::new().await;
    let relay = Relay::new(&daemon);
    let direct = daemon.connect().await;
    let connect = |seconds| Stage::connect().target(&relay.socket).timeout(Duration::from_secs(seconds));
    let stage = connect(4).await?;
    relay.cut_answers(3, 3); // stream 1 asks for the request memory
    assert_eq!(stage.axis("x")?.move_by(mm(1)).await?.to_string(), "x 1 mm");
    assert_eq!((direct.motions().await?.len(), relay.cuts()), (1, 3));

    let motion = stage.axis("x")?.move_to(mm(10)).start().await?;
    relay.cut_answers(1, 3);
    assert_eq!(motion.await?.to_string(), "x 10 mm");

    let stage = connect(2).await?;
    relay.cut_answers(3, 1000);
    assert!(is_unknown(&stage.axis("x")?.move_by(mm(-1)).await));
    assert_eq!(direct.motions().await?.len(), 3);
    Ok(())
}

#[tokio::test]
async fn a_lost_answer_without_a_journal() -> Result<()> {
    let daemon = Daemon::with("false", "").await;
    let relay = Relay::new(&daemon);
    let stage = Stage::connect().target(&relay.socket).await?;
    relay.cut_answers(3, 1);
    assert!(is_unknown(&stage.axis("x")?.move_by(mm(1)).await));
    assert_eq!(daemon.connect().await.motions().await?.len(), 1);
    Ok(())
}

#[tokio::test]
async fn a_limit_sensor_ends_a_motion() -> Result<()> {
    let daemon = Daemon::new().await;
    let motion = daemon.connect().await.axis("x")?.move_to(mm(14)).start().await?;
    daemon.at_stage("limit 1 cw on");
    assert!(matches!(motion.await, Err(Error::MotionFailed(problem)) if problem.reason == "LIMIT_DETECTED"));
    Ok(())
}

#[tokio::test]
async fn a_killed_daemon() -> Result<()> {
    let mut daemon = Daemon::new().await;
    let stage = Stage::connect().target(daemon.socket()).timeout(Duration::from_secs(2)).await?;
    let motion = stage.axis("x")?.move_to(mm(14)).start().await?;
    daemon.kill();
    let error = stage.axis("x")?.move_to(mm(1)).await.unwrap_err();
    assert!(error.is_unavailable(), "{error}");
    assert!(is_unknown(&stage.stop(ALL).await));
    assert!(Stage::connect().target(daemon.socket()).await.is_err_and(|error| error.is_unavailable()));
    daemon.start().await;
    assert!(is_unknown(&motion.await));
    until_async("the stop after the restart", || async {
        stage.status().await.is_ok_and(|status| status.open_stops.is_empty())
    })
    .await;
    assert_eq!(stage.axis("x")?.move_to(mm(0)).await?.to_string(), "x 0 mm");
    Ok(())
}

#[tokio::test]
async fn a_thousand_moves_leak_nothing() -> Result<()> {
    let daemon = Daemon::new().await;
    let stage = daemon.connect().await;
    let x = stage.axis("x")?;
    x.move_to(um(0)).await?;
    let open = || std::fs::read_dir("/proc/self/fd").map_or(0, Iterator::count);
    let tasks = || tokio::runtime::Handle::current().metrics().num_alive_tasks();
    let before = (open(), tasks());
    for i in 0..1000 {
        x.move_to(um(i % 2)).await?;
    }
    until_async("no more descriptors and tasks than before", || async { open() <= before.0 && tasks() <= before.1 })
        .await;
    Ok(())
}
