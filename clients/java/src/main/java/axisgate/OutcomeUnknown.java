package axisgate;

/**
 * Error of a request whose outcome is unknown. The axes may be moving: look at the stage before you
 * repeat the request.
 */
public final class OutcomeUnknown extends AxisgateException {
  private static final long serialVersionUID = 1;

  OutcomeUnknown(Problem problem) {
    super(problem, null);
  }

  OutcomeUnknown(Problem problem, Throwable cause) {
    super(problem, cause);
  }
}
