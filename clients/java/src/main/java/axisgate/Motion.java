package axisgate;

import axisgate.v1.CancelMotionRequest;
import axisgate.v1.MotionState;
import axisgate.v1.StageServiceGrpc;
import java.time.Duration;
import java.util.concurrent.CompletableFuture;

/** A Motion was started, and continues whatever this program does. Thread safe. */
public final class Motion {
  private final Session session;
  private axisgate.v1.Motion message;

  Motion(Session session, axisgate.v1.Motion message) {
    this.session = session;
    this.message = message;
  }

  /**
   * Returns the motion as last received, as the API's message.
   *
   * @return the message
   */
  public synchronized axisgate.v1.Motion message() {
    return message;
  }

  /**
   * Returns the name of the motion: "devices/stage/motions/12".
   *
   * @return the name
   */
  public String name() {
    return message().getName();
  }

  /**
   * Returns the number of the motion. Numbers ascend.
   *
   * @return the number
   */
  public long id() {
    return Long.parseLong(Names.last(name()));
  }

  /**
   * Returns the state as last received: "QUEUED", "RUNNING", "STOPPING", "SUCCEEDED", "STOPPED",
   * "FAILED" or "UNKNOWN".
   *
   * @return the state
   */
  public String state() {
    return Names.enumName(MotionState.getDescriptor(), message().getStateValue(), "MOTION_STATE_");
  }

  /**
   * Reports whether the motion has its outcome. Asks the daemon if the outcome is not known yet.
   *
   * @return true if the motion has its outcome
   */
  public boolean isDone() {
    return followUntil(Times.now());
  }

  /**
   * Waits for the outcome, also over broken connections and restarts of the daemon. An interruption
   * of the thread ends the wait and stops nothing.
   *
   * @return the result of a motion that has succeeded
   * @throws Stopped if a stop ended or prevented the motion
   * @throws MotionFailed if the motion ended with an error
   * @throws OutcomeUnknown if the outcome could not be seen
   * @throws Interrupted if the thread is interrupted
   */
  public Result await() {
    followUntil(null);
    return Outcomes.resultOf(message());
  }

  /**
   * Does the same as {@link #await()}, at most for the given time.
   *
   * @param limit longest wait
   * @return the result of a motion that has succeeded
   * @throws WaitTimeout if the motion has no outcome yet. It continues
   */
  public Result await(Duration limit) {
    if (!followUntil(Times.now().plus(limit))) {
      throw new WaitTimeout(name() + " has no outcome yet");
    }
    return Outcomes.resultOf(message());
  }

  /**
   * Returns a future of {@link #await()}. Neither its cancellation nor its timeout stops the
   * motion.
   *
   * @return the future, which completes on a thread of the package
   */
  public CompletableFuture<Result> toFuture() {
    return CompletableFuture.supplyAsync(this::await, session.connection().tasks());
  }

  /**
   * Iterates over the progress until the motion has its outcome, which {@link #await()} then
   * returns.
   *
   * @param interval time between two looks
   * @return the progress, for one iteration
   */
  public Iterable<Progress> progress(Duration interval) {
    return () -> new ProgressIterator(this, session, interval);
  }

  /**
   * Stops the motion, or drops it if it has not started. Has no effect on a motion with an outcome.
   * It is sent even if the thread is interrupted.
   */
  public void cancel() {
    var request = CancelMotionRequest.newBuilder().setMotion(name()).build();
    session
        .connection()
        .uninterrupted(() -> session.change(StageServiceGrpc.getCancelMotionMethod(), request));
  }

  /** Returns the name and the state of the motion. */
  @Override
  public String toString() {
    return name() + " " + state();
  }

  /**
   * Waits for the outcome until {@code end}. Null: no limit. Reports whether the motion has its
   * outcome.
   */
  boolean followUntil(Duration end) {
    axisgate.v1.Motion known = message();
    if (Following.isOver(known)) {
      return true;
    }
    return take(session.calls.follow(known, end));
  }

  private synchronized boolean take(axisgate.v1.Motion newer) {
    if (!Following.isOver(message)) {
      message = newer;
    }
    return Following.isOver(message);
  }
}
