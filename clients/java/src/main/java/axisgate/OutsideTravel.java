package axisgate;

/** Refusal because the target is outside the travel limits of the axis. */
public final class OutsideTravel extends Refused {
  private static final long serialVersionUID = 1;

  OutsideTravel(Problem problem) {
    super(problem);
  }
}
