package axisgate;

import java.util.Optional;

/**
 * A Resuming is a call that is begun again after a broken connection. One thread receives; any
 * thread may close.
 */
final class Resuming<A, T> {
  private final Connection connection;
  private final Source<A, T> source;
  private final Alarm ending;
  private final Backoff backoff = new Backoff();
  private volatile Call<?, A> call;
  private Failure failed;

  /** Begins the call, and returns once the daemon has begun to answer. */
  Resuming(Connection connection, Source<A, T> source) {
    connection.check();
    this.connection = connection;
    this.source = source;
    ending = connection.newAlarm();
    try {
      begin();
    } catch (InterruptedException e) {
      close();
      throw Connection.interrupted();
    }
    if (failed != null && !failed.passing()) {
      close();
      throw Outcomes.errorOf(failed, connection.target.address());
    }
  }

  void close() {
    ending.end();
    connection.forget(ending);
    call.close();
  }

  /** Returns the next item. Empty: the series was closed. */
  Optional<T> next() throws InterruptedException {
    for (; ; ) {
      Optional<T> item = failed == null ? receive() : Optional.empty();
      if (item.isPresent()) {
        return item;
      }
      if (connection.isClosed()) {
        throw Connection.closedError();
      }
      if (ending.hasEnded()) {
        return Optional.empty();
      }
      item = resume();
      if (item.isPresent()) {
        return item;
      }
    }
  }

  private Optional<T> receive() throws InterruptedException {
    try {
      A answer = call.receive();
      if (answer != null) {
        backoff.reset();
        return Optional.of(source.item(answer));
      }
      failed = Failure.lostAnswer("the daemon ended the stream");
    } catch (CallFailed e) {
      failed = e.failure;
    }
    return Optional.empty();
  }

  /** Begins the call again. Returns an item for what was missed. */
  private Optional<T> resume() throws InterruptedException {
    Optional<T> skipped = source.skip(failed);
    if (skipped.isEmpty()) {
      if (!failed.passing() && !failed.reason().equals("QUEUE_FULL")) {
        throw Outcomes.errorOf(failed, connection.target.address());
      }
      connection.pause(ending, connection.channel, failed, backoff.pause());
    }
    begin();
    return skipped;
  }

  /** Sends the request, and waits until the daemon has begun to answer. */
  private void begin() throws InterruptedException {
    call = source.begin();
    if (ending.hasEnded()) {
      call.close();
    }
    failed = null;
    if (!call.awaitBegin()) {
      receive();
    }
  }
}
