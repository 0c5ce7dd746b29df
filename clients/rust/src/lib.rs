//! The client of Axisgate, the gateway for stage controllers and mills.
//!
//! ```no_run
//! use axisgate::{mm, Error, Stage};
//!
//! # #[tokio::main(flavor = "current_thread")]
//! # async fn main() -> Result<(), Error> {
//! let stage = Stage::connect().await?;
//! match stage.axis("x")?.move_to(mm("1.5")).await {
//!     Err(Error::Refused(p)) => println!("{} {}", p.reason, p.hint),
//!     other => println!("{}", other?),
//! }
//! # Ok(())
//! # }
//! ```
//!
//! [`Error::Refused`] means that nothing moved. The other errors of the daemon are [`Error::Stopped`],
//! [`Error::MotionFailed`] and [`Error::OutcomeUnknown`]. A wrong argument is found before anything is sent.
//!
//! A lost answer makes no difference: the request is sent again with the same id, and the daemon acts once.
//!
//! A motion is a [`Plan`] until it is awaited or started. If the future of an awaited Plan is dropped, the motion is
//! cancelled. Dropping any other future stops nothing that has started, and [`Motion`]s that were started continue.
//!
//! All functions need a [tokio](https://docs.rs/tokio) runtime with its time and I/O drivers. All types can be sent to
//! and used by several threads at once.
//!
//! A program without a runtime uses the feature `blocking`.
//!
//! Each call is an event of [tracing](https://docs.rs/tracing) at the level DEBUG; lost leases are at the level WARN.

mod api;
#[cfg(test)]
mod argument_tests;
mod axis;
#[cfg(feature = "blocking")]
pub mod blocking;
mod channel;
mod commands;
mod connect;
mod connection;
mod cursor;
mod device;
mod errors;
mod events;
mod failure;
mod following;
mod hints;
mod job;
mod jog;
mod lease;
mod mill;
mod motion;
mod moves;
mod number;
mod path;
mod places;
mod plan;
#[cfg(test)]
mod policy_tests;
mod progress;
mod repeat;
mod results;
mod scan;
mod session;
mod settings;
mod stage;
mod state;
mod stop;
mod target;
mod units;
mod updates;

pub use axis::Axis;
pub use commands::Executed;
pub use connect::Connect;
pub use device::Caller;
pub use errors::{Error, Problem, Reason, Result};
pub use events::{Event, EventOrGap, Fact};
pub use job::{Job, NewJob};
pub use jog::Jog;
pub use lease::{Lease, LeaseTerms};
pub use mill::{Mill, MillState};
pub use motion::{Motion, MotionState};
pub use moves::{Home, Move};
pub use number::Number;
pub use path::{Path, Point};
pub use places::{MoveToPlace, Places};
pub use plan::Plan;
pub use progress::Progress;
pub use results::{MotionResult, Position, ScanResult};
pub use scan::Scan;
pub use settings::AxisSettings;
pub use stage::{Stage, ALL};
pub use state::{AxisState, Status};
pub use stop::{AxisStop, StopReport};
pub use units::{deg, mm, nm, pulses, um, Distance, Speed, Unit};
pub use updates::Updates;

/// Compiles the programs of the README.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
