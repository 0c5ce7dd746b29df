use crate::api;
use crate::api::scan_request::Interval;
use crate::errors::Result;
use crate::plan::{Plan, Startable};
use crate::session::Session;
use crate::units::{Distance, Speed};

/// A Scan is a run of one axis at constant speed, with trigger pulses at equal intervals.
#[derive(Debug)]
pub struct Scan(api::ScanRequest);

impl Scan {
    pub(crate) fn new(device: &str, axis: String, start: Distance, end: Distance, every: Distance) -> Result<Scan> {
        Ok(Scan(api::ScanRequest {
            device: device.to_string(),
            axis,
            start: Some(start.message()?),
            end: Some(end.message()?),
            interval: Some(Interval::Distance(every.message()?)),
            ..api::ScanRequest::default()
        }))
    }
}

impl Startable for Scan {
    async fn begin(self, session: &Session) -> Result<api::Motion> {
        session.start(self.0).await
    }
}

impl Plan<Scan> {
    /// Sets the constant speed in the range. Without it: the present speed of the axis.
    pub fn speed(self, speed: Speed) -> Self {
        self.with(|request| {
            request.0.speed = Some(speed.message()?);
            Ok(())
        })
    }
}
