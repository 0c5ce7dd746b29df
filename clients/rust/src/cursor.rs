//! The place in the series of events from which a broken stream continues.

use crate::api;
use crate::failure::Failure;

/// A Cursor knows the first event that a watcher has not received yet.
#[derive(Clone)]
pub struct Cursor {
    pub device: String,
    /// Revision of that event. 0: all kept events.
    pub first: u64,
    /// Run of the daemon to which the revision belongs. Empty: not checked.
    pub run: String,
}

impl Cursor {
    pub fn request(&self) -> api::WatchRequest {
        api::WatchRequest { device: self.device.clone(), from_revision: Some(self.first), run: self.run.clone() }
    }

    /// Moves past an event.
    pub fn take(&mut self, revision: u64, run: String) {
        (self.first, self.run) = (revision + 1, run);
    }

    /// Returns the revision with which events continue after a gap, and moves there. None: the failure is another one.
    pub fn gap_after(&mut self, failure: &Failure) -> Option<u64> {
        if !failure.is("COMPACTED") {
            return None;
        }
        let resume = failure.problem.as_ref()?.metadata.get("resume_revision")?.parse().ok()?;
        (self.first, self.run) = (resume, String::new());
        Some(resume)
    }
}
