package axisgate;

import axisgate.v1.PathHeader;
import axisgate.v1.RunPathRequest;
import axisgate.v1.RunPathResponse;
import axisgate.v1.Segment;
import axisgate.v1.StageServiceGrpc;
import java.time.Duration;
import java.util.List;

/** Starts a path. The path continues without the call. */
final class PathRun {
  /** Time for sending one segment, which is added to the limit of the request. */
  private static final Duration SEGMENT_TIME = Duration.ofNanos(500_000);

  private PathRun() {}

  static Motion start(Session session, List<Segment> segments) {
    Duration patience = SEGMENT_TIME.multipliedBy(segments.size());
    axisgate.v1.Motion motion =
        session.calls.start(
            session.token(),
            patience,
            context -> {
              PathHeader header =
                  PathHeader.newBuilder().setContext(context).setDevice(session.device).build();
              return limit -> send(session.connection().channel, header, segments, limit);
            });
    return new Motion(session, motion);
  }

  /** Sends the path once, and returns its motion once it has started. */
  private static axisgate.v1.Motion send(
      DaemonChannel channel, PathHeader header, List<Segment> segments, Duration limit)
      throws CallFailed, InterruptedException {
    try (var call = channel.begin(StageServiceGrpc.getRunPathMethod(), limit)) {
      call.send(RunPathRequest.newBuilder().setHeader(header).build());
      for (Segment segment : segments) {
        call.send(RunPathRequest.newBuilder().setSegment(segment).build());
      }
      call.finish();
      for (RunPathResponse answer = call.receive(); answer != null; answer = call.receive()) {
        if (answer.hasMotion()) {
          return answer.getMotion();
        }
      }
      throw new CallFailed(Failure.lostAnswer("the daemon did not send a motion"));
    }
  }
}
