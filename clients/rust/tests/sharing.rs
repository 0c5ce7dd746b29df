//! Leases, jogs, paths, scans, places, settings, commands and streams, against the daemon.

mod daemon;

use std::future::IntoFuture;
use std::time::Duration;

use axisgate::{
    mm, um, AxisSettings, Error, Event, EventOrGap, Fact, MotionState, Reason, Result, Stage, Updates, ALL,
};
use daemon::relay::Relay;
use daemon::{until_async, Daemon};

fn reason<T: std::fmt::Debug>(result: Result<T>) -> Reason {
    match result {
        Err(error) => error.problem().map(|problem| problem.reason.clone()).unwrap_or_default(),
        Ok(value) => panic!("{value:?} is no error"),
    }
}

#[tokio::test]
async fn leases() -> Result<()> {
    let daemon = Daemon::new().await;
    let stage = daemon.connect().await;
    let lease = stage.lease(["x"]).ttl(Duration::from_secs(1)).purpose("a test").await?;
    assert_eq!(lease.leased_axes(), [1]);
    assert_eq!(lease.axis("x")?.move_to(mm(0.1)).await?.to_string(), "x 0.1 mm");
    assert_eq!(reason(stage.axis("x")?.move_to(mm(0)).await), Reason::LEASE_HELD);
    assert!(daemon.other(&["move", "x=1mm"]).await.is_err_and(|text| text.contains("LEASE_HELD")));
    daemon.other(&["move", "y=0.1mm"]).await.expect("a move of a free axis");
    tokio::time::sleep(Duration::from_millis(2500)).await; // longer than the lease lasts unless it is kept alive
    assert_eq!(lease.axis("x")?.move_to(mm(0)).await?.to_string(), "x 0 mm");
    assert_eq!(lease.problem(), None);
    lease.release().await?;
    daemon.other(&["move", "x=0.1mm"]).await.expect("a move of a free axis");
    drop(stage.lease(ALL).await?);
    stage.clone().close().await; // waits for the release
    daemon.other(&["move", "x=0.2mm"]).await.expect("a move of a free axis");
    Ok(())
}

#[tokio::test]
async fn a_lost_lease() -> Result<()> {
    let mut daemon = Daemon::new().await;
    let stage = daemon.connect().await;
    let lease = stage.lease(["x"]).ttl(Duration::from_secs(1)).await?;
    daemon.kill();
    daemon.start().await;
    let lost = tokio::time::timeout(Duration::from_secs(30), lease.lost()).await;
    assert!(lost.is_ok_and(|problem| problem.reason == Reason::LEASE_LOST));
    assert_eq!(reason(lease.axis("x")?.move_to(mm(1)).await), Reason::LEASE_LOST);
    lease.release().await
}

#[tokio::test]
async fn hand_over() -> Result<()> {
    let daemon = Daemon::new().await;
    let stage = Stage::connect().target(daemon.address()).await?;
    let mut lease = stage.lease(["x"]).await?;
    let waiting = daemon.connect().await;
    let name = waiting.whoami().await?.name;
    let next = tokio::spawn(waiting.lease(["x"]).wait(Duration::from_secs(20)).into_future());
    let lease = &mut lease;
    let name = name.as_str();
    let mut is_over = false;
    while !is_over {
        is_over = lease.hand_over(name).await.is_ok();
        assert!(!next.is_finished() || is_over);
        tokio::time::sleep(Duration::from_millis(20)).await; // between two attempts
    }
    next.await.expect("a task")?.release().await
}

#[tokio::test]
async fn jogs() -> Result<()> {
    let daemon = Daemon::new().await;
    let stage = daemon.connect().await;
    let jog = stage.jog([("x", um(-200).per_second())]).await?;
    tokio::time::sleep(Duration::from_millis(700)).await; // longer than the daemon waits for a message
    let motion = jog.motion().clone();
    let result = jog.stop().await?;
    assert!(result.positions[0].pulses.is_some_and(|pulses| pulses < 0) && motion.state() == MotionState::Succeeded);

    assert_eq!(reason(stage.jog([("x", mm(1000).per_second())]).await.map(drop)), "OUT_OF_RANGE");

    let jog = stage.jog([("x", um(200).per_second())]).await?;
    let motion = jog.motion().clone();
    drop(jog);
    until_async("the end of a dropped jog", || async { motion.is_done().await.is_ok_and(|done| done) }).await;

    let jog = stage.jog([("x", um(200).per_second())]).await?;
    daemon.other(&["stop"]).await.expect("a stop");
    assert!(matches!(jog.stop().await, Err(Error::Stopped(_))));
    Ok(())
}

