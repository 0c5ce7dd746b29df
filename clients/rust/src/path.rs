use std::error::Error as StdError;
use std::sync::Arc;
use std::time::Duration;

use futures_util::stream;

use crate::api;
use crate::api::run_path_request::Part;
use crate::api::segment::Shape;
use crate::channel::Answers;
use crate::errors::{Error, Result};
use crate::failure::Failure;
use crate::plan::{Plan, Startable};
use crate::session::Session;
use crate::units::{Distance, Speed};

/// Time for sending one segment, which is added to the limit of the request.
const SEGMENT_TIME: Duration = Duration::from_micros(500);

/// A Point has one position for each axis, in the order of the axes: an array or a `Vec` of distances, or a `Result` with
/// such a point and an error of any type.
pub trait Point {
    /// Returns the positions, or why they could not be computed.
    fn distances(self) -> Result<Vec<Distance>>;
}

impl Point for Vec<Distance> {
    fn distances(self) -> Result<Vec<Distance>> {
        Ok(self)
    }
}

impl<const AXES: usize> Point for [Distance; AXES] {
    fn distances(self) -> Result<Vec<Distance>> {
        Ok(self.into())
    }
}

impl<P: Point, E: Into<Box<dyn StdError + Send + Sync>>> Point for Result<P, E> {
    fn distances(self) -> Result<Vec<Distance>> {
        self.map_err(|error| Error::Points(error.into()))?.distances()
    }
}

/// A Path is a series of points through which axes move without a halt.
#[derive(Debug)]
pub struct Path(Vec<api::Segment>);

impl Path {
    pub(crate) fn new<P: Point>(axes: &[String], points: impl IntoIterator<Item = P>) -> Result<Path> {
        let segment = |point: P| {
            let targets = targets(axes, point)?.into_iter();
            segment(targets.map(|(axis, distance)| Ok((axis, distance.message()?))).collect::<Result<_>>()?)
        };
        points.into_iter().map(segment).collect::<Result<_>>().map(Path)
    }
}

/// Returns the distances of a point with their axes.
pub fn targets<P: Point>(axes: &[String], point: P) -> Result<Vec<(String, Distance)>> {
    let distances = point.distances()?;
    if axes.is_empty() || distances.len() != axes.len() {
        return Err(Error::invalid(format!("a point has {} distances for {} axes", distances.len(), axes.len())));
    }
    Ok(axes.iter().cloned().zip(distances).collect())
}

/// Returns the piece of the path that leads to a point.
fn segment(point: Vec<(String, api::Distance)>) -> Result<api::Segment> {
    let distance = |(axis, distance)| api::AxisDistance { axis, distance: Some(distance) };
    let mut distances: Vec<_> = point.into_iter().map(distance).collect();
    let shape = match distances.len() {
        1 => Shape::Single(distances.remove(0)),
        _ => Shape::Line(api::Line { distances }),
    };
    Ok(api::Segment { shape: Some(shape), ..api::Segment::default() })
}

impl Plan<Path> {
    /// Sets the speed along the path. Without it: the present speed profiles of the axes.
    pub fn speed(self, speed: Speed) -> Self {
        self.with(|path| {
            let speed = speed.message()?;
            for segment in &mut path.0 {
                segment.speed = Some(speed.clone());
            }
            Ok(())
        })
    }
}

impl Startable for Path {
    async fn begin(self, session: &Session) -> Result<api::Motion> {
        let patience = SEGMENT_TIME * u32::try_from(self.0.len()).unwrap_or(u32::MAX);
        let segments: Arc<[api::Segment]> = self.0.into();
        let attempt = |context, limit| {
            let (context, device) = (Some(context), session.device.to_string());
            let header = api::PathHeader { context, device, ..api::PathHeader::default() };
            let segments = segments.clone();
            let parts = std::iter::once(Part::Header(header))
                .chain((0..segments.len()).map(move |at| Part::Segment(segments[at].clone())));
            let requests = stream::iter(parts.map(|part| api::RunPathRequest { part: Some(part) }));
            session.connection.calls.exchange(requests, limit, started)
        };
        session.connection.start(&session.token, patience, attempt).await
    }
}

/// Returns the motion once the path has started. The path continues without the call.
async fn started(mut answers: Answers<api::RunPathResponse>) -> Result<Option<api::Motion>, Failure> {
    use api::run_path_response::Change;
    while let Some(answer) = answers.next().await? {
        if let Some(Change::Motion(motion)) = answer.change {
            return Ok(Some(motion));
        }
    }
    Err(Failure::of_ended_stream())
}
