package axisgate;

/** Refusal because the lease of this program has ended. */
public final class LeaseLost extends Refused {
  private static final long serialVersionUID = 1;

  LeaseLost(Problem problem) {
    super(problem);
  }
}
