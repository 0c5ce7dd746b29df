use std::fmt;
use std::time::Duration;

use crate::api;
use crate::errors::{Error, Result};
use crate::failure::problem_of;
use crate::units::Unit;

/// A Position is the position of one axis.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Position {
    /// Name of the axis, or its number as text.
    pub axis: String,
    /// Position in `unit`, as an exact decimal: "-0.25". None: unknown.
    pub value: Option<String>,
    /// Unit of the axis.
    pub unit: Unit,
    /// Position in drive pulses. None: unknown.
    pub pulses: Option<i64>,
}

impl Position {
    pub(crate) fn new(name: &str, number: i32, value: &str, unit: i32, pulses: Option<i64>) -> Position {
        let value = Some(value.to_string()).filter(|value| !value.is_empty());
        Position { axis: axis_name(name, number), value, unit: Unit::of(unit), pulses }
    }

    /// Returns the value as a floating-point number. None: unknown.
    pub fn float(&self) -> Option<f64> {
        self.value.as_ref()?.parse().ok()
    }
}

impl fmt::Display for Position {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match &self.value {
            Some(value) => write!(f, "{} {value} {}", self.axis, self.unit),
            None => write!(f, "{} unknown", self.axis),
        }
    }
}

/// A ScanResult has the numbers of trigger pulses of a scan. None: unknown.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct ScanResult {
    /// Number of pulses due in the whole run.
    pub expected: Option<i64>,
    /// Number of pulses due within the range.
    pub expected_in_range: Option<i64>,
    /// Number of pulses computed from the displacement.
    pub observed: Option<i64>,
}

/// A MotionResult is the result of a motion that succeeded.
#[derive(Clone, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct MotionResult {
    /// Name of the motion. Empty: nothing had to move.
    pub motion: String,
    /// Final positions, in the order of the axes' numbers.
    pub positions: Vec<Position>,
    /// Time from the start to the outcome.
    pub duration: Duration,
    /// Result of a scan. None: the motion was no scan.
    pub scan: Option<ScanResult>,
}

impl MotionResult {
    /// Returns the final position of an axis by its name. None: the motion does not have this axis.
    pub fn position(&self, axis: &str) -> Option<&Position> {
        self.positions.iter().find(|position| position.axis == axis)
    }
}

impl fmt::Display for MotionResult {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&joined(&self.positions))
    }
}

pub fn joined<T: fmt::Display>(items: &[T]) -> String {
    items.iter().map(T::to_string).collect::<Vec<_>>().join(", ")
}

/// Returns the configured name of an axis, or its number as text.
pub fn axis_name(name: &str, number: i32) -> String {
    if name.is_empty() {
        return number.to_string();
    }
    name.to_string()
}

/// Returns the result of a motion that is over, or the error of another outcome than success.
pub fn outcome_of(motion: &api::Motion) -> Result<MotionResult> {
    let problem = || {
        let problem = motion.problem.as_ref().map(|problem| problem_of(problem, String::new()));
        Box::new(problem.unwrap_or_default())
    };
    match motion.state() {
        api::MotionState::Succeeded => Ok(result_of(motion)),
        api::MotionState::Stopped => Err(Error::Stopped(problem())),
        api::MotionState::Unknown => Err(Error::OutcomeUnknown(problem())),
        _ => Err(Error::MotionFailed(problem())),
    }
}

fn result_of(motion: &api::Motion) -> MotionResult {
    let began = api::system_time(motion.start_time.or(motion.create_time));
    let ended = api::system_time(motion.end_time);
    let positions = motion.results.iter();
    MotionResult {
        motion: motion.name.clone(),
        positions: positions
            .map(|one| Position::new(&one.name, one.axis, &one.position, one.unit, one.command_pulses))
            .collect(),
        duration: ended.duration_since(began).unwrap_or_default(),
        scan: motion.scan.as_ref().map(|scan| ScanResult {
            expected: scan.expected_triggers,
            expected_in_range: scan.expected_triggers_in_range,
            observed: scan.observed_triggers,
        }),
    }
}
