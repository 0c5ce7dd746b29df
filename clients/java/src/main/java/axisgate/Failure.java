package axisgate;

import com.google.protobuf.Any;
import com.google.protobuf.InvalidProtocolBufferException;
import io.grpc.Metadata;
import io.grpc.Status;
import io.grpc.protobuf.StatusProto;
import java.util.Map;
import java.util.Set;

/**
 * A Failure is a call that ended without an answer.
 *
 * @param problem null if the daemon did not report a problem
 * @param sent false if no byte of the call can have reached the daemon
 */
record Failure(Status.Code code, String text, axisgate.v1.Problem problem, boolean sent) {
  /**
   * Reasons of calls that the daemon refuses before it can send a problem. RESOURCE_EXHAUSTED is
   * not among them: grpc-java also reports it for an answer that is too long, and for a connection
   * that was closed.
   */
  private static final Map<Status.Code, String> EARLY =
      Map.of(
          Status.Code.UNAUTHENTICATED, "UNAUTHENTICATED",
          Status.Code.PERMISSION_DENIED, "NOT_ALLOWED",
          Status.Code.UNIMPLEMENTED, "UNIMPLEMENTED");

  /** Reasons that the daemon may give before it compares the request's id with earlier requests. */
  private static final Set<String> BEFORE_MEMORY =
      Set.of(
          "INVALID_REQUEST",
          "UNKNOWN_DEVICE",
          "UNKNOWN_AXIS",
          "QUEUE_FULL",
          "NOT_ALLOWED",
          "UNAUTHENTICATED",
          "LEASE_LOST",
          "INTERNAL",
          "REQUEST_ID_REUSED");

  static Failure of(Status status, Metadata trailers, boolean sent) {
    String text = status.getDescription() == null ? "" : status.getDescription();
    String sentence = text.lines().findFirst().orElse(""); // Netty adds lines about its pipeline.
    return new Failure(status.getCode(), sentence, problemIn(status, trailers), sent);
  }

  /** Returns the failure of a call that was not awaited, or has an answer that is not complete. */
  static Failure lostAnswer(String text) {
    return new Failure(Status.Code.UNKNOWN, text, null, true);
  }

  private static axisgate.v1.Problem problemIn(Status status, Metadata trailers) {
    try {
      for (Any detail : StatusProto.fromStatusAndTrailers(status, trailers).getDetailsList()) {
        if (detail.is(axisgate.v1.Problem.class)) {
          return detail.unpack(axisgate.v1.Problem.class);
        }
      }
    } catch (InvalidProtocolBufferException | IllegalArgumentException e) {
      return null; // The details are not the daemon's.
    }
    return null;
  }

  /** Returns the name of the reason. Empty: the answer was lost. */
  String reason() {
    return problem == null ? EARLY.getOrDefault(code, "") : Names.reason(problem.getReasonValue());
  }

  /** Reports whether the answer was lost, so that the request may have acted. */
  boolean lost() {
    return problem == null && !EARLY.containsKey(code);
  }

  /** Reports whether the request cannot have acted because there was no connection. */
  boolean neverSent() {
    return lost() && !sent;
  }

  /** Reports whether the same request may succeed a moment later. */
  boolean passing() {
    return lost() || code == Status.Code.UNAVAILABLE;
  }

  /** Reports whether this refusal of a repeat means that the first request did not act either. */
  boolean decidesRepeat() {
    return !passing() && !BEFORE_MEMORY.contains(reason());
  }
}
