use std::collections::BTreeMap;
use std::time::Duration;

use crate::api;
use crate::errors::Result;
use crate::plan::{Plan, Startable};
use crate::results::Position;
use crate::session::Session;

/// Time for which saving may wait for the end of a running motion.
const SAVE_TIME: Duration = Duration::from_secs(20);

/// Places are the saved positions of a stage, by name.
#[derive(Clone, Debug)]
pub struct Places {
    session: Session,
}

/// A MoveToPlace is a move of all axes to a saved position.
#[derive(Debug)]
pub struct MoveToPlace(api::MoveToPositionRequest);

impl Startable for MoveToPlace {
    async fn begin(self, session: &Session) -> Result<api::Motion> {
        session.start(self.0).await
    }
}

impl Places {
    pub(crate) fn new(session: Session) -> Places {
        Places { session }
    }

    /// Saves the present position. It stays the same place when coordinates are set again.
    pub async fn save(&self, name: &str) -> Result<()> {
        self.save_as(name, api::PositionKind::Place).await
    }

    /// Saves the coordinates of the present position. They stay the same when coordinates are set again.
    pub async fn save_coordinates(&self, name: &str) -> Result<()> {
        self.save_as(name, api::PositionKind::Coordinates).await
    }

    async fn save_as(&self, name: &str, kind: api::PositionKind) -> Result<()> {
        let (position, kind) = (self.resource(name), kind as i32);
        let request = api::SavePositionRequest { position, kind, ..Default::default() };
        self.session.change_for(request, SAVE_TIME).await.map(drop)
    }

    /// Moves all axes to a saved position.
    pub fn move_to(&self, name: &str) -> Plan<MoveToPlace> {
        let request = api::MoveToPositionRequest { position: self.resource(name), ..Default::default() };
        Plan::new(&self.session, Ok(MoveToPlace(request)))
    }

    /// Deletes a saved position.
    pub async fn delete(&self, name: &str) -> Result<()> {
        let request = api::DeletePositionRequest { position: self.resource(name), ..Default::default() };
        self.session.change(request).await.map(drop)
    }

    /// Returns the saved positions by name, with the positions of the axes when they were saved.
    pub async fn list(&self) -> Result<BTreeMap<String, Vec<Position>>> {
        let device = self.session.device.to_string();
        let listed = self.session.ask(api::ListPositionsRequest { device, ..Default::default() }).await?;
        let places = listed.positions.iter().map(|place| {
            let name = place.name.rsplit('/').next().unwrap_or_default().to_string();
            let axes = place.coordinates.iter();
            let position = |one: &api::PositionCoordinate| {
                Position::new(&one.name, one.axis, &one.position, one.unit, Some(one.pulses))
            };
            (name, axes.map(position).collect())
        });
        Ok(places.collect())
    }

    fn resource(&self, name: &str) -> String {
        format!("{}/positions/{name}", self.session.device)
    }
}
