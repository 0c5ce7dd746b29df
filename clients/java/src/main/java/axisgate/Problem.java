package axisgate;

/**
 * A Problem is what happened, where, why, and what the caller can do.
 *
 * @param reason stable name of the reason, such as "OUTSIDE_TRAVEL". Programs should compare it,
 *     never the message. A reason that this package does not know is "REASON 99". The comments of
 *     {@code axisgate.v1.Reason} list all reasons
 * @param message one sentence for people
 * @param hint advice to the caller; may be empty
 * @param axis number of the axis, from 1; 0 if the problem does not concern a single axis
 * @param sent command line concerned; may be empty
 * @param wireReply reply of the controller; may be empty
 * @param code name of the gRPC code, such as "OUT_OF_RANGE"; empty if the problem is not the answer
 *     to a call
 */
public record Problem(
    String reason,
    String message,
    String hint,
    int axis,
    String sent,
    String wireReply,
    String code) {

  static Problem of(String reason, String message, String hint, String code) {
    return new Problem(reason, message, hint, 0, "", "", code);
  }

  /** Returns the reason, the message and the hint. */
  @Override
  public String toString() {
    return reason + ": " + message + (hint.isEmpty() ? "" : " (" + hint + ")");
  }
}
