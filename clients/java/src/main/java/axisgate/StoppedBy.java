package axisgate;

/**
 * Refusal because another caller stopped the axes. Call {@link Stage#rearm} before the next motion.
 */
public final class StoppedBy extends Refused {
  private static final long serialVersionUID = 1;

  StoppedBy(Problem problem) {
    super(problem);
  }
}
