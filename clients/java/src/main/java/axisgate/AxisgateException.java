package axisgate;

/**
 * An AxisgateException is an error that the daemon reports, or that the connection to it causes: a
 * {@link Refused}, {@link Stopped}, {@link MotionFailed} or {@link OutcomeUnknown}. A wrong
 * argument is an {@link IllegalArgumentException}, found before anything is sent.
 */
public abstract sealed class AxisgateException extends RuntimeException
    permits Refused, Stopped, MotionFailed, OutcomeUnknown {
  private static final long serialVersionUID = 1;

  private final transient Problem problem;

  AxisgateException(Problem problem, Throwable cause) {
    super(problem.toString(), cause);
    this.problem = problem;
  }

  /**
   * Returns what happened, where and why.
   *
   * @return the problem
   */
  public final Problem problem() {
    return problem;
  }

  /**
   * Returns the stable name of the reason, such as "OUTSIDE_TRAVEL".
   *
   * @return the reason
   */
  public final String reason() {
    return problem.reason();
  }

  /**
   * Returns advice to the caller. May be empty.
   *
   * @return the hint
   */
  public final String hint() {
    return problem.hint();
  }
}
