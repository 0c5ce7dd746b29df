package axisgate;

/** Refusal because the daemon or the controller cannot be reached. */
public final class Unavailable extends Refused {
  private static final long serialVersionUID = 1;

  Unavailable(Problem problem) {
    super(problem);
  }
}
