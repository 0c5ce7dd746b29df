use std::sync::Arc;
use std::time::SystemTime;

use crate::api;
use crate::api::event::Fact as Message;
use crate::connect::short_name;
use crate::connection::Connection;
use crate::cursor::Cursor;
use crate::errors::{Problem, Result};
use crate::failure::{problem_of, Failure};
use crate::motion::MotionState;
use crate::updates::{begin, Feed, Updates};

/// An EventOrGap is an item of the series of events.
#[derive(Clone, Debug, PartialEq)]
pub enum EventOrGap {
    /// An event.
    Event(Event),
    /// Events were missed, because they are no longer kept.
    Gap {
        /// Revision of the event with which the series continues.
        resume_revision: u64,
    },
}

/// An Event is one fact about a device or the daemon.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Event {
    /// Number of the event, ascending over all devices and over restarts.
    pub revision: u64,
    /// Time of the event by the daemon's clock.
    pub time: SystemTime,
    /// Name of the device. Empty: an event of the daemon itself.
    pub device: String,
    /// What happened.
    pub fact: Fact,
    pub(crate) run: String,
}

/// A Fact is what an event says.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum Fact {
    /// A motion has a new state.
    Motion {
        /// Name of the motion.
        motion: String,
        /// New state.
        state: MotionState,
        /// Reason of another outcome than success.
        problem: Option<Box<Problem>>,
    },
    /// The link to the controller has a new state.
    Link {
        /// New state: "UP".
        state: String,
        /// Reason of the change.
        why: String,
    },
    /// A caller requested a stop.
    StopRequested {
        /// Numbers of the axes. Empty: the whole device.
        axes: Vec<i32>,
        /// True for an emergency stop.
        emergency: bool,
        /// Name of the caller.
        caller: String,
    },
    /// A condition at the stage begins or ends.
    Condition {
        /// Name of the condition: "CW_LIMIT".
        condition: String,
        /// Numbers of the axes.
        axes: Vec<i32>,
        /// True if the condition begins.
        begun: bool,
    },
    /// The daemon was started.
    DaemonStarted,
    /// Another fact, by its name in the API's `Event`: "path_progress". Empty: a fact of a newer daemon.
    Other(&'static str),
}

impl Event {
    fn of(event: api::Event) -> Event {
        Event {
            revision: event.revision,
            time: api::system_time(event.time),
            device: short_name(&event.device).to_string(),
            fact: Fact::of(event.fact),
            run: event.run,
        }
    }
}

impl Fact {
    fn of(fact: Option<Message>) -> Fact {
        match fact {
            Some(Message::Motion(motion)) => Fact::Motion {
                state: MotionState::of(motion.state),
                problem: motion.problem.map(|problem| Box::new(problem_of(&problem, String::new()))),
                motion: motion.name,
            },
            Some(Message::Link(link)) => Fact::Link {
                state: api::enum_name(link.state, "LINK_STATE_", api::LinkState::as_str_name),
                why: link.why,
            },
            Some(Message::StopRequested(stop)) => Fact::StopRequested {
                axes: stop.axes,
                emergency: stop.emergency,
                caller: stop.caller.unwrap_or_default().name,
            },
            Some(Message::Condition(change)) => Fact::Condition {
                condition: api::enum_name(change.condition, "CONDITION_", api::Condition::as_str_name),
                axes: change.axes,
                begun: change.begun,
            },
            Some(Message::DaemonStarted(_)) => Fact::DaemonStarted,
            Some(Message::Completion(_)) => Fact::Other("completion"),
            Some(Message::PathProgress(_)) => Fact::Other("path_progress"),
            Some(Message::ForeignMotion(_)) => Fact::Other("foreign_motion"),
            Some(Message::SwitchesChanged(_)) => Fact::Other("switches_changed"),
            Some(Message::ProgramNotice(_)) => Fact::Other("program_notice"),
            Some(Message::Job(_)) => Fact::Other("job"),
            Some(Message::Stop(_)) => Fact::Other("stop"),
            Some(Message::EmergencyLatch(_)) => Fact::Other("emergency_latch"),
            None => Fact::Other(""),
        }
    }
}

/// Begins to watch events.
pub async fn watch_events(connection: Arc<Connection>, cursor: Cursor) -> Result<Updates<EventOrGap>> {
    begin(connection, cursor).await
}

impl Feed for Cursor {
    type Request = api::WatchRequest;
    type Item = EventOrGap;

    fn request(&self) -> api::WatchRequest {
        Cursor::request(self)
    }

    fn item(&mut self, answer: api::WatchResponse) -> Option<EventOrGap> {
        let event = answer.event?;
        self.take(event.revision, event.run.clone());
        Some(EventOrGap::Event(Event::of(event)))
    }

    fn skip(&mut self, failure: &Failure) -> Option<EventOrGap> {
        self.gap_after(failure).map(|resume| EventOrGap::Gap { resume_revision: resume })
    }
}
