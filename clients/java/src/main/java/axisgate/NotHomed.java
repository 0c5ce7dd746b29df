package axisgate;

/** Refusal because the axis must be homed before any other motion. */
public final class NotHomed extends Refused {
  private static final long serialVersionUID = 1;

  NotHomed(Problem problem) {
    super(problem);
  }
}
