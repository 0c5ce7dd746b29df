import axisgate.v1.*;
import axisgate.v1.EventServiceGrpc.EventServiceStub;
import axisgate.v1.StageServiceGrpc.StageServiceBlockingStub;
import io.grpc.Status;

/** An EventService.Watch whose events must be contiguous. */
final class Watch {
  final Answers<WatchRequest, WatchResponse> answers = new Answers<>();
  private Event last = Event.getDefaultInstance();
  private int moves = 0;

  /** Begins a Watch of everything that is kept. */
  Watch(EventServiceStub events) {
    events.watch(WatchRequest.newBuilder().setFromRevision(0).build(), answers);
  }

  /** Begins a Watch that goes on after the last event of another one. */
  Watch(EventServiceStub events, Watch before) {
    last = before.last;
    long from = last.getRevision() + 1;
    events.watch(WatchRequest.newBuilder().setFromRevision(from).setRun(last.getRun()).build(), answers);
  }

  /** Returns the next event. Throws Failure if the call has ended. */
  Event event() throws InterruptedException {
    return follow(answers.need());
  }

  /** Moves axis 1 by 10 um there or back, and reads events until the move has ended. */
  void move(StageServiceBlockingStub stage) throws InterruptedException {
    var distance = Distance.newBuilder().setUm(moves++ % 2 == 0 ? "10" : "-10");
    var request = MoveRequest.newBuilder().setDevice(Rows.STAGE).setRelative(true)
        .addTargets(AxisTarget.newBuilder().setAxis("1").setDistance(distance)).build();
    String name = stage.move(request).getMotion().getName();
    Motion motion;
    do {
      motion = event().getMotion();
    } while (!motion.getName().equals(name) || !motion.hasEndTime());
    Failure.expect("state of " + name, motion.getState(), MotionState.MOTION_STATE_SUCCEEDED);
  }

  /** Reads to the end of the call, and returns how it ended. */
  Status.Code end() throws InterruptedException {
    for (WatchResponse answer = answers.next(); answer != null; answer = answers.next()) {
      follow(answer);
    }
    return answers.end();
  }

  private Event follow(WatchResponse answer) {
    if (last.getRevision() != 0) {
      Failure.expect("event.revision", answer.getEvent().getRevision(), last.getRevision() + 1);
    }
    last = answer.getEvent();
    return last;
  }
}
