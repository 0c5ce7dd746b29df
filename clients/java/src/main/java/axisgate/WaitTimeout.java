package axisgate;

/** Error of a wait whose time limit has passed. The motion continues. */
public final class WaitTimeout extends RuntimeException {
  private static final long serialVersionUID = 1;

  WaitTimeout(String message) {
    super(message);
  }
}
