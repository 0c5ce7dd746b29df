use std::collections::HashMap;
use std::future::IntoFuture;
use std::time::Duration;

use axisgate::{Error, EventOrGap, Fact, Lease, Motion, MotionState, Move, Plan, Result, Stage, Updates, ALL};
use serde_json::{json, Value};
use tokio::time::timeout;

use crate::act::Act;
use crate::shown;

/// A Runner has what earlier acts have made.
#[derive(Default)]
pub struct Runner {
    stage: Option<Stage>,
    motions: HashMap<String, Motion>,
    leases: HashMap<String, Lease>,
    events: Option<Updates<EventOrGap>>,
    revisions: Vec<u64>,
}

fn done() -> Value {
    json!({"outcome": "done"})
}

fn no_such(what: &str) -> Error {
    Error::InvalidArgument(format!("the runner has no {what}"))
}

impl Runner {
    /// Returns the stage, with the lease that the act names.
    fn stage(&self, act: &Act) -> Result<&Stage> {
        match self.leases.get(act.text("lease")) {
            Some(lease) => Ok(lease),
            None => self.stage.as_ref().ok_or_else(|| no_such("stage")),
        }
    }

    fn motion(&self, act: &Act) -> Result<&Motion> {
        self.motions.get(act.text("motion")).ok_or_else(|| no_such("motion"))
    }

    fn lease(&self, act: &Act) -> Result<&Lease> {
        self.leases.get(act.text("lease")).ok_or_else(|| no_such("lease"))
    }

    fn plan(&self, act: &Act) -> Result<Plan<Move>> {
        let amount = act.distance("amount").ok_or_else(|| no_such("unit for a bare number"))?;
        let plan = self.stage(act)?.axis(act.text("axis"))?.move_to(amount);
        Ok(match act.speed() {
            Some(speed) => plan.speed(speed),
            None => plan,
        })
    }

    pub async fn reply(&mut self, act: &Act) -> Result<Value> {
        match act.text("say") {
            "open" => {
                self.stage = None;
                self.stage = Some(act.connection().await?);
                Ok(done())
            }
            "whoami" => Ok(json!({"outcome": "done", "role": self.stage(act)?.whoami().await?.role})),
            "axes" => {
                let axes = self.stage(act)?.axes();
                let axes: Vec<Value> = axes.iter().map(|axis| json!([axis.name(), axis.number()])).collect();
                Ok(json!({"outcome": "done", "axes": axes}))
            }
            "home" => Ok(shown(&self.stage(act)?.home(act.axes()).await?)),
            "move_to" => self.move_to(act).await,
            "move_by" => {
                let amount = act.distance("amount").ok_or_else(|| no_such("unit"))?;
                Ok(shown(&self.stage(act)?.axis(act.text("axis"))?.move_by(amount).await?))
            }
            "start" => {
                let motion = self.plan(act)?.start().await?;
                self.motions.insert(act.text("motion").to_string(), motion);
                Ok(json!({"outcome": "started"}))
            }
            "wait" => {
                let limit = act.seconds("timeout").unwrap_or(Duration::from_secs(3600));
                match timeout(limit, self.motion(act)?.wait()).await {
                    Ok(result) => Ok(shown(&result?)),
                    Err(_) => Ok(json!({"outcome": "timeout"})),
                }
            }
            "cancel" => self.motion(act)?.cancel().await.map(|()| done()),
            "stop" => {
                let report = self.stage(act)?.stop(ALL).await?;
                Ok(json!({"outcome": "done", "stays_open": report.stays_open}))
            }
            "rearm" => self.stage(act)?.rearm().await.map(|_| done()),
            "saturate" => {
                for _ in 0..act.count("calls") {
                    tokio::spawn(self.motion(act)?.clone().into_future());
                }
                Ok(done())
            }
            "path" => {
                let plan = self.stage(act)?.path(act.axes(), act.points());
                Ok(shown(&plan.speed(act.speed().ok_or_else(|| no_such("speed"))?).await?))
            }
            "scan" => self.scan(act).await,
            "events" => {
                self.events = Some(self.stage(act)?.events().await?);
                Ok(done())
            }
            "succeeded" => self.succeeded(act.count("count")).await,
            _ => self.reply_about_lease(act).await,
        }
    }

    async fn reply_about_lease(&mut self, act: &Act) -> Result<Value> {
        match act.text("say") {
            "lease" => {
                let terms = self.stage(act)?.lease(act.axes()).ttl(act.seconds("ttl").unwrap_or_default());
                self.leases.insert(act.text("lease").to_string(), terms.await?);
                Ok(done())
            }
            "lost" => {
                let (lease, within) = (self.lease(act)?, act.seconds("within").unwrap_or_default());
                let lost = timeout(within, lease.lost()).await;
                Ok(json!({"outcome": "done", "lost": lost.is_ok() && lease.problem().is_some()}))
            }
            "release" => {
                let lease = self.leases.remove(act.text("lease")).ok_or_else(|| no_such("lease"))?;
                lease.release().await.map(|()| done())
            }
            other => Ok(json!({"outcome": "unexpected", "message": format!("{other}: no such act")})),
        }
    }

    async fn move_to(&self, act: &Act) -> Result<Value> {
        let plan = self.plan(act)?;
        match act.seconds("interrupt_after") {
            None => Ok(shown(&plan.await?)),
            Some(limit) => match timeout(limit, plan).await {
                Ok(result) => Ok(shown(&result?)),
                Err(_) => Ok(json!({"outcome": "interrupted"})),
            },
        }
    }

    async fn scan(&self, act: &Act) -> Result<Value> {
        let distance = |key| act.distance(key).ok_or_else(|| no_such(key));
        let plan = self.stage(act)?.scan(act.text("axis"), distance("from")?, distance("to")?, distance("every")?);
        let result = plan.speed(act.speed().ok_or_else(|| no_such("speed"))?).await?;
        let scan = result.scan.ok_or_else(|| no_such("result of a scan"))?;
        let equals = scan.observed.is_some() && scan.observed == scan.expected;
        Ok(json!({"outcome": "done", "expected": scan.expected_in_range, "observed_equals_expected": equals}))
    }

    /// Reads events until so many motions have succeeded.
    async fn succeeded(&mut self, count: usize) -> Result<Value> {
        let (mut gaps, mut ended) = (0, 0);
        let events = self.events.as_mut().ok_or_else(|| no_such("events"))?;
        while ended < count {
            match events.next().await.ok_or_else(|| no_such("more events"))?? {
                EventOrGap::Gap { .. } => gaps += 1,
                EventOrGap::Event(event) => {
                    self.revisions.push(event.revision);
                    ended += usize::from(matches!(event.fact, Fact::Motion { state: MotionState::Succeeded, .. }));
                }
            }
        }
        let is_ascending = self.revisions.windows(2).all(|pair| pair[0] < pair[1]);
        Ok(json!({"outcome": "done", "ascending": is_ascending, "gaps": gaps}))
    }
}
