package axisgate;

import axisgate.v1.CallContext;
import axisgate.v1.DeviceServiceGrpc;
import axisgate.v1.ListDevicesRequest;
import axisgate.v1.ListDevicesResponse;
import axisgate.v1.StageServiceGrpc;
import com.google.protobuf.ByteString;
import io.grpc.MethodDescriptor;
import java.time.Duration;
import java.time.Instant;
import java.util.function.Function;

/**
 * Calls send requests, and send them again as {@link Repeat} and {@link Following} decide. Thread
 * safe.
 */
final class Calls {
  final Connection connection;

  Calls(Connection connection) {
    this.connection = connection;
  }

  /** Connects the channel for stops, and lists the devices. Fails at once if no daemon answers. */
  ListDevicesResponse connect() {
    var terms = terms(Duration.ZERO, false, true);
    ListDevicesResponse listed = send(connection.stops, terms, listing(connection.stops));
    Version.compare(listed.getVersion(), connection.logger);
    return listed;
  }

  /** Lists the devices. */
  ListDevicesResponse list() {
    var terms = terms(connection.half, false, true);
    return send(connection.channel, terms, listing(connection.channel));
  }

  /**
   * Returns the answer to a question. It is repeated for half of the time limit while no daemon
   * answers.
   */
  <Q, A> A ask(MethodDescriptor<Q, A> method, Q request) {
    var terms = terms(connection.half, false, true);
    return send(connection.channel, terms, connection.channel.attempt(method, request));
  }

  /** Returns the answer to a question, which is sent once. */
  <Q, A> A askOnce(MethodDescriptor<Q, A> method, Q request, Duration limit) {
    var terms = new Repeat.Terms(Times.now(), limit, connection.target.address(), false, true);
    return send(connection.channel, terms, connection.channel.attempt(method, request));
  }

  /**
   * Sends a request that changes something, so that it acts at most once, and returns its answer.
   * {@code patience} is the time that the request may wait for something, and {@code with} makes
   * the attempt from the context.
   */
  <A> A act(ByteString lease, Duration patience, Function<CallContext, Attempt<A>> with) {
    ListDevicesResponse listed = list();
    String memory = listed.getRequestsKept() ? listed.getRequestMemory() : "";
    Duration time = patience.plus(connection.half);
    Instant now = Instant.now();
    Duration ahead =
        connection.target.isLocal()
            ? Duration.ZERO
            : Requests.clockAhead(listed.getDevicesList(), now);
    CallContext context = Requests.context(memory, lease, now.plus(ahead).plus(time));
    return send(connection.channel, terms(time, true, !memory.isEmpty()), with.apply(context));
  }

  /**
   * Does the same as {@link #act} with a request that starts a motion, and returns the motion.
   * Throws OutcomeUnknown if another request started it.
   */
  axisgate.v1.Motion start(
      ByteString lease,
      Duration patience,
      Function<CallContext, Attempt<axisgate.v1.Motion>> with) {
    return act(
        lease,
        patience,
        context -> with.apply(context).map(motion -> Outcomes.own(motion, context.getRequestId())));
  }

  /** Sends a stop over its own channel. An interruption does not keep the stop from being sent. */
  <Q, A> A stop(MethodDescriptor<Q, A> method, Q request) {
    Attempt<A> attempt = connection.stops.attempt(method, request);
    try {
      return connection.uninterrupted(
          () -> send(connection.stops, terms(connection.half, true, true), attempt));
    } catch (Unavailable e) {
      throw Outcomes.undelivered(e);
    }
  }

  /** Returns the motion with its outcome, or as it is at {@code end}. Null: no limit. */
  axisgate.v1.Motion follow(axisgate.v1.Motion motion, Duration end) {
    Following following = new Following(motion, connection.target.address(), Times.now());
    Alarm alarm = connection.newAlarm();
    try {
      while (!Following.isOver(following.motion())) {
        connection.check();
        Duration left = end == null ? Following.LOST_LIMIT : end.minus(Times.now());
        question(following, Following.part(left), alarm);
        if (end != null && left.compareTo(Duration.ZERO) <= 0) {
          break;
        }
      }
      return following.motion();
    } catch (InterruptedException e) {
      throw Connection.interrupted();
    } finally {
      connection.forget(alarm);
    }
  }

  private void question(Following following, Duration wait, Alarm alarm)
      throws InterruptedException {
    try {
      var answer =
          connection
              .channel
              .attempt(StageServiceGrpc.getWaitMotionMethod(), following.question(wait))
              .send(wait.plus(Following.ANSWER));
      following.take(answer.getMotion(), Times.now());
    } catch (CallFailed e) {
      connection.check();
      Duration pause = following.after(e.failure, Times.now());
      connection.pause(alarm, connection.channel, e.failure, pause);
    }
  }

  private <A> A send(DaemonChannel channel, Repeat.Terms terms, Attempt<A> attempt) {
    connection.check();
    Repeat repeat = new Repeat(terms);
    Alarm alarm = connection.newAlarm();
    try {
      for (; ; ) {
        try {
          return attempt.send(repeat.timeout(Times.now()));
        } catch (CallFailed e) {
          if (connection.isClosed()) {
            throw repeat.abandoned(e.failure, Connection.closedError());
          }
          connection.pause(alarm, channel, e.failure, repeat.after(e.failure, Times.now()));
        }
      }
    } catch (InterruptedException e) {
      Failure lost = Failure.lostAnswer("interrupted");
      throw repeat.abandoned(lost, Connection.interrupted());
    } finally {
      connection.forget(alarm);
    }
  }

  private static Attempt<ListDevicesResponse> listing(DaemonChannel channel) {
    return channel.attempt(
        DeviceServiceGrpc.getListDevicesMethod(), ListDevicesRequest.getDefaultInstance());
  }

  private Repeat.Terms terms(Duration patience, boolean acts, boolean remembered) {
    String address = connection.target.address();
    return new Repeat.Terms(Times.now().plus(patience), connection.half, address, acts, remembered);
  }
}
