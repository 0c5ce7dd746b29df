import io.grpc.Status;
import io.grpc.stub.ClientCallStreamObserver;
import io.grpc.stub.ClientResponseObserver;
import java.util.concurrent.LinkedBlockingQueue;
import java.util.concurrent.TimeUnit;

/** Both sides of one streaming call: requests of type Q, and answers of type A in their order. */
final class Answers<Q, A> implements ClientResponseObserver<Q, A> {
  /** The client's side. */
  ClientCallStreamObserver<Q> call;
  /** Answers, then one Status. */
  private final LinkedBlockingQueue<Object> queue = new LinkedBlockingQueue<>();
  /** Null until the end of the call was read. */
  private Status status;

  @Override
  public void beforeStart(ClientCallStreamObserver<Q> started) {
    call = started;
  }

  @Override
  public void onNext(A answer) {
    queue.add(answer);
  }

  @Override
  public void onError(Throwable error) {
    queue.add(Status.fromThrowable(error));
  }

  @Override
  public void onCompleted() {
    queue.add(Status.OK);
  }

  /** Returns the next answer, or null if the call has ended. */
  @SuppressWarnings("unchecked")
  A next() throws InterruptedException {
    Object item = status != null ? status : queue.poll(60, TimeUnit.SECONDS);
    Failure.check(item != null, "stream", "nothing for 60 s", "an answer or the end of the call");
    if (item instanceof Status end) {
      status = end;
      return null;
    }
    return (A) item;
  }

  /** Returns the next answer. Throws Failure if the call has ended. */
  A need() throws InterruptedException {
    A answer = next();
    Failure.check(answer != null, "stream", status, "an answer");
    return answer;
  }

  /** Drops all further answers, and returns how the call ended. */
  Status.Code end() throws InterruptedException {
    while (next() != null) {
      continue;
    }
    return status.getCode();
  }
}
