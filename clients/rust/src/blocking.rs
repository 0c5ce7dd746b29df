//! Waiting without a runtime: [`Blocking::blocking`] takes the place of `.await`.
//!
//! ```no_run
//! use axisgate::blocking::Blocking;
//! use axisgate::{mm, Error, Stage};
//!
//! fn main() -> Result<(), Error> {
//!     let stage = Stage::connect().blocking()?;
//!     println!("{}", stage.axis("x")?.move_to(mm("1.5")).blocking()?);
//!     Ok(())
//! }
//! ```
//!
//! The calls run on a thread of this crate, which also keeps leases alive and jogs running.

use std::future::IntoFuture;
use std::sync::OnceLock;

use tokio::runtime::{Builder, Runtime};

use crate::errors::Result;
use crate::updates::Updates;

/// Blocking is implemented by everything that can be awaited.
pub trait Blocking: IntoFuture + Sized {
    /// Waits for the result, and blocks the thread.
    ///
    /// # Panics
    ///
    /// Panics inside an asynchronous function, and if the system has no more threads.
    fn blocking(self) -> Self::Output {
        runtime().block_on(async { self.await })
    }
}

impl<F: IntoFuture> Blocking for F {}

/// Returns the items of a series. Each blocks the thread until the item is there.
pub fn items<T>(mut updates: Updates<T>) -> impl Iterator<Item = Result<T>> {
    std::iter::from_fn(move || updates.next().blocking())
}

fn runtime() -> &'static Runtime {
    static RUNTIME: OnceLock<Runtime> = OnceLock::new();
    RUNTIME.get_or_init(|| {
        let mut builder = Builder::new_multi_thread();
        builder.worker_threads(1).thread_name("axisgate").enable_all().build().expect("a thread")
    })
}
