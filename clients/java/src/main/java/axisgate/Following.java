package axisgate;

import axisgate.v1.WaitMotionRequest;
import java.time.Duration;

/**
 * A Following asks for the outcome of one motion, also over broken connections and restarts of the
 * daemon. It has neither a clock nor a connection. Not thread safe.
 */
final class Following {
  /** Time without an answer after which the outcome of a motion counts as unknown. */
  static final Duration LOST_LIMIT = Duration.ofSeconds(60);

  /** Time for the answer to a question, in addition to its wait. */
  static final Duration ANSWER = Duration.ofSeconds(5);

  private static final Duration LONGEST_WAIT = Duration.ofSeconds(10);

  private final String target;
  private final Backoff backoff = new Backoff();
  private axisgate.v1.Motion motion;
  private Duration answered;

  Following(axisgate.v1.Motion motion, String target, Duration now) {
    this.motion = motion;
    this.target = target;
    answered = now;
  }

  static boolean isOver(axisgate.v1.Motion motion) {
    return motion.hasEndTime();
  }

  axisgate.v1.Motion motion() {
    return motion;
  }

  /** Returns how long the next question waits if its caller waits at most {@code left}. */
  static Duration part(Duration left) {
    return Times.notNegative(Times.shorter(left, LONGEST_WAIT));
  }

  /** Returns the next question. */
  WaitMotionRequest question(Duration wait) {
    return WaitMotionRequest.newBuilder()
        .setMotion(motion.getName())
        .setMaxWait(Times.message(wait))
        .build();
  }

  /**
   * Takes an answer. Throws OutcomeUnknown if the answer is about another motion: a daemon without
   * a journal gives the names of motions again after a restart.
   */
  void take(axisgate.v1.Motion answer, Duration now) {
    answered = now;
    backoff.reset();
    if (!answer.getRequestId().equals(motion.getRequestId())) {
      throw unknown("the daemon was restarted, and no longer has the motion", null);
    }
    motion = answer;
  }

  /**
   * Returns the pause after which the daemon is asked again. Throws OutcomeUnknown if it is not.
   */
  Duration after(Failure failure, Duration now) {
    if (!failure.passing() && !failure.reason().equals("QUEUE_FULL")) {
      AxisgateException error = Outcomes.errorOf(failure, target);
      throw unknown("its outcome cannot be read: " + error.getMessage(), error);
    }
    if (now.minus(answered).compareTo(LOST_LIMIT) > 0) {
      throw unknown("the daemon has not answered for " + LOST_LIMIT.toSeconds() + " s", null);
    }
    return backoff.pause();
  }

  private OutcomeUnknown unknown(String why, Throwable cause) {
    String message = "the outcome of " + motion.getName() + " is unknown: " + why;
    return Outcomes.lookFirst(message, "", cause);
  }
}
