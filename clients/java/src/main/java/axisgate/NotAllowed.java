package axisgate;

/** Refusal because the caller's role does not allow the request, or the token is not valid. */
public final class NotAllowed extends Refused {
  private static final long serialVersionUID = 1;

  NotAllowed(Problem problem) {
    super(problem);
  }
}