#[tokio::test]
async fn paths_and_scans() -> Result<()> {
    let daemon = Daemon::new().await;
    let stage = daemon.connect().await;
    let speed = || um(500).per_second();
    let motion = stage.path(["x", "y"], (1..=10).map(|i| [um(100 * i), um(50 * i)])).speed(speed()).start().await?;
    let mut progress = motion.progress(Duration::from_millis(50));
    while let Some(progress) = progress.next().await {
        let progress = progress?;
        assert!(progress.fraction.is_some_and(|part| part >= 0.0) && progress.positions.len() == 2);
    }
    assert_eq!(motion.await?.to_string(), "x 1 mm, y 0.5 mm");
    let outside = stage.path(["x", "y"], [[mm(1), mm(1)], [mm(20), mm(1)]]).speed(speed());
    assert_eq!(reason(outside.await), Reason::OUTSIDE_TRAVEL);
    let failing = [Ok([mm(1)]), Err("a point cannot be computed")];
    assert!(matches!(stage.path(["x"], failing).await, Err(Error::Points(_))));

    let scan = stage.scan("x", mm(0), mm(1), um(100)).speed(um(200).per_second()).await?.scan.expect("a scan");
    assert!(scan.expected_in_range == Some(11) && scan.observed.is_some() && scan.observed == scan.expected);

    let mut visited = stage.visit(["x"], [[mm(0.1)], [mm(0.2)]]);
    assert_eq!(visited.next().await.expect("a point")?.to_string(), "x 0.1 mm");
    assert_eq!(visited.next().await.expect("a point")?.to_string(), "x 0.2 mm");
    assert!(visited.next().await.is_none());
    Ok(())
}

#[tokio::test]
async fn places_settings_and_commands() -> Result<()> {
    let daemon = Daemon::new().await;
    let stage = daemon.connect().await;
    let (x, places) = (stage.axis("x")?, stage.places());
    x.move_to(mm("0.2")).await?;
    places.save("sample").await?;
    x.move_to(mm(1)).await?;
    assert_eq!(places.move_to("sample").await?.positions[0].to_string(), "x 0.2 mm");
    assert_eq!(places.list().await?["sample"][0].to_string(), "x 0.2 mm");
    places.delete("sample").await?;
    assert_eq!(reason(places.delete("sample").await), "NOT_FOUND");

    let executed = stage.execute(["M:1+P100", "G:1"]).await?;
    assert_eq!(executed.answers.len(), 2);
    executed.motion.expect("a motion").await?;
    assert!(matches!(stage.execute(["XYZ:"]).await, Err(Error::Refused(_))));

    let mut off = AxisSettings::new("x");
    off.motor_on = Some(false);
    stage.change_settings([off]).await?;
    assert_eq!(stage.settings().await?[0].motor_on, Some(false));
    assert_eq!(reason(x.move_to(mm(1)).await), "NOT_EXCITED");
    Ok(())
}

#[tokio::test]
async fn streams() -> Result<()> {
    let mut daemon = Daemon::new().await;
    let relay = Relay::new(&daemon);
    let stage = Stage::connect().target(&relay.socket).await?;
    let status = stage.watch(Duration::ZERO).await?.next().await.expect("a state")?;
    assert_eq!((status.link.as_str(), status.axes.len()), ("UP", 3));

    let mut events = stage.events_from(0).await?;
    let direct = daemon.connect().await;
    let first = moved(&direct, &mut events).await?;
    relay.cut_answers(1, 1);
    let second = moved(&direct, &mut events).await?;
    daemon.kill();
    daemon.start().await;
    let third = moved(&daemon.connect().await, &mut events).await?;
    assert!(first.revision < second.revision && second.revision < third.revision);
    match stage.events_after(&first).await?.next().await {
        Some(Ok(EventOrGap::Event(next))) => assert_eq!(next.revision, first.revision + 1),
        other => panic!("{other:?} is not the next event"),
    }
    Ok(())
}

/// Moves, and reads events until the move has succeeded.
async fn moved(stage: &Stage, events: &mut Updates<EventOrGap>) -> Result<Event> {
    let name = stage.axis("x")?.move_to(mm(1)).await?.motion;
    loop {
        match events.next().await.expect("an event")? {
            EventOrGap::Event(event) => match &event.fact {
                Fact::Motion { motion, state: MotionState::Succeeded, .. } if *motion == name => return Ok(event),
                _ => {}
            },
            gap => panic!("{gap:?}"),
        }
    }
}
