use std::sync::Arc;

use futures_util::{stream, Stream};

use crate::api;
use crate::axis::{Axis, AxisNames};
use crate::connect::{Connect, Connectable};
use crate::device::device_functions;
use crate::errors::{Error, Result};
use crate::motion::Motion;
use crate::moves::{Home, Move};
use crate::path::{targets, Path, Point};
use crate::places::Places;
use crate::plan::Plan;
use crate::results::MotionResult;
use crate::scan::Scan;
use crate::session::Session;
use crate::units::Distance;
use crate::updates::Updates;

/// All axes of a stage: `stage.home(ALL)`.
pub const ALL: [&str; 0] = [];

/// A Stage is the connection to one device that moves axes. Axes are named as in the configuration, or by their numbers:
/// "x", 1. Its clones share the connection, which is closed with the last of them; motions continue.
///
/// Every function fails with `Refused` if the daemon refuses the request: nothing moved. Functions with a [`Plan`] move
/// once it is awaited.
#[derive(Clone)]
pub struct Stage {
    pub(crate) session: Session,
    axes: Arc<[AxisNames]>,
}

device_functions!(Stage);

impl Connectable for Stage {
    const CAPABILITY: api::Capability = api::Capability::Move;
    const KIND: &'static str = "stage";

    fn of(session: Session, device: &api::Device) -> Stage {
        let axes = device.axes.iter().filter(|axis| axis.controllable).map(AxisNames::of).collect();
        Stage { session, axes }
    }
}

impl Stage {
    /// Connects to the daemon: the local one and its only stage, or those of the options and the environment.
    ///
    /// Fails with `Refused` if no daemon answers ([`Error::is_unavailable`]), and with `InvalidArgument` if it has no
    /// such stage.
    pub fn connect() -> Connect<Stage> {
        Connect::new()
    }

    /// Returns the axes that can be moved, in the order of their numbers.
    pub fn axes(&self) -> Vec<Axis> {
        self.axes.iter().map(|names| Axis::new(self.clone(), names.clone())).collect()
    }

    /// Returns an axis by its name or number. Fails with `InvalidArgument` if there is no such axis.
    pub fn axis(&self, axis: impl ToString) -> Result<Axis> {
        let name = axis.to_string();
        let found = self.axes.iter().find(|names| names.is(&name));
        found.map(|names| Axis::new(self.clone(), names.clone())).ok_or_else(|| {
            let known: Vec<&str> = self.axes.iter().map(|names| names.name.as_str()).collect();
            Error::invalid(format!("{} has no axis {name}; its axes are {}", self.name(), known.join(", ")))
        })
    }

    /// Moves axes to positions, all at once: `stage.move_to([("x", mm("1.5")), ("y", um(200))]).await`.
    pub fn move_to<A: ToString>(&self, targets: impl IntoIterator<Item = (A, Distance)>) -> Plan<Move> {
        Plan::new(&self.session, Move::new(&self.session.device, targets, false))
    }

    /// Moves axes by displacements from their present positions, all at once.
    pub fn move_by<A: ToString>(&self, displacements: impl IntoIterator<Item = (A, Distance)>) -> Plan<Move> {
        Plan::new(&self.session, Move::new(&self.session.device, displacements, true))
    }

    /// Homes axes. [`ALL`]: all axes.
    pub fn home<A: ToString>(&self, axes: impl IntoIterator<Item = A>) -> Plan<Home> {
        let (device, axes) = (self.session.device.to_string(), names(axes));
        let request = api::HomeRequest { device, axes, ..api::HomeRequest::default() };
        Plan::new(&self.session, Ok(Home(request)))
    }

    /// Homes those of the axes that the daemon has not homed yet, and waits. The result has no positions if there are
    /// none. Dropping the future cancels the motion.
    pub async fn home_if_needed<A: ToString>(&self, axes: impl IntoIterator<Item = A>) -> Result<MotionResult> {
        let chosen = names(axes);
        for axis in &chosen {
            self.axis(axis)?;
        }
        let status = self.status().await?;
        let is_chosen = |own: &AxisNames| chosen.is_empty() || chosen.iter().any(|axis| own.is(axis));
        let is_homed = |own: &AxisNames| status.axis(&own.name).is_some_and(|state| state.homed);
        let needed = self.axes.iter().filter(|own| is_chosen(own) && !is_homed(own)).map(|own| own.name.clone());
        let needed: Vec<String> = needed.collect();
        if needed.is_empty() {
            return Ok(MotionResult::default());
        }
        self.home(needed).await
    }

    /// Moves axes through points without a halt. All points are read here, so nothing moves if one is an error.
    ///
    /// ```no_run
    /// # async fn run(stage: axisgate::Stage) -> axisgate::Result<()> {
    /// use axisgate::{mm, um};
    ///
    /// let points = (1..=100).map(|i| [um(10 * i), um(-5 * i)]);
    /// let motion = stage.path(["x", "y"], points).speed(mm(2).per_second()).start().await?;
    /// println!("{}", motion.await?);
    /// # Ok(())
    /// # }
    /// ```
    pub fn path<A: ToString, P: Point>(
        &self,
        axes: impl IntoIterator<Item = A>,
        points: impl IntoIterator<Item = P>,
    ) -> Plan<Path> {
        Plan::new(&self.session, Path::new(&names(axes), points))
    }

    /// Moves to one point after another, and yields the result once the axes are stationary at each point. Dropping the
    /// series cancels the present move. Use it under a lease, so that nobody else moves the axes in between.
    pub fn visit<A, P, I>(&self, axes: impl IntoIterator<Item = A>, points: I) -> Updates<MotionResult>
    where
        A: ToString,
        P: Point,
        I: IntoIterator<Item = P>,
        I::IntoIter: Send + 'static,
    {
        Updates::new(self.visits(names(axes), points.into_iter()))
    }

    fn visits<P: Point>(
        &self,
        axes: Vec<String>,
        points: impl Iterator<Item = P> + Send + 'static,
    ) -> impl Stream<Item = Result<MotionResult>> + Send + 'static {
        let stage = self.clone();
        stream::unfold(Some((stage, axes, points)), |visiting| async move {
            let (stage, axes, mut points) = visiting?;
            let targets = targets(&axes, points.next()?);
            let visited = match targets {
                Ok(targets) => stage.move_to(targets).await,
                Err(error) => Err(error),
            };
            let rest = visited.is_ok().then_some((stage, axes, points));
            Some((visited, rest))
        })
    }

    /// Runs an axis at constant speed from `start` to `end`. The trigger output gives a pulse every `every`; one pulse
    /// falls on `start`. [`MotionResult::scan`] has the expected and the observed number of pulses.
    pub fn scan(&self, axis: impl ToString, start: Distance, end: Distance, every: Distance) -> Plan<Scan> {
        Plan::new(&self.session, Scan::new(&self.session.device, axis.to_string(), start, end, every))
    }

    /// Returns the newest 100 motions, newest first, also those of other callers.
    pub async fn motions(&self) -> Result<Vec<Motion>> {
        let device = self.session.device.to_string();
        let listed = self.session.ask(api::ListMotionsRequest { device, ..Default::default() }).await?;
        Ok(listed.motions.into_iter().map(|motion| Motion::new(self.session.clone(), motion)).collect())
    }

    /// Returns the saved positions of the stage.
    pub fn places(&self) -> Places {
        Places::new(self.session.clone())
    }
}

/// Returns the names of axes as texts.
pub fn names<A: ToString>(axes: impl IntoIterator<Item = A>) -> Vec<String> {
    axes.into_iter().map(|axis| axis.to_string()).collect()
}
