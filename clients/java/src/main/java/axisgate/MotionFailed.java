package axisgate;

/** Error of a motion that ended with an error of the stage. */
public final class MotionFailed extends AxisgateException {
  private static final long serialVersionUID = 1;

  MotionFailed(Problem problem) {
    super(problem, null);
  }
}
