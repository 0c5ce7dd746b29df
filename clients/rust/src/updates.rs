use std::fmt;
use std::pin::Pin;
use std::sync::Arc;
use std::task::{Context, Poll};

use futures_util::{stream, Stream, StreamExt};

use crate::api::Call;
use crate::channel::Answers;
use crate::connection::Connection;
use crate::errors::Result;
use crate::failure::Failure;
use crate::repeat::Backoff;

/// Updates are a series of items that continues after a broken connection. Dropping them ends the series.
///
/// Updates are a [`Stream`]; [`Updates::next`] needs no other crate. After an error, the series is at its end.
pub struct Updates<T>(Pin<Box<dyn Stream<Item = Result<T>> + Send>>);

impl<T> Updates<T> {
    pub(crate) fn new(items: impl Stream<Item = Result<T>> + Send + 'static) -> Updates<T> {
        Updates(Box::pin(items))
    }

    /// Returns the next item, or None at the end. No item is lost if the returned future is dropped.
    pub async fn next(&mut self) -> Option<Result<T>> {
        self.0.next().await
    }
}

impl<T> Stream for Updates<T> {
    type Item = Result<T>;

    fn poll_next(mut self: Pin<&mut Self>, context: &mut Context<'_>) -> Poll<Option<Self::Item>> {
        self.0.as_mut().poll_next(context)
    }
}

impl<T> fmt::Debug for Updates<T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("Updates")
    }
}

/// A Feed is how a stream begins, and what its answers become.
pub trait Feed: Send + 'static {
    type Request: Call;
    type Item: Send + 'static;

    /// Returns the request with which the stream begins, or begins again.
    fn request(&self) -> Self::Request;

    /// Returns the item of an answer. None: the answer has none.
    fn item(&mut self, answer: <Self::Request as Call>::Answer) -> Option<Self::Item>;

    /// Returns the item for answers that can no longer be received. None: the failure is another one.
    fn skip(&mut self, _failure: &Failure) -> Option<Self::Item> {
        None
    }
}

/// Begins a stream. Returns once the daemon has begun to answer, or if the connection is broken.
pub async fn begin<F: Feed>(connection: Arc<Connection>, feed: F) -> Result<Updates<F::Item>> {
    let mut resuming =
        Resuming { connection, feed, call: Err(Failure::of_ended_stream()), backoff: Backoff::default() };
    resuming.begin().await;
    match &resuming.call {
        Err(failure) if !failure.passing() => Err(failure.error(&resuming.connection.target.address)),
        _ => Ok(Updates::new(stream::unfold(Some(resuming), |resuming| async move {
            let mut resuming = resuming?;
            match resuming.next().await {
                Ok(item) => Some((Ok(item), Some(resuming))),
                Err(error) => Some((Err(error), None)),
            }
        }))),
    }
}

/// A Resuming is a call that is begun again after a broken connection. `call` is why it has failed, or its answers.
struct Resuming<F: Feed> {
    connection: Arc<Connection>,
    feed: F,
    call: Result<Answers<<F::Request as Call>::Answer>, Failure>,
    backoff: Backoff,
}

impl<F: Feed> Resuming<F> {
    async fn begin(&mut self) {
        let request = stream::once(std::future::ready(self.feed.request()));
        self.call = self.connection.calls.stream(request, 2 * self.connection.half).await;
    }

    async fn next(&mut self) -> Result<F::Item> {
        loop {
            let failure = match &mut self.call {
                Ok(answers) => match answers.next().await {
                    Ok(Some(answer)) => {
                        self.backoff = Backoff::default();
                        match self.feed.item(answer) {
                            Some(item) => return Ok(item),
                            None => continue,
                        }
                    }
                    Ok(None) => Failure::of_ended_stream(),
                    Err(failure) => failure,
                },
                Err(failure) => failure.clone(),
            };
            if let Some(item) = self.resume(failure).await? {
                return Ok(item);
            }
        }
    }

    /// Begins the call again. Returns an item for what was missed.
    async fn resume(&mut self, failure: Failure) -> Result<Option<F::Item>> {
        let skipped = self.feed.skip(&failure);
        if skipped.is_none() {
            if !failure.passing() && !failure.is("QUEUE_FULL") {
                return Err(failure.error(&self.connection.target.address));
            }
            tokio::time::sleep(self.backoff.pause()).await;
        }
        self.begin().await;
        Ok(skipped)
    }
}
