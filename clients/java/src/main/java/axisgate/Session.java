package axisgate;

import axisgate.v1.CallContext;
import axisgate.v1.Capability;
import axisgate.v1.Device;
import axisgate.v1.DeviceServiceGrpc;
import axisgate.v1.GetDeviceRequest;
import axisgate.v1.ListDevicesResponse;
import com.google.protobuf.ByteString;
import com.google.protobuf.Message;
import io.grpc.MethodDescriptor;
import java.time.Duration;
import java.util.HexFormat;
import java.util.List;
import java.util.concurrent.CopyOnWriteArrayList;
import java.util.function.Function;
import java.util.function.Supplier;

/**
 * A Session sends the requests for one device: its name, and the lease that the calls carry. Thread
 * safe.
 */
final class Session {
  private static final int TOKEN_BYTES = 24;

  final Calls calls;
  final Device opened;
  final String device;
  private final ByteString inherited;
  private final List<ByteString> leases = new CopyOnWriteArrayList<>();

  private Session(Calls calls, Device opened, ByteString inherited) {
    this.calls = calls;
    this.opened = opened;
    device = opened.getName();
    this.inherited = inherited;
  }

  /** Connects to the daemon, and chooses a device with the capability. */
  static Session open(ConnectOptions options, Capability capability) {
    ByteString inherited = inheritedToken(options.lease());
    Connection connection = new Connection(options);
    try {
      Calls calls = new Calls(connection);
      ListDevicesResponse listed = calls.connect();
      Device device = Requests.choose(listed.getDevicesList(), capability, options.device);
      return new Session(calls, device, inherited);
    } catch (RuntimeException e) {
      connection.close();
      throw e;
    }
  }

  static ByteString inheritedToken(String text) {
    byte[] token = null;
    try {
      token = HexFormat.of().parseHex(text);
    } catch (IllegalArgumentException e) {
      // The error below says what is expected.
    }
    if (token == null || (token.length != 0 && token.length != TOKEN_BYTES)) {
      throw new IllegalArgumentException(
          "AXISGATE_LEASE is not the token of a lease: unset it, or use `axisctl lease run`");
    }
    return ByteString.copyFrom(token);
  }

  Connection connection() {
    return calls.connection;
  }

  /** Returns the token of the newest lease, or that of `axisctl lease run`. Empty: no lease. */
  ByteString token() {
    Object[] held = leases.toArray();
    return held.length == 0 ? inherited : (ByteString) held[held.length - 1];
  }

  void carry(ByteString lease) {
    leases.add(lease);
  }

  void leave(ByteString lease) {
    leases.remove(lease);
  }

  /** Returns the context of a stop, which carries only the lease. */
  CallContext leaseContext() {
    return CallContext.newBuilder().setLeaseToken(token()).build();
  }

  <Q, A> A ask(MethodDescriptor<Q, A> method, Q request) {
    return calls.ask(method, request);
  }

  /** Sends a request that changes something, and returns its answer. */
  <Q extends Message, A> A change(MethodDescriptor<Q, A> method, Q request) {
    return change(method, request, Duration.ZERO, token());
  }

  /** Sends a request that may wait for {@code patience}, under the given lease. */
  <Q extends Message, A> A change(
      MethodDescriptor<Q, A> method, Q request, Duration patience, ByteString lease) {
    return calls.act(lease, patience, context -> attempt(method, request, context));
  }

  private <Q extends Message, A> Attempt<A> attempt(
      MethodDescriptor<Q, A> method, Q request, CallContext context) {
    return connection().channel.attempt(method, Requests.withContext(request, context));
  }

  /** Starts a motion. */
  <Q extends Message, A> Motion start(
      MethodDescriptor<Q, A> method, Q request, Function<A, axisgate.v1.Motion> motion) {
    return new Motion(
        this,
        calls.start(
            token(), Duration.ZERO, context -> attempt(method, request, context).map(motion)));
  }

  /**
   * Waits for the outcome of the motion that {@code begin} starts. An interruption cancels the
   * motion; it does not end {@code begin}, which would leave it open whether the motion has
   * started.
   */
  Result finish(Supplier<Motion> begin) {
    connection().check();
    Motion motion = connection().uninterrupted(begin);
    try {
      return motion.await();
    } catch (Interrupted e) {
      throw cancelled(motion, e);
    }
  }

  private static RuntimeException cancelled(Motion motion, Interrupted why) {
    try {
      motion.cancel();
    } catch (RuntimeException e) {
      String message = motion.name() + " was interrupted, but not cancelled: " + e.getMessage();
      why.addSuppressed(e);
      return Outcomes.lookFirst(message, "", why);
    }
    return new Interrupted(motion.name() + " is cancelled: the thread was interrupted");
  }

  /** Returns the state of the device. {@code maxAge} null: any age. */
  Device read(Duration maxAge) {
    GetDeviceRequest.Builder request = GetDeviceRequest.newBuilder().setDevice(device);
    if (maxAge != null) {
      request.setMaxAge(Times.message(maxAge));
    }
    return ask(DeviceServiceGrpc.getGetDeviceMethod(), request.build()).getDevice();
  }
}
