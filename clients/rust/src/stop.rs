use std::fmt;
use std::time::Duration;

use crate::api;
use crate::errors::{Error, Result};
use crate::failure::{classified, problem_of};
use crate::results::{joined, Position};
use crate::stage::{names, Stage};

/// Longest time until the answer to a stop, which then has what is known.
const STOP_TIME: Duration = Duration::from_secs(4);

/// An AxisStop is the result of a stop for one axis.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct AxisStop {
    /// Position that was seen after the stop.
    pub position: Position,
    /// True if the axis is stationary. None: the axis was not seen after the stop.
    pub stationary: Option<bool>,
}

impl fmt::Display for AxisStop {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let state = match self.stationary {
            Some(true) => "stationary",
            Some(false) => "still moving",
            None => "not seen stationary",
        };
        write!(f, "{} ({state})", self.position)
    }
}

/// A StopReport is what was seen of a stop.
#[derive(Debug)]
#[non_exhaustive]
pub struct StopReport {
    /// Results of the axes, in the order of their numbers.
    pub axes: Vec<AxisStop>,
    /// True if the axes were not confirmed stationary. The daemon then repeats the stop, and refuses motion of these
    /// axes.
    pub stays_open: bool,
    /// Why the axes were not confirmed stationary. None: no problem.
    pub problem: Option<Error>,
}

impl StopReport {
    fn of(devices: Vec<api::DeviceStop>, stays_open: bool) -> StopReport {
        let problem = devices.iter().find_map(|device| device.problem.as_ref());
        let problem = problem.map(|problem| classified(problem_of(problem, String::new())));
        let axes = devices.iter().flat_map(|device| &device.axes).map(|axis| AxisStop {
            position: Position::new(&axis.name, axis.axis, &axis.position, axis.unit, axis.position_pulses),
            stationary: axis.ready,
        });
        StopReport { axes: axes.collect(), stays_open, problem }
    }
}

impl fmt::Display for StopReport {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&joined(&self.axes))?;
        if self.stays_open {
            f.write_str("; the stop stays open")?;
        }
        match &self.problem {
            Some(problem) => write!(f, ": {problem}"),
            None => Ok(()),
        }
    }
}

impl Stage {
    /// Slows down and stops axes. [`ALL`](crate::ALL): all axes of the stage. Needs no lease. Not a safety function.
    ///
    /// The report says what was seen within 4 s. The stop is sent again for half of the time limit of a call if no
    /// daemon answers. It is sent even if the future is dropped once it was polled.
    pub async fn stop<A: ToString>(&self, axes: impl IntoIterator<Item = A>) -> Result<StopReport> {
        let request = api::StopRequest {
            context: self.session.lease_context(),
            device: self.session.device.to_string(),
            axes: names(axes),
            max_wait: Some(api::duration(STOP_TIME)),
        };
        let answer = self.session.stop(request).await?;
        Ok(StopReport::of(answer.devices, answer.stays_open))
    }

    /// Stops all axes at once without slowing down. Nothing moves until [`Stage::clear_errors`]. Otherwise does the same
    /// as [`Stage::stop`]. Not a safety function.
    pub async fn emergency_stop(&self) -> Result<StopReport> {
        let request = api::EmergencyStopRequest {
            context: self.session.lease_context(),
            device: self.session.device.to_string(),
            max_wait: Some(api::duration(STOP_TIME)),
        };
        let answer = self.session.stop(request).await?;
        Ok(StopReport::of(answer.devices, answer.stays_open))
    }

    /// Clears limit, overflow and emergency errors of axes. [`ALL`](crate::ALL): all axes. Starts no motion.
    pub async fn clear_errors<A: ToString>(&self, axes: impl IntoIterator<Item = A>) -> Result<()> {
        let (device, axes) = (self.session.device.to_string(), names(axes));
        let request = api::ClearErrorsRequest { device, axes, ..Default::default() };
        self.session.change(request).await.map(drop)
    }
}
