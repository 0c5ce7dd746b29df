package axisgate;

import axisgate.v1.JogRequest;
import axisgate.v1.JogResponse;
import axisgate.v1.StageServiceGrpc;
import java.time.Duration;
import java.util.Map;
import java.util.TreeMap;
import java.util.concurrent.ExecutionException;
import java.util.concurrent.Future;

/**
 * A Jog runs axes until it is stopped or closed.
 *
 * <pre>{@code
 * try (var jog = stage.jog(Map.of("x", um(-200).perSecond()))) {
 *   Thread.sleep(2000);
 *   System.out.println(jog.stop());
 * }
 * }</pre>
 *
 * <p>A thread keeps the axes running. They are stopped if the program ends, or does not run for 500
 * ms. Thread safe.
 */
public final class Jog implements AutoCloseable {
  /** Time between two messages. The daemon stops the axes after 500 ms without a message. */
  private static final Duration INTERVAL = Duration.ofMillis(100);

  private final Session session;
  private final Alarm stopping;
  private final Call<JogRequest, JogResponse> call;
  private final Future<?> sender;
  private final Motion motion;

  private Jog(Session session, JogRequest first, Duration limit)
      throws CallFailed, InterruptedException {
    this.session = session;
    stopping = session.connection().newAlarm();
    call = session.connection().channel.begin(StageServiceGrpc.getJogMethod(), null);
    call.send(first);
    sender = session.connection().spawn(this::keep);
    try {
      motion = new Motion(session, begun(limit));
    } catch (CallFailed | InterruptedException e) {
      end();
      call.close();
      throw e;
    }
  }

  static Jog start(Session session, Map<String, Speed> speeds) {
    JogRequest.Builder first =
        JogRequest.newBuilder().setContext(session.leaseContext()).setDevice(session.device);
    new TreeMap<>(speeds).forEach((axis, speed) -> first.addAxes(Requests.jog(axis, speed)));
    Connection connection = session.connection();
    connection.check();
    try {
      return new Jog(session, first.build(), connection.half.multipliedBy(2));
    } catch (CallFailed e) {
      throw Outcomes.errorOf(e.failure, connection.target.address());
    } catch (InterruptedException e) {
      throw Connection.interrupted();
    }
  }

  private axisgate.v1.Motion begun(Duration limit) throws CallFailed, InterruptedException {
    JogResponse answer = call.receive(limit);
    if (answer == null) {
      throw new CallFailed(Failure.lostAnswer("the jog ended without an answer"));
    }
    return answer.getMotion();
  }

  /** Keeps the axes running until the jog or the call ends. */
  private Void keep() {
    try {
      for (stopping.pause(INTERVAL); !stopping.hasEnded(); stopping.pause(INTERVAL)) {
        call.send(JogRequest.getDefaultInstance());
      }
      call.finish();
    } catch (InterruptedException | IllegalStateException e) {
      call.close(); // The call has ended already, or nobody keeps the axes running any longer.
    }
    return null;
  }

  /**
   * Returns the motion of the jog.
   *
   * @return the motion
   */
  public Motion motion() {
    return motion;
  }

  /**
   * Ends the jog: the axes slow down. Waits for the outcome, also if the thread is interrupted.
   *
   * @return the result, with the positions
   * @throws Stopped if something else has stopped the axes
   */
  public Result stop() {
    end();
    return session.connection().uninterrupted(this::outcome);
  }

  private Result outcome() {
    try (call) {
      sender.get();
      while (call.receive() != null) {
        // The outcome of the motion says more.
      }
    } catch (CallFailed | ExecutionException e) {
      return motion.await();
    } catch (InterruptedException e) {
      throw Connection.interrupted();
    }
    return motion.await();
  }

  private void end() {
    stopping.end();
    session.connection().forget(stopping);
  }

  /** Does the same as {@link #stop} if the jog has not ended. */
  @Override
  public void close() {
    if (!stopping.hasEnded()) {
      stop();
    }
  }
}
