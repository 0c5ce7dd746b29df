package axisgate;

/**
 * Error of a call whose thread was interrupted. The interrupted status of the thread is set again.
 */
public final class Interrupted extends RuntimeException {
  private static final long serialVersionUID = 1;

  Interrupted(String message) {
    super(message);
  }
}
