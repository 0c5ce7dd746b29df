package axisgate;

import io.grpc.ConnectivityState;
import io.grpc.Grpc;
import io.grpc.ManagedChannel;
import io.grpc.Metadata;
import io.grpc.MethodDescriptor;
import java.time.Duration;
import java.util.concurrent.TimeUnit;

/** A DaemonChannel makes calls on one channel of gRPC, which repeats nothing. */
final class DaemonChannel {
  private static final Metadata.Key<String> SESSION = key("axisgate-session");
  private static final Metadata.Key<String> AUTHORIZATION = key("authorization");
  private static final Duration CLOSING = Duration.ofSeconds(2);

  private final ManagedChannel channel;
  private final String session;
  private final String token;
  private final System.Logger logger;

  DaemonChannel(Target target, String session, System.Logger logger) {
    this.session = session;
    this.token = target.token();
    this.logger = logger;
    var builder =
        Grpc.newChannelBuilder(target.uri(), target.credentials())
            .disableRetry()
            .disableServiceConfigLookUp()
            .idleTimeout(365, TimeUnit.DAYS)
            .keepAliveTime(20, TimeUnit.SECONDS)
            .keepAliveTimeout(10, TimeUnit.SECONDS)
            .keepAliveWithoutCalls(true);
    if (target.isSocket()) {
      NettyLog.omitSocketOption();
      builder.overrideAuthority("localhost"); // The path of a socket is no authority of HTTP/2.
    }
    channel = builder.build();
  }

  /** Begins a call. {@code limit} null: no deadline. */
  <Q, A> Call<Q, A> begin(MethodDescriptor<Q, A> method, Duration limit) {
    Duration began = Times.now();
    return new Call<>(
        channel,
        method,
        headers(),
        limit,
        code ->
            logger.log(
                System.Logger.Level.DEBUG,
                () ->
                    "%s %s after %d ms"
                        .formatted(
                            method.getFullMethodName(),
                            code,
                            Times.now().minus(began).toMillis())));
  }

  /** Begins a call with one request and without a deadline. */
  <Q, A> Call<Q, A> beginWith(MethodDescriptor<Q, A> method, Q request) {
    Call<Q, A> call = begin(method, null);
    call.send(request);
    call.finish();
    return call;
  }

  /** Returns the attempt of a call with one request and one answer. */
  <Q, A> Attempt<A> attempt(MethodDescriptor<Q, A> method, Q request) {
    return limit -> {
      try (Call<Q, A> call = begin(method, limit)) {
        call.send(request);
        call.finish();
        A answer = call.receive();
        if (answer == null || call.receive() != null) {
          throw new CallFailed(Failure.lostAnswer("the daemon did not send exactly one answer"));
        }
        return answer;
      }
    };
  }

  /** Connects again at once, and rings the alarm when the channel is connected or closed. */
  void reconnect(Alarm alarm) {
    channel.resetConnectBackoff();
    ringOnceReady(alarm, Times.now().plus(Backoff.LONGEST));
  }

  private void ringOnceReady(Alarm alarm, Duration until) {
    ConnectivityState state = channel.getState(true);
    if (state == ConnectivityState.READY || state == ConnectivityState.SHUTDOWN) {
      alarm.ring();
    } else if (Times.now().compareTo(until) < 0) {
      channel.notifyWhenStateChanged(state, () -> ringOnceReady(alarm, until));
    }
  }

  /** Ends all calls, and closes the channel. */
  void close() {
    channel.shutdownNow();
    try {
      channel.awaitTermination(CLOSING.toSeconds(), TimeUnit.SECONDS);
    } catch (InterruptedException e) {
      Thread.currentThread().interrupt();
    }
  }

  private Metadata headers() {
    Metadata headers = new Metadata();
    headers.put(SESSION, session);
    if (!token.isEmpty()) {
      headers.put(AUTHORIZATION, "Bearer " + token);
    }
    return headers;
  }

  private static Metadata.Key<String> key(String name) {
    return Metadata.Key.of(name, Metadata.ASCII_STRING_MARSHALLER);
  }
}
