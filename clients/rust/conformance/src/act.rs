use std::time::Duration;

use axisgate::{mm, um, Connect, Distance, Number, Speed, Stage};
use serde_json::Value;

use crate::AnyError;

/// An Act is one line of the scenario.
pub struct Act(pub Value);

impl Act {
    pub fn text(&self, key: &str) -> &str {
        self.0[key].as_str().unwrap_or_default()
    }

    pub fn count(&self, key: &str) -> usize {
        self.0[key].as_u64().unwrap_or_default() as usize
    }

    pub fn seconds(&self, key: &str) -> Option<Duration> {
        self.0[key].as_f64().map(Duration::from_secs_f64)
    }

    pub fn axes(&self) -> Vec<String> {
        self.0["axes"].as_array().into_iter().flatten().filter_map(|axis| axis.as_str().map(str::to_string)).collect()
    }

    /// Returns an amount, or None for a bare number, which the compiler does not accept as a Distance.
    pub fn distance(&self, key: &str) -> Option<Distance> {
        let amount = &self.0[key];
        let number: Number = match (&amount["text"], &amount["number"]) {
            (Value::String(text), _) => text.into(),
            (_, Value::String(text)) => text.parse::<f64>().ok()?.into(),
            (_, number) => number.as_f64()?.into(),
        };
        with_unit(number, amount["unit"].as_str()?)
    }

    pub fn speed(&self) -> Option<Speed> {
        self.distance("speed").map(Distance::per_second)
    }

    /// Returns numbered points of a line, which fail after a while if the act says so.
    pub fn points(&self) -> impl Iterator<Item = Result<Vec<Distance>, AnyError>> + '_ {
        let last = self.0["fails_after"].as_u64().unwrap_or(u64::MAX);
        (1..=self.count("count") as i64).map(move |number| {
            if number as u64 > last {
                return Err("a point cannot be computed".into());
            }
            let steps = self.0["step"].as_array().into_iter().flatten();
            let size = |step: &Value| step.as_str().and_then(|step| step.parse::<i64>().ok()).unwrap_or_default();
            Ok(steps.filter_map(|step| with_unit((number * size(step)).into(), self.text("unit"))).collect())
        })
    }

    /// Returns the connection of an act that opens a Stage.
    pub fn connection(&self) -> Connect<Stage> {
        let mut connect = Stage::connect();
        let has = |key: &str| self.0[key].is_string();
        if has("target") {
            connect = connect.target(self.text("target"));
        }
        if has("token") {
            connect = connect.token(self.text("token"));
        }
        if has("ca") {
            connect = connect.ca(self.text("ca"));
        }
        if has("certificate") {
            connect = connect.certificate(self.text("certificate"), self.text("key"));
        }
        connect
    }
}

fn with_unit(number: Number, unit: &str) -> Option<Distance> {
    match unit {
        "mm" => Some(mm(number)),
        "um" => Some(um(number)),
        _ => None,
    }
}
