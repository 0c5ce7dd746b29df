package axisgate;

import axisgate.v1.MotionState;
import java.util.Map;
import java.util.function.Function;

/** Makes the errors of failed calls and motions. */
final class Outcomes {
  static final String UNAVAILABLE = "UNAVAILABLE";
  static final String OUTCOME_UNKNOWN = "OUTCOME_UNKNOWN";
  private static final String LOOK_FIRST = "look at the stage before you repeat the request";

  /** Classes of the errors of reasons that are not just Refused. */
  private static final Map<String, Function<Problem, AxisgateException>> CLASSES =
      Map.ofEntries(
          Map.entry("OUTSIDE_TRAVEL", OutsideTravel::new),
          Map.entry("NOT_HOMED", NotHomed::new),
          Map.entry("LEASE_HELD", LeaseHeld::new),
          Map.entry("LEASE_LOST", LeaseLost::new),
          Map.entry("STOPPED_BY", StoppedBy::new),
          Map.entry("NOT_ALLOWED", NotAllowed::new),
          Map.entry("UNAUTHENTICATED", NotAllowed::new),
          Map.entry("LINK_DOWN", Unavailable::new),
          Map.entry("NOT_SENT", Unavailable::new),
          Map.entry("REPLY_TIMED_OUT", Unavailable::new),
          Map.entry("LINE_FAULT", Unavailable::new),
          Map.entry("COMPLETION_OUTSTANDING", Unavailable::new),
          Map.entry("JOURNAL_UNAVAILABLE", Unavailable::new),
          Map.entry("DAEMON_ENDING", Unavailable::new),
          Map.entry("STOPPED", Stopped::new),
          Map.entry("TARGET_NOT_REACHED", MotionFailed::new),
          Map.entry(OUTCOME_UNKNOWN, OutcomeUnknown::new),
          Map.entry("REQUEST_MEMORY_LOST", OutcomeUnknown::new));

  private Outcomes() {}

  /**
   * Returns the error of a call that failed and is not repeated. {@code target} is the daemon's
   * address.
   */
  static AxisgateException errorOf(Failure failure, String target) {
    String code = failure.code().name();
    if (failure.problem() != null) {
      return errorOf(problemOf(failure.problem(), code));
    }
    if (!failure.lost()) {
      return errorOf(Problem.of(failure.reason(), failure.text(), "", code));
    }
    if (failure.neverSent()) {
      return unavailable(failure, target);
    }
    return lookFirst(
        "the answer of the daemon at " + target + " was lost: " + failure.text(), code, null);
  }

  /** Returns the error of the class for its reason. */
  static AxisgateException errorOf(Problem problem) {
    return CLASSES.getOrDefault(problem.reason(), Refused::new).apply(problem);
  }

  /** Returns the error of a request that acted nowhere because the daemon did not answer. */
  static Unavailable unavailable(Failure failure, String target) {
    return new Unavailable(
        Problem.of(
            UNAVAILABLE,
            "no daemon answers at " + target + ": " + failure.text(),
            "start axisgated, or set AXISGATE_TARGET to its address",
            failure.code().name()));
  }

  /**
   * Returns the error of a stop that reached no daemon. It is not Refused: the axes may be moving.
   */
  static OutcomeUnknown undelivered(Unavailable error) {
    Problem problem = error.problem();
    return new OutcomeUnknown(
        Problem.of(
            problem.reason(),
            "the stop was not delivered: " + problem.message(),
            "press the emergency stop at the device",
            problem.code()));
  }

  /** Returns the error of a request that may have acted. */
  static OutcomeUnknown lookFirst(String message, String code, Throwable cause) {
    return new OutcomeUnknown(Problem.of(OUTCOME_UNKNOWN, message, LOOK_FIRST, code), cause);
  }

  /** Returns the motion of an answer. Throws OutcomeUnknown if another request started it. */
  static axisgate.v1.Motion own(axisgate.v1.Motion motion, String requestId) {
    if (motion.getRequestId().equals(requestId)) {
      return motion;
    }
    throw lookFirst(
        "the daemon answered with " + motion.getName() + ", which another request started",
        "",
        null);
  }

  /**
   * Returns the public form of a problem. An empty code: the problem is not the answer to a call.
   */
  static Problem problemOf(axisgate.v1.Problem message, String code) {
    return new Problem(
        Names.reason(message.getReasonValue()),
        message.getMessage(),
        Hints.withMethods(message.getHint(), message.getAxis()),
        message.getAxis(),
        message.getSent(),
        message.getWireReply(),
        code);
  }

  /**
   * Returns the result of a motion that is over. Throws the error of another outcome than success.
   */
  static Result resultOf(axisgate.v1.Motion motion) {
    if (motion.getState() == MotionState.MOTION_STATE_SUCCEEDED) {
      return Result.of(motion);
    }
    Problem problem = problemOf(motion.getProblem(), "");
    throw switch (motion.getState()) {
      case MOTION_STATE_STOPPED -> new Stopped(problem);
      case MOTION_STATE_UNKNOWN -> new OutcomeUnknown(problem);
      default -> new MotionFailed(problem);
    };
  }
}
