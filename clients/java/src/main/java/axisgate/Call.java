package axisgate;

import io.grpc.CallOptions;
import io.grpc.Channel;
import io.grpc.ClientCall;
import io.grpc.Metadata;
import io.grpc.MethodDescriptor;
import io.grpc.Status;
import java.time.Duration;
import java.util.Queue;
import java.util.concurrent.ConcurrentLinkedQueue;
import java.util.concurrent.TimeUnit;
import java.util.function.Consumer;

/**
 * A Call is one call of gRPC, which its threads wait for. One thread sends, and one receives;
 * close() may be called by any thread.
 */
final class Call<Q, A> implements AutoCloseable {
  /** What a call delivers: an answer, a failure, or its end if both are null. */
  private record Item<A>(A answer, Failure failure) {}

  private static final Duration NO_LIMIT = Duration.ofDays(36_500);

  private final ClientCall<Q, A> call;
  private final boolean streaming;
  private final Reach reach = new Reach();
  private final Callbacks callbacks = new Callbacks();
  private final Queue<Item<A>> items = new ConcurrentLinkedQueue<>();
  private volatile boolean answering;
  private volatile boolean over;
  private Item<A> last;

  /** Begins a call. {@code limit} null: no deadline. {@code ended} receives the code of its end. */
  Call(
      Channel channel,
      MethodDescriptor<Q, A> method,
      Metadata headers,
      Duration limit,
      Consumer<Status.Code> ended) {
    CallOptions options =
        CallOptions.DEFAULT.withStreamTracerFactory(reach).withExecutor(callbacks);
    if (limit != null) {
      options = options.withDeadlineAfter(limit.toNanos(), TimeUnit.NANOSECONDS);
    }
    call = channel.newCall(method, options);
    call.start(new Listener(ended), headers);
    streaming = !method.getType().serverSendsOneMessage();
    call.request(streaming ? 1 : 2); // The second request shows whether there is another answer.
  }

  void send(Q message) {
    call.sendMessage(message);
  }

  /** Sends no more messages. */
  void finish() {
    call.halfClose();
  }

  /**
   * Waits until the daemon has begun to answer, or the call has ended. Reports whether it has begun
   * to answer.
   */
  boolean awaitBegin() throws InterruptedException {
    while (!answering && !over) {
      callbacks.runNext(NO_LIMIT.toNanos());
    }
    return answering;
  }

  /** Returns the next answer, or null if the call has ended normally. */
  A receive() throws CallFailed, InterruptedException {
    return receive(NO_LIMIT);
  }

  /** Does the same as receive() within the limit. */
  A receive(Duration limit) throws CallFailed, InterruptedException {
    if (last == null) {
      Item<A> item = nextItem(limit);
      if (item.answer != null) {
        if (streaming) {
          call.request(1);
        }
        return item.answer;
      }
      last = item;
    }
    if (last.failure != null) {
      throw new CallFailed(last.failure);
    }
    return null;
  }

  private Item<A> nextItem(Duration limit) throws CallFailed, InterruptedException {
    long end = System.nanoTime() + limit.toNanos();
    for (Item<A> item = items.poll(); ; item = items.poll()) {
      if (item != null) {
        return item;
      }
      long left = end - System.nanoTime();
      if (left <= 0) {
        throw new CallFailed(Failure.lostAnswer("the daemon did not answer in time"));
      }
      callbacks.runNext(left);
    }
  }

  /** Ends the call. No effect on a call that has ended. */
  @Override
  public void close() {
    if (!over) {
      call.cancel("the caller does not wait for the answer", null);
      callbacks.abandon();
    }
  }

  private final class Listener extends ClientCall.Listener<A> {
    private final Consumer<Status.Code> ended;

    Listener(Consumer<Status.Code> ended) {
      this.ended = ended;
    }

    @Override
    public void onHeaders(Metadata headers) {
      answering = true;
    }

    @Override
    public void onMessage(A answer) {
      items.add(new Item<>(answer, null));
    }

    @Override
    public void onClose(Status status, Metadata trailers) {
      ended.accept(status.getCode());
      Failure failure = status.isOk() ? null : Failure.of(status, trailers, reach.reached());
      items.add(new Item<>(null, failure));
      over = true;
    }
  }
}
