package axisgate;

import java.time.Duration;

/**
 * A Repeat decides after each failed attempt whether the same request is sent again. It has neither
 * a clock nor a connection. Not thread safe.
 */
final class Repeat {
  /**
   * Terms on which a request is sent again.
   *
   * @param until latest time of an attempt
   * @param answer time for the answer to an attempt
   * @param target address of the daemon
   * @param acts false for a question, which may always be repeated
   * @param remembered false if the daemon does not remember requests: a request that acts is then
   *     not repeated once it may have reached the daemon
   */
  record Terms(Duration until, Duration answer, String target, boolean acts, boolean remembered) {}

  private final Terms terms;
  private final Backoff backoff = new Backoff();
  private boolean mayHaveActed;

  Repeat(Terms terms) {
    this.terms = terms;
  }

  /** Returns the deadline of the attempt that is sent now, counted from now. */
  Duration timeout(Duration now) {
    return Times.notNegative(terms.until.minus(now)).plus(terms.answer);
  }

  /**
   * Returns the pause after which the same request is sent again. Throws the error with which the
   * call ends.
   */
  Duration after(Failure failure, Duration now) {
    take(failure);
    if (mayBeRepeated(failure)) {
      Duration pause = Times.shorter(backoff.pause(), terms.until.minus(now));
      if (pause.compareTo(Duration.ZERO) > 0) {
        return pause;
      }
    }
    throw errorOf(failure);
  }

  /** Returns the error of a request whose caller waits no longer because of {@code cause}. */
  RuntimeException abandoned(Failure failure, RuntimeException cause) {
    take(failure);
    if (!mayHaveActed) {
      return cause;
    }
    String why =
        "the answer of the daemon at " + terms.target + " was not awaited: " + cause.getMessage();
    return Outcomes.lookFirst(why, "", cause);
  }

  private void take(Failure failure) {
    mayHaveActed |= terms.acts && failure.lost() && failure.sent();
  }

  private boolean mayBeRepeated(Failure failure) {
    if (mayHaveActed && !terms.remembered) {
      return false;
    }
    return failure.passing() || (mayHaveActed && failure.reason().equals("QUEUE_FULL"));
  }

  private AxisgateException errorOf(Failure failure) {
    if (!terms.acts && failure.lost()) {
      return Outcomes.unavailable(failure, terms.target);
    }
    AxisgateException error = Outcomes.errorOf(failure, terms.target);
    if (!mayHaveActed || failure.decidesRepeat() || error instanceof OutcomeUnknown) {
      return error;
    }
    String why =
        "the answer to the request was lost, and a repeat was refused: " + error.getMessage();
    return Outcomes.lookFirst(why, failure.code().name(), error);
  }
}
