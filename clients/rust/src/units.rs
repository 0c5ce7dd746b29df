use std::fmt;
use std::ops::Neg;

use crate::api;
use crate::errors::{Error, Result};
use crate::number::{Form, Number};

/// Units of distances.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Unit {
    /// Drive pulses, the smallest step of an axis.
    Pulses,
    /// nm
    Nanometers,
    /// um
    Micrometers,
    /// mm
    Millimeters,
    /// deg, of a rotary axis
    Degrees,
    /// Unit of a newer daemon, by its number.
    Other(i32),
}

impl Unit {
    pub(crate) fn of(number: i32) -> Unit {
        match api::Unit::try_from(number) {
            Ok(api::Unit::Pulses) => Unit::Pulses,
            Ok(api::Unit::Nanometers) => Unit::Nanometers,
            Ok(api::Unit::Micrometers) => Unit::Micrometers,
            Ok(api::Unit::Millimeters) => Unit::Millimeters,
            Ok(api::Unit::Degrees) => Unit::Degrees,
            Ok(api::Unit::Unspecified) | Err(_) => Unit::Other(number),
        }
    }

    fn number(self) -> i32 {
        match self {
            Unit::Pulses => api::Unit::Pulses as i32,
            Unit::Nanometers => api::Unit::Nanometers as i32,
            Unit::Micrometers => api::Unit::Micrometers as i32,
            Unit::Millimeters => api::Unit::Millimeters as i32,
            Unit::Degrees => api::Unit::Degrees as i32,
            Unit::Other(number) => number,
        }
    }
}

impl fmt::Display for Unit {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Unit::Pulses => f.write_str("pulses"),
            Unit::Nanometers => f.write_str("nm"),
            Unit::Micrometers => f.write_str("um"),
            Unit::Millimeters => f.write_str("mm"),
            Unit::Degrees => f.write_str("deg"),
            Unit::Other(number) => write!(f, "UNIT {number}"),
        }
    }
}

/// A Distance is a position or a displacement: `mm("1.5")`. A wrong number is an
/// [`InvalidArgument`](Error::InvalidArgument) of the call that uses it.
#[derive(Clone, Debug, PartialEq)]
pub struct Distance {
    number: Number,
    unit: Unit,
}

/// A Speed is a distance for each second: `mm(2).per_second()`. A jog in the minus direction has a negative speed.
#[derive(Clone, Debug, PartialEq)]
pub struct Speed(Distance);

macro_rules! units {
    ($($name:ident $unit:ident $what:literal;)*) => {$(
        #[doc = concat!("Returns a distance in ", $what, ".")]
        pub fn $name(number: impl Into<Number>) -> Distance {
            Distance { number: number.into(), unit: Unit::$unit }
        }
    )*};
}

units! {
    nm Nanometers "nanometres";
    um Micrometers "micrometres";
    mm Millimeters "millimetres";
    deg Degrees "degrees, for a rotary axis";
    pulses Pulses "drive pulses, the smallest step of an axis";
}

impl Distance {
    /// Returns the speed of this distance in each second.
    pub fn per_second(self) -> Speed {
        Speed(self)
    }

    /// Returns the API's message. Fails unless the number is finite, and is a decimal if it is a text.
    pub(crate) fn message(&self) -> Result<api::Distance> {
        use api::distance::Amount;
        let amount = match self.number.checked()? {
            Form::Float(number) => Amount::Floating(floating(*number, self.unit)),
            Form::Exact(text) => match self.unit {
                Unit::Nanometers => Amount::Nm(text.clone()),
                Unit::Micrometers => Amount::Um(text.clone()),
                Unit::Millimeters => Amount::Mm(text.clone()),
                Unit::Degrees => Amount::Degrees(text.clone()),
                Unit::Pulses | Unit::Other(_) => Amount::Pulses(whole(text)?),
            },
        };
        Ok(api::Distance { amount: Some(amount) })
    }

    /// Returns the distance of a message. None: the message has none.
    pub(crate) fn of(message: Option<&api::Distance>) -> Option<Distance> {
        use api::distance::Amount;
        match message?.amount.as_ref()? {
            Amount::Pulses(count) => Some(pulses(*count)),
            Amount::Nm(text) => Some(nm(text)),
            Amount::Um(text) => Some(um(text)),
            Amount::Mm(text) => Some(mm(text)),
            Amount::Degrees(text) => Some(deg(text)),
            Amount::Floating(amount) => Some(Distance { number: amount.value.into(), unit: Unit::of(amount.unit) }),
        }
    }
}

impl Speed {
    pub(crate) fn is_negative(&self) -> bool {
        self.0.number.is_negative()
    }

    /// Returns the API's message. Fails as [`Distance::message`] does.
    pub(crate) fn message(&self) -> Result<api::Speed> {
        use api::speed::Amount;
        let amount = match self.0.number.checked()? {
            Form::Float(number) => Amount::Floating(floating(*number, self.0.unit)),
            Form::Exact(text) => match self.0.unit {
                Unit::Nanometers => Amount::NmPerS(text.clone()),
                Unit::Micrometers => Amount::UmPerS(text.clone()),
                Unit::Millimeters => Amount::MmPerS(text.clone()),
                Unit::Degrees => Amount::DegreesPerS(text.clone()),
                Unit::Pulses | Unit::Other(_) => Amount::PulsesPerS(whole(text)?),
            },
        };
        Ok(api::Speed { amount: Some(amount) })
    }

    /// Returns the speed of a message. None: the message has none.
    pub(crate) fn of(message: Option<&api::Speed>) -> Option<Speed> {
        use api::speed::Amount;
        let distance = match message?.amount.as_ref()? {
            Amount::PulsesPerS(count) => pulses(*count),
            Amount::NmPerS(text) => nm(text),
            Amount::UmPerS(text) => um(text),
            Amount::MmPerS(text) => mm(text),
            Amount::DegreesPerS(text) => deg(text),
            Amount::Floating(amount) => Distance { number: amount.value.into(), unit: Unit::of(amount.unit) },
        };
        Some(Speed(distance))
    }
}

fn floating(value: f64, unit: Unit) -> api::FloatingAmount {
    api::FloatingAmount { value, unit: unit.number(), rounding: api::Rounding::Nearest as i32 }
}

fn whole(text: &str) -> Result<i64> {
    text.parse().map_err(|_| Error::invalid(format!("{text} is not a whole number of pulses")))
}

impl Neg for Distance {
    type Output = Distance;

    /// Returns the opposite distance.
    fn neg(self) -> Distance {
        Distance { number: -self.number, unit: self.unit }
    }
}

impl Neg for Speed {
    type Output = Speed;

    /// Returns the speed in the opposite direction.
    fn neg(self) -> Speed {
        Speed(-self.0)
    }
}

impl fmt::Display for Distance {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} {}", self.number, self.unit)
    }
}

impl fmt::Display for Speed {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}/s", self.0)
    }
}
