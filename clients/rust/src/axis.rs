use std::fmt;
use std::time::Duration;

use crate::api;
use crate::errors::{Error, Result};
use crate::moves::{Home, Move};
use crate::plan::Plan;
use crate::results::{axis_name, Position};
use crate::stage::Stage;
use crate::state::AxisState;
use crate::stop::StopReport;
use crate::units::{Distance, Unit};

/// An Axis is one axis of a [`Stage`].
#[derive(Clone, Debug)]
pub struct Axis {
    stage: Stage,
    names: AxisNames,
}

/// AxisNames are the name, the number and the unit of an axis, from the configuration.
#[derive(Clone, Debug)]
pub(crate) struct AxisNames {
    pub name: String,
    number: i32,
    unit: Unit,
}

impl AxisNames {
    pub fn of(axis: &api::Axis) -> AxisNames {
        AxisNames { name: axis_name(&axis.name, axis.number), number: axis.number, unit: Unit::of(axis.unit) }
    }

    pub fn is(&self, axis: &str) -> bool {
        self.name == axis || self.number.to_string() == axis
    }
}

impl Axis {
    pub(crate) fn new(stage: Stage, names: AxisNames) -> Axis {
        Axis { stage, names }
    }

    /// Returns the name from the configuration, or the number as text.
    pub fn name(&self) -> &str {
        &self.names.name
    }

    /// Returns the number of the axis, from 1.
    pub fn number(&self) -> i32 {
        self.names.number
    }

    /// Returns the unit in which positions of the axis are shown.
    pub fn unit(&self) -> Unit {
        self.names.unit
    }

    /// Reads the present state of the axis from the controller.
    pub async fn state(&self) -> Result<AxisState> {
        let status = self.stage.fresh_status(Duration::ZERO).await?;
        let state = status.axes.into_iter().find(|state| state.number == self.names.number);
        state.ok_or_else(|| Error::invalid(format!("the stage has no axis {self}")))
    }

    /// Reads the present position of the axis from the controller.
    pub async fn position(&self) -> Result<Position> {
        Ok(self.state().await?.position)
    }

    /// Moves the axis to a position. See [`Plan`] for starting and cancelling the move.
    pub fn move_to(&self, target: Distance) -> Plan<Move> {
        self.stage.move_to([(self.name(), target)])
    }

    /// Moves the axis by a displacement from the present position.
    pub fn move_by(&self, displacement: Distance) -> Plan<Move> {
        self.stage.move_by([(self.name(), displacement)])
    }

    /// Homes the axis.
    pub fn home(&self) -> Plan<Home> {
        self.stage.home([self.name()])
    }

    /// Stops the axis. See [`Stage::stop`].
    pub async fn stop(&self) -> Result<StopReport> {
        self.stage.stop([self.name()]).await
    }
}

impl fmt::Display for Axis {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}
