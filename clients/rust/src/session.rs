//! The requests for one device.

use std::fmt;
use std::future::Future;
use std::pin::Pin;
use std::sync::Arc;
use std::time::Duration;

use tokio::sync::oneshot;

use crate::api;
use crate::api::{Call, CallContext, Changing, Starting};
use crate::connection::{joined, received, Connection};
use crate::errors::{Error, Result};
use crate::motion::Motion;
use crate::results::MotionResult;

const TOKEN_BYTES: usize = 24;

/// Future of a call.
pub type Boxed<T> = Pin<Box<dyn Future<Output = Result<T>> + Send>>;

/// A Session sends the requests for one device: its connection, its name, and the token of the lease that the calls
/// carry. An empty token: no lease.
#[derive(Clone)]
pub struct Session {
    pub connection: Arc<Connection>,
    pub device: Arc<str>,
    pub token: Arc<[u8]>,
}

impl fmt::Debug for Session {
    /// Leaves out the token, which is a secret.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "Session({})", self.device)
    }
}

impl Session {
    pub async fn ask<Q: Call>(&self, request: Q) -> Result<Q::Answer> {
        self.connection.ask(&request).await
    }

    pub async fn change<Q: Changing>(&self, request: Q) -> Result<Q::Answer> {
        self.change_for(request, Duration::ZERO).await
    }

    /// Does the same as change() for a request that may wait for `patience`.
    pub async fn change_for<Q: Changing>(&self, request: Q, patience: Duration) -> Result<Q::Answer> {
        self.connection.change(request, &self.token, patience).await
    }

    /// Does the same as change() even if the caller is dropped.
    pub async fn surely<Q: Changing>(&self, request: Q) -> Result<Q::Answer> {
        let session = self.clone();
        joined(self.connection.spawn(async move { session.change(request).await })).await
    }

    /// Sends a stop even if the caller is dropped.
    pub async fn stop<Q: Call>(&self, request: Q) -> Result<Q::Answer> {
        let connection = self.connection.clone();
        joined(self.connection.spawn(async move { connection.stop(&request).await })).await
    }

    /// Starts a motion.
    pub async fn start<Q: Changing>(&self, request: Q) -> Result<api::Motion>
    where
        Q::Answer: Starting,
    {
        let attempt = |context, limit| {
            let mut request = request.clone();
            request.set_context(context);
            async move { self.connection.calls.once(&request, limit).await.map(Starting::motion) }
        };
        self.connection.start(&self.token, Duration::ZERO, attempt).await
    }

    /// Starts a motion, and waits for its outcome. If the returned future is dropped, the motion is cancelled, also if
    /// its start is not answered yet.
    pub async fn finish(&self, begin: Boxed<Motion>) -> Result<MotionResult> {
        let (mut answer, outcome) = oneshot::channel();
        self.connection.spawn(async move {
            let ended = match begin.await {
                Ok(motion) => tokio::select! {
                    outcome = motion.wait() => outcome,
                    () = answer.closed() => return cancel(&motion).await,
                },
                Err(error) => Err(error),
            };
            if let Err(Err(error)) = answer.send(ended) {
                tracing::warn!(%error, "the motion of a dropped call has failed");
            }
        });
        let ended = |_| Err(Error::look_first("the runtime ended before the motion".to_string(), ""));
        outcome.await.unwrap_or_else(ended)
    }

    /// Returns the state of the device, which is read again if it is older than `max_age`. None: any age.
    pub async fn read(&self, max_age: Option<Duration>) -> Result<api::Device> {
        let max_age = max_age.map(api::duration);
        received(self.ask(api::GetDeviceRequest { device: self.device.to_string(), max_age }).await?.device)
    }

    /// Returns the context of a request that is not remembered.
    pub fn lease_context(&self) -> Option<CallContext> {
        Some(CallContext { lease_token: self.token.to_vec(), ..CallContext::default() })
    }
}

async fn cancel(motion: &Motion) {
    if let Err(error) = motion.cancel().await {
        tracing::warn!(%error, motion = motion.name(), "the motion was not cancelled");
    }
}

/// Returns the token of `axisctl lease run`. An empty text: no lease.
pub fn inherited_token(text: &str) -> Result<Arc<[u8]>> {
    let digits = text.as_bytes().chunks(2).map(|pair| {
        let pair = std::str::from_utf8(pair).ok().filter(|pair| pair.bytes().all(|b| b.is_ascii_hexdigit()))?;
        u8::from_str_radix(pair, 16).ok()
    });
    match digits.collect::<Option<Vec<u8>>>() {
        Some(token) if text.is_empty() || text.len() == 2 * TOKEN_BYTES => Ok(token.into()),
        _ => Err(Error::invalid("AXISGATE_LEASE is not the token of a lease: unset it, or use `axisctl lease run`")),
    }
}
