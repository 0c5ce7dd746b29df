package axisgate;

/** Error of a motion that a stop ended or prevented. */
public final class Stopped extends AxisgateException {
  private static final long serialVersionUID = 1;

  Stopped(Problem problem) {
    super(problem, null);
  }
}
