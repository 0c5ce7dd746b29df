//! One connection to the daemon. It repeats nothing.

use std::future::Future;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::Arc;
use std::time::{Duration, Instant};

use futures_util::{stream, Stream, StreamExt};
use http::uri::PathAndQuery;
use tonic::client::Grpc;
use tonic::metadata::MetadataMap;
use tonic::{Request, Status, Streaming};
use tonic_prost::ProstCodec;

use crate::api::Call;
use crate::errors::{Error, Result};
use crate::failure::Failure;
use crate::target::Target;

/// A Channel is one connection to the daemon, which is made when it is needed. It can be cloned; the clones share the
/// connection.
#[derive(Clone)]
pub struct Channel {
    transport: tonic::transport::Channel,
    metadata: MetadataMap,
}

/// Answers are the answers of one call. Dropping them ends the call.
#[derive(Debug)]
pub struct Answers<A>(Streaming<A>);

impl<A> Answers<A> {
    /// Returns the next answer, or None at the end.
    pub async fn next(&mut self) -> Result<Option<A>, Failure> {
        self.0.message().await.map_err(|status| Failure::new(&status, true))
    }
}

impl Channel {
    pub fn new(target: &Target, session: &str) -> Result<Channel> {
        let mut metadata = MetadataMap::new();
        let wrong = |_| Error::invalid("the token has characters that a token cannot have");
        metadata.insert("axisgate-session", session.parse().map_err(wrong)?);
        if !target.token.is_empty() {
            let mut token: tonic::metadata::AsciiMetadataValue =
                format!("Bearer {}", target.token).parse().map_err(wrong)?;
            token.set_sensitive(true);
            metadata.insert("authorization", token);
        }
        Ok(Channel { transport: target.endpoint()?.connect_lazy(), metadata })
    }

    /// Sends a request once, and returns its answer.
    pub async fn once<Q: Call>(&self, request: &Q, limit: Duration) -> Result<Q::Answer, Failure> {
        self.exchange(stream::once(std::future::ready(request.clone())), limit, only).await
    }

    /// Sends requests, and returns what `take` makes of the answers. All of it within the limit.
    pub async fn exchange<Q, S, F, T>(
        &self,
        requests: S,
        limit: Duration,
        take: fn(Answers<Q::Answer>) -> F,
    ) -> Result<T, Failure>
    where
        Q: Call,
        S: Stream<Item = Q> + Send + 'static,
        F: Future<Output = Result<T, Failure>>,
    {
        let began = Instant::now();
        let sent = Arc::new(AtomicBool::new(false));
        let call = async { take(self.open::<Q, _>(requests, Some(limit), sent.clone()).await?).await };
        let answer = self.within(limit, &sent, call).await;
        let code = answer.as_ref().map_or_else(Failure::code_name, |_| "Ok".to_string());
        tracing::debug!(method = Q::PATH, duration = ?began.elapsed(), code, "call");
        answer
    }

    /// Begins a call that lasts as long as its answers are kept. Returns once the daemon has begun to answer, at the
    /// latest after the limit.
    pub async fn stream<Q, S>(&self, requests: S, limit: Duration) -> Result<Answers<Q::Answer>, Failure>
    where
        Q: Call,
        S: Stream<Item = Q> + Send + 'static,
    {
        let sent = Arc::new(AtomicBool::new(false));
        let answers = self.within(limit, &sent, self.open::<Q, _>(requests, None, sent.clone())).await;
        let code = answers.as_ref().map_or_else(Failure::code_name, |_| "Ok".to_string());
        tracing::debug!(method = Q::PATH, code, "stream");
        answers
    }

    /// Every call has the form of a stream, also one with one request. `sent` becomes true when the connection takes the
    /// first request.
    async fn open<Q, S>(
        &self,
        requests: S,
        limit: Option<Duration>,
        sent: Arc<AtomicBool>,
    ) -> Result<Answers<Q::Answer>, Failure>
    where
        Q: Call,
        S: Stream<Item = Q> + Send + 'static,
    {
        let taken = sent.clone();
        let mut request = Request::new(requests.inspect(move |_| taken.store(true, Ordering::Release)));
        *request.metadata_mut() = self.metadata.clone();
        if let Some(limit) = limit {
            request.set_timeout(limit);
        }
        let mut grpc = Grpc::new(self.transport.clone());
        let codec = ProstCodec::<Q, Q::Answer>::default();
        let opened = match grpc.ready().await {
            Ok(()) => grpc.streaming(request, PathAndQuery::from_static(Q::PATH), codec).await,
            Err(error) => Err(Status::unavailable(error.to_string())),
        };
        match opened {
            Ok(answer) => Ok(Answers(answer.into_inner())),
            Err(status) => Err(Failure::new(&status, sent.load(Ordering::Acquire))),
        }
    }

    async fn within<T>(
        &self,
        limit: Duration,
        sent: &AtomicBool,
        call: impl Future<Output = Result<T, Failure>>,
    ) -> Result<T, Failure> {
        tokio::time::timeout(limit, call).await.unwrap_or_else(|_| {
            let late = Status::deadline_exceeded(format!("no answer within {limit:?}"));
            Err(Failure::new(&late, sent.load(Ordering::Acquire)))
        })
    }
}

/// Returns the only answer of a call.
async fn only<A>(mut answers: Answers<A>) -> Result<A, Failure> {
    let answer = answers.next().await?.ok_or_else(Failure::of_ended_stream)?;
    answers.next().await?; // the status of the call
    Ok(answer)
}
