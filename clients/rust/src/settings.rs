use std::time::Duration;

use crate::api;
use crate::connection::received;
use crate::errors::Result;
use crate::stage::Stage;
use crate::units::Speed;

/// Time for which a change may wait for running commands.
const CHANGE_TIME: Duration = Duration::from_secs(20);

/// AxisSettings are settings of one axis. None: unknown; in a change: stays as it is.
///
/// ```no_run
/// # async fn run(stage: axisgate::Stage) -> axisgate::Result<()> {
/// let mut off = axisgate::AxisSettings::new("x");
/// off.motor_on = Some(false);
/// stage.change_settings([off]).await?;
/// # Ok(())
/// # }
/// ```
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct AxisSettings {
    /// Name or number of the axis.
    pub axis: String,
    /// True if the motor has current.
    pub motor_on: Option<bool>,
    /// True if a scale corrects the position.
    pub closed_loop: Option<bool>,
    /// Speed at which a motion begins and ends.
    pub minimum_speed: Option<Speed>,
    /// Highest speed of a motion.
    pub maximum_speed: Option<Speed>,
    /// Time from the minimum to the maximum speed: whole milliseconds.
    pub acceleration_time: Option<Duration>,
}

impl AxisSettings {
    /// Returns settings in which nothing is set.
    pub fn new(axis: impl ToString) -> AxisSettings {
        AxisSettings {
            axis: axis.to_string(),
            motor_on: None,
            closed_loop: None,
            minimum_speed: None,
            maximum_speed: None,
            acceleration_time: None,
        }
    }

    fn of(message: api::AxisSettings) -> AxisSettings {
        let speeds = message.speeds.unwrap_or_default();
        AxisSettings {
            axis: message.axis,
            motor_on: message.excited,
            closed_loop: message.closed_loop,
            minimum_speed: Speed::of(speeds.minimum.as_ref()),
            maximum_speed: Speed::of(speeds.maximum.as_ref()),
            acceleration_time: speeds.acceleration_time.and_then(|time| time.try_into().ok()),
        }
    }

    fn message(self) -> Result<api::AxisSettings> {
        let speeds = api::Profile {
            minimum: self.minimum_speed.as_ref().map(Speed::message).transpose()?,
            maximum: self.maximum_speed.as_ref().map(Speed::message).transpose()?,
            acceleration_time: self.acceleration_time.map(api::duration),
        };
        Ok(api::AxisSettings {
            axis: self.axis,
            excited: self.motor_on,
            closed_loop: self.closed_loop,
            speeds: (speeds != api::Profile::default()).then_some(speeds),
            ..api::AxisSettings::default()
        })
    }
}

impl Stage {
    /// Reads the settings of the axes from the controller.
    pub async fn settings(&self) -> Result<Vec<AxisSettings>> {
        let request = api::GetSettingsRequest { device: self.session.device.to_string() };
        let settings = received(self.session.ask(request).await?.settings)?;
        Ok(settings.axes.into_iter().map(AxisSettings::of).collect())
    }

    /// Changes the settings that are set, and no others. Speeds that are set under a lease return to their values after
    /// it.
    pub async fn change_settings(&self, changes: impl IntoIterator<Item = AxisSettings>) -> Result<()> {
        let axes = changes.into_iter().map(AxisSettings::message).collect::<Result<_>>()?;
        let settings = Some(api::Settings { axes, ..api::Settings::default() });
        let device = self.session.device.to_string();
        let request = api::ChangeSettingsRequest { device, settings, ..Default::default() };
        self.session.change_for(request, CHANGE_TIME).await.map(drop)
    }
}
