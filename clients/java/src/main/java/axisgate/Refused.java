package axisgate;

/** Error of a request that was refused: nothing moved. */
public sealed class Refused extends AxisgateException
    permits OutsideTravel, NotHomed, LeaseHeld, LeaseLost, StoppedBy, NotAllowed, Unavailable {
  private static final long serialVersionUID = 1;

  Refused(Problem problem) {
    super(problem, null);
  }
}
