use std::fmt;
use std::ops::Neg;

use crate::errors::{Error, Result};

/// A Number is the number of a distance. A text and an integer are exact: the daemon refuses an amount that is not a
/// whole number of pulses. A floating-point number becomes the nearest whole number of pulses, and the result of the
/// motion says which.
#[derive(Clone, Debug, PartialEq)]
pub struct Number(Form);

#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Form {
    Exact(String),
    Float(f64),
}

macro_rules! exact {
    ($($type:ty),*) => {$(
        impl From<$type> for Number {
            fn from(number: $type) -> Number {
                Number(Form::Exact(number.to_string().trim().to_string()))
            }
        }
    )*};
}

macro_rules! floating {
    ($($type:ty),*) => {$(
        impl From<$type> for Number {
            fn from(number: $type) -> Number {
                Number(Form::Float(number.into()))
            }
        }
    )*};
}

exact!(&str, &String, String, i32, i64, u32, u64);
floating!(f32, f64);

impl Number {
    pub(crate) fn is_negative(&self) -> bool {
        match &self.0 {
            Form::Exact(text) => text.starts_with('-'),
            Form::Float(number) => *number < 0.0,
        }
    }

    /// Returns the form, unless it is not a finite decimal number.
    pub(crate) fn checked(&self) -> Result<&Form> {
        match &self.0 {
            Form::Float(number) if !number.is_finite() => {
                Err(Error::invalid(format!("{number} is not an amount: it must be a finite number")))
            }
            Form::Exact(text) if !is_decimal(text) => Err(Error::invalid(format!("{text:?} is not a decimal number"))),
            form => Ok(form),
        }
    }
}

impl Neg for Number {
    type Output = Number;

    fn neg(self) -> Number {
        Number(match self.0 {
            Form::Float(number) => Form::Float(-number),
            Form::Exact(text) => Form::Exact(match text.strip_prefix('-') {
                Some(rest) => rest.to_string(),
                None => format!("-{}", text.trim_start_matches('+')),
            }),
        })
    }
}

impl fmt::Display for Number {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match &self.0 {
            Form::Exact(text) => f.write_str(text),
            Form::Float(number) => number.fmt(f),
        }
    }
}

/// Reports whether the text is a sign, digits, a point and an exponent. Rust's own form also has "inf" and "nan".
fn is_decimal(text: &str) -> bool {
    text.bytes().all(|byte| byte.is_ascii_digit() || b"+-.eE".contains(&byte)) && text.parse::<f64>().is_ok()
}
