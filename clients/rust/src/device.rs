//! The functions that stages and mills have in common.

use crate::api;
use crate::connect::short_name;
use crate::cursor::Cursor;
use crate::errors::Result;
use crate::events::{watch_events, EventOrGap};
use crate::session::Session;
use crate::updates::Updates;

/// A Caller is this program as the daemon identifies it.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Caller {
    /// Name: "unix anna".
    pub name: String,
    /// Role: "observer", "operator" or "admin".
    pub role: String,
}

impl Session {
    pub fn short_name(&self) -> &str {
        short_name(&self.device)
    }

    pub async fn whoami(&self) -> Result<Caller> {
        let answer = self.ask(api::GetCallerRequest {}).await?;
        let role = api::enum_name(answer.role, "ROLE_", api::Role::as_str_name).to_lowercase();
        Ok(Caller { name: answer.caller.unwrap_or_default().name, role })
    }

    pub async fn rearm(&self) -> Result<Vec<i32>> {
        let device = self.device.to_string();
        Ok(self.change(api::RearmRequest { device, ..Default::default() }).await?.axes)
    }

    /// Watches events from now on. They have a place from the beginning, to resume there if the connection breaks at
    /// once.
    pub async fn new_events(&self) -> Result<Updates<EventOrGap>> {
        let listed = self.ask(api::ListDevicesRequest {}).await?;
        self.events(listed.next_revision, &listed.run).await
    }

    pub async fn events(&self, first: u64, run: &str) -> Result<Updates<EventOrGap>> {
        let cursor = Cursor { device: self.device.to_string(), first, run: run.to_string() };
        watch_events(self.connection.clone(), cursor).await
    }
}

macro_rules! device_functions {
    ($device:ident) => {
        impl $device {
            /// Returns the caller's name and role, as the daemon identifies this program.
            pub async fn whoami(&self) -> crate::Result<crate::Caller> {
                self.session.whoami().await
            }

            /// Returns the name of the device.
            pub fn name(&self) -> &str {
                self.session.short_name()
            }

            /// Closes the connection, and waits for cancellations and releases that run in the background. Clones can
            /// still be used. Leases that were not released expire.
            pub async fn close(self) {
                self.session.connection.settled().await;
            }

            /// Allows motion after a stop by another caller. Returns the numbers of the axes that may move again.
            pub async fn rearm(&self) -> crate::Result<Vec<i32>> {
                self.session.rearm().await
            }

            /// Returns every event from now on, each once and in order, also over broken connections and restarts of the
            /// daemon. A `Gap` in the series means that events were missed. Returns once watching has begun.
            pub async fn events(&self) -> crate::Result<crate::Updates<crate::EventOrGap>> {
                self.session.new_events().await
            }

            /// Does the same as `events()` from a revision on. Revision 0: all kept events.
            pub async fn events_from(&self, revision: u64) -> crate::Result<crate::Updates<crate::EventOrGap>> {
                self.session.events(revision, "").await
            }

            /// Does the same as `events()` from the successor of an event on.
            pub async fn events_after(&self, last: &crate::Event) -> crate::Result<crate::Updates<crate::EventOrGap>> {
                self.session.events(last.revision + 1, &last.run).await
            }

            /// Acquires the exclusive right to axes once it is awaited. [`ALL`](crate::ALL): the whole device.
            pub fn lease<A: ToString>(&self, axes: impl IntoIterator<Item = A>) -> crate::LeaseTerms<$device> {
                crate::LeaseTerms::new(self.clone(), axes)
            }
        }

        impl crate::lease::Leasable for $device {
            fn session(&self) -> &crate::session::Session {
                &self.session
            }

            fn under(mut self, token: std::sync::Arc<[u8]>) -> Self {
                self.session.token = token;
                self
            }
        }

        impl std::fmt::Debug for $device {
            fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                write!(f, "{}({})", stringify!($device), self.name())
            }
        }
    };
}

pub(crate) use device_functions;
