use crate::api;
use crate::errors::{Error, Result};
use crate::plan::{Plan, Startable};
use crate::session::Session;
use crate::units::{Distance, Speed};

/// A Move is a move of some axes, all at once.
#[derive(Debug)]
pub struct Move(pub(crate) api::MoveRequest);

/// A Home is the homing of some axes.
#[derive(Debug)]
pub struct Home(pub(crate) api::HomeRequest);

impl Startable for Move {
    async fn begin(self, session: &Session) -> Result<api::Motion> {
        session.start(self.0).await
    }
}

impl Startable for Home {
    async fn begin(self, session: &Session) -> Result<api::Motion> {
        session.start(self.0).await
    }
}

impl Move {
    pub(crate) fn new<A: ToString>(
        device: &str,
        targets: impl IntoIterator<Item = (A, Distance)>,
        relative: bool,
    ) -> Result<Move> {
        let target = |(axis, distance): (A, Distance)| {
            let (axis, distance) = (axis.to_string(), Some(distance.message()?));
            Ok(api::AxisTarget { axis, distance, ..api::AxisTarget::default() })
        };
        let targets = targets.into_iter().map(target).collect::<Result<Vec<_>>>()?;
        if targets.is_empty() {
            return Err(Error::invalid("a move needs at least one axis"));
        }
        Ok(Move(api::MoveRequest { device: device.to_string(), targets, relative, ..api::MoveRequest::default() }))
    }
}

impl Plan<Move> {
    /// Sets the highest speed of all axes. Without it: the present speed profile of each axis.
    pub fn speed(self, speed: Speed) -> Self {
        self.with(|request| {
            let maximum = speed.message()?;
            for target in &mut request.0.targets {
                target.profile = Some(api::Profile { maximum: Some(maximum.clone()), ..api::Profile::default() });
            }
            Ok(())
        })
    }

    /// Sets the displacement of the last part of the move, whose direction is then always the same, so that backlash
    /// does not matter. Without it, the axes move directly.
    pub fn approach(self, displacement: Distance) -> Self {
        self.with(|request| {
            let approach = displacement.message()?;
            for target in &mut request.0.targets {
                target.approach = Some(approach.clone());
            }
            Ok(())
        })
    }

    /// Checks the move as far as possible without moving. Fails as the move would.
    pub async fn check(self) -> Result<()> {
        let (session, request) = self.into_parts();
        let request = api::MoveRequest { validate_only: true, ..request?.0 };
        session.change(request).await.map(drop)
    }
}
