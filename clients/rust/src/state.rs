use std::fmt;
use std::time::Duration;

use crate::api;
use crate::connect::short_name;
use crate::errors::Result;
use crate::results::{joined, Position};
use crate::stage::Stage;
use crate::units::{Distance, Unit};
use crate::updates::{begin, Feed, Updates};

/// An AxisState is the state of one axis. None: unknown; of a limit: there is none.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct AxisState {
    /// Number of the axis, from 1.
    pub number: i32,
    /// Name from the configuration, or the number as text.
    pub name: String,
    /// Unit of the positions.
    pub unit: Unit,
    /// Position as last read.
    pub position: Position,
    /// True if the axis moves.
    pub moving: Option<bool>,
    /// True if the motor has current.
    pub motor_on: Option<bool>,
    /// True if the daemon has homed the axis.
    pub homed: bool,
    /// Lower travel limit from the configuration.
    pub minimum: Option<Distance>,
    /// Upper travel limit from the configuration.
    pub maximum: Option<Distance>,
    /// Names of the present conditions, such as "CW_LIMIT".
    pub conditions: Vec<String>,
}

impl AxisState {
    fn of(axis: &api::Axis) -> AxisState {
        let position = Position::new(&axis.name, axis.number, &axis.position, axis.unit, axis.position_pulses);
        let condition = |number: &i32| api::enum_name(*number, "CONDITION_", api::Condition::as_str_name);
        AxisState {
            number: axis.number,
            name: position.axis.clone(),
            unit: position.unit,
            position,
            moving: axis.busy,
            motor_on: axis.excited,
            homed: axis.homed,
            minimum: Distance::of(axis.travel_minimum.as_ref()),
            maximum: Distance::of(axis.travel_maximum.as_ref()),
            conditions: axis.conditions.iter().map(condition).collect(),
        }
    }
}

/// A Status is the state of a stage. Axes that the controller does not allow to be moved are left out.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Status {
    /// Name of the device.
    pub device: String,
    /// "UP" if the controller answers.
    pub link: String,
    /// Why the controller does not answer. Empty: it does.
    pub link_problem: String,
    /// Mode of the controller: "HOST".
    pub mode: String,
    /// Axes, in the order of their numbers.
    pub axes: Vec<AxisState>,
    /// Names of the stops that are not confirmed yet. Their axes cannot be moved.
    pub open_stops: Vec<String>,
}

impl Status {
    fn of(device: &api::Device) -> Status {
        Status {
            device: short_name(&device.name).to_string(),
            link: api::enum_name(device.link, "LINK_STATE_", api::LinkState::as_str_name),
            link_problem: device.link_problem.clone(),
            mode: api::enum_name(device.mode, "MODE_", api::Mode::as_str_name),
            axes: device.axes.iter().filter(|axis| axis.controllable).map(AxisState::of).collect(),
            open_stops: device.open_stops.iter().map(|stop| stop.name.clone()).collect(),
        }
    }

    /// Returns the state of an axis by its name. None: there is no such axis.
    pub fn axis(&self, name: &str) -> Option<&AxisState> {
        self.axes.iter().find(|axis| axis.name == name)
    }
}

impl fmt::Display for Status {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} {}: {}", self.device, self.link, self.link_problem)?;
        let positions: Vec<&Position> = self.axes.iter().map(|axis| &axis.position).collect();
        f.write_str(&joined(&positions))
    }
}

/// The feed of Stage::watch().
struct States(api::WatchDeviceRequest);

impl Feed for States {
    type Request = api::WatchDeviceRequest;
    type Item = Status;

    fn request(&self) -> api::WatchDeviceRequest {
        self.0.clone()
    }

    fn item(&mut self, answer: api::WatchDeviceResponse) -> Option<Status> {
        answer.device.as_ref().map(Status::of)
    }
}

impl Stage {
    /// Returns the newest known state of the stage.
    pub async fn status(&self) -> Result<Status> {
        Ok(Status::of(&self.session.read(None).await?))
    }

    /// Returns the state of the stage, which is read from the controller if it is older than `max_age`.
    pub async fn fresh_status(&self, max_age: Duration) -> Result<Status> {
        Ok(Status::of(&self.session.read(Some(max_age)).await?))
    }

    /// Returns the newest state of the stage, now and after every change. A slow reader skips states. The series
    /// continues after a broken connection. `interval` is the minimum time between two states.
    pub async fn watch(&self, interval: Duration) -> Result<Updates<Status>> {
        let (device, min_interval) = (self.session.device.to_string(), Some(api::duration(interval)));
        let request = api::WatchDeviceRequest { device, min_interval };
        begin(self.session.connection.clone(), States(request)).await
    }
}
