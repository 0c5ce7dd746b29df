use std::time::{Duration, Instant};

use futures_util::stream;

use crate::api;
use crate::errors::Result;
use crate::motion::Motion;
use crate::results::Position;
use crate::session::Session;
use crate::updates::Updates;

/// A Progress is how far a motion has come.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Progress {
    /// Part of the distance that is covered, from 0 to 1. None: the distance is unknown.
    pub fraction: Option<f64>,
    /// Present positions of the axes of the motion.
    pub positions: Vec<Position>,
    /// Number of finished segments of a path.
    pub segment: i32,
}

/// Returns the progress of a motion at each interval.
pub fn progress(motion: Motion, session: Session, interval: Duration) -> Updates<Progress> {
    let looking = Some(Looking { motion, session, interval, first: None });
    Updates::new(stream::unfold(looking, |looking| async move {
        let mut looking = looking?;
        match looking.next().await {
            Ok(progress) => progress.map(|progress| (Ok(progress), Some(looking))),
            Err(error) => Some((Err(error), None)),
        }
    }))
}

struct Looking {
    motion: Motion,
    session: Session,
    interval: Duration,
    /// State of the device at the first look.
    first: Option<api::Device>,
}

impl Looking {
    /// Returns None once the motion has its outcome.
    async fn next(&mut self) -> Result<Option<Progress>> {
        self.motion.follow(Some(Instant::now() + self.interval)).await?;
        if self.motion.is_over() {
            return Ok(None);
        }
        let now = self.session.read(None).await?;
        let first = self.first.get_or_insert_with(|| now.clone());
        let progress = progress_of(&self.motion.message(), first, &now);
        Ok(Some(progress))
    }
}

fn progress_of(motion: &api::Motion, first: &api::Device, now: &api::Device) -> Progress {
    let axes = now.axes.iter().filter(|axis| motion.axes.contains(&axis.number));
    let positions = axes
        .map(|axis| Position::new(&axis.name, axis.number, &axis.position, axis.unit, axis.position_pulses))
        .collect();
    let fraction = match motion.segments_total {
        0 => motion.results.iter().filter_map(|axis| covered(axis, first, now)).reduce(f64::min),
        total => Some(f64::from(motion.segments_done) / f64::from(total)),
    };
    Progress { fraction, positions, segment: motion.segments_done }
}

/// Returns the part of its distance that an axis has covered. None: unknown.
fn covered(axis: &api::AxisResult, first: &api::Device, now: &api::Device) -> Option<f64> {
    let pulses = |device: &api::Device| device.axes.iter().find(|one| one.number == axis.axis)?.position_pulses;
    let (first, now, target) = (pulses(first)?, pulses(now)?, axis.target_pulses?);
    (target != first).then(|| (now - first) as f64 / (target - first) as f64)
}
