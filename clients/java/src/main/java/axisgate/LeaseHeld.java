package axisgate;

/** Refusal because another caller holds the axes, or moves them. */
public final class LeaseHeld extends Refused {
  private static final long serialVersionUID = 1;

  LeaseHeld(Problem problem) {
    super(problem);
  }
}
