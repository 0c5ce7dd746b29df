package axisgate;

import axisgate.v1.Job;
import axisgate.v1.JobHeader;
import axisgate.v1.MillServiceGrpc;
import axisgate.v1.SendJobPieceRequest;
import com.google.protobuf.ByteString;
import java.time.Duration;
import java.util.List;

/** Puts jobs into the queue of a mill. */
final class JobSending {
  private static final int PIECE_BYTES = 1 << 19;

  /**
   * Bytes that are sent in a millisecond at the least; the time for them is added to the limit of
   * the request.
   */
  private static final int BYTES_PER_MS = 1000;

  private JobSending() {}

  static Job send(Session session, JobHeader header, List<byte[]> parts) {
    ByteString content = ByteString.copyFrom(parts.stream().map(ByteString::copyFrom).toList());
    return session.calls.act(
        session.token(),
        Duration.ofMillis(content.size() / BYTES_PER_MS),
        context -> {
          JobHeader complete = header.toBuilder().setContext(context).build();
          return limit -> pieces(session.connection().channel, complete, content, limit);
        });
  }

  /** Sends the job from the byte on that the daemon does not have yet. */
  private static Job pieces(
      DaemonChannel channel, JobHeader header, ByteString content, Duration limit)
      throws CallFailed, InterruptedException {
    for (int at = 0; ; ) {
      int end = Math.min(at + PIECE_BYTES, content.size());
      SendJobPieceRequest piece =
          SendJobPieceRequest.newBuilder()
              .setHeader(header)
              .setOffset(at)
              .setData(content.substring(at, end))
              .setLast(end == content.size())
              .build();
      var answer = channel.attempt(MillServiceGrpc.getSendJobPieceMethod(), piece).send(limit);
      if (answer.hasJob()) {
        return answer.getJob();
      }
      at = (int) answer.getReceived();
    }
  }
}
