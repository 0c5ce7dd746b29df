package axisgate;

import axisgate.v1.CallContext;
import axisgate.v1.CommandServiceGrpc;
import axisgate.v1.ExecuteRequest;
import axisgate.v1.ExecuteResponse;
import java.time.Duration;
import java.util.ArrayList;
import java.util.List;
import java.util.Optional;
import java.util.UUID;

/** Sends lines in the controller's own language, once. */
final class Execution {
  private static final Duration LIMIT = Duration.ofSeconds(20);
  private static final Duration ANSWER = Duration.ofSeconds(5);

  private final Session session;
  private final CallContext context;
  private final List<String> answers = new ArrayList<>();
  private String motion = "";

  Execution(Session session) {
    this.session = session;
    context = session.leaseContext().toBuilder().setRequestId(UUID.randomUUID().toString()).build();
  }

  Executed run(List<String> lines) {
    ExecuteRequest request =
        ExecuteRequest.newBuilder()
            .setContext(context)
            .setDevice(session.device)
            .addAllLines(lines)
            .setTimeout(Times.message(LIMIT))
            .build();
    Connection connection = session.connection();
    connection.check();
    try (var call =
        connection.channel.begin(CommandServiceGrpc.getExecuteMethod(), LIMIT.plus(ANSWER))) {
      call.send(request);
      call.finish();
      for (var answer = call.receive(); answer != null; answer = call.receive()) {
        take(answer);
      }
    } catch (CallFailed e) {
      throw errorOf(e.failure, connection.target.address());
    } catch (InterruptedException e) {
      Interrupted interrupted = Connection.interrupted();
      throw Outcomes.lookFirst("the answers to the lines were not awaited", "", interrupted);
    }
    return new Executed(List.copyOf(answers), startedMotion());
  }

  private void take(ExecuteResponse answer) {
    if (answer.hasMotion()) {
      motion = answer.getMotion();
    } else if (answer.hasReply()) {
      answers.add(answer.getReply().getAnswer());
    }
  }

  private Optional<Motion> startedMotion() {
    if (motion.isEmpty()) {
      return Optional.empty();
    }
    var message = axisgate.v1.Motion.newBuilder().setName(motion);
    return Optional.of(new Motion(session, message.setRequestId(context.getRequestId()).build()));
  }

  /**
   * Returns the error. It is not Refused, which means that nothing moved, if lines were sent that
   * may move.
   */
  private AxisgateException errorOf(Failure failure, String target) {
    AxisgateException error = Outcomes.errorOf(failure, target);
    if (motion.isEmpty() || failure.problem() == null || !(error instanceof Refused)) {
      return error;
    }
    boolean uncertain = error instanceof Unavailable || error.reason().equals("DEADLINE_PASSED");
    return uncertain ? new OutcomeUnknown(error.problem()) : new MotionFailed(error.problem());
  }
}
