package axisgate;

import static axisgate.Units.pulses;

import axisgate.v1.AxisTarget;
import axisgate.v1.CallContext;
import axisgate.v1.DeviceServiceGrpc;
import axisgate.v1.GetDeviceRequest;
import axisgate.v1.ListDevicesRequest;
import axisgate.v1.MotionState;
import axisgate.v1.MoveRequest;
import axisgate.v1.StageServiceGrpc;
import axisgate.v1.WaitMotionRequest;
import io.grpc.Grpc;
import io.grpc.ManagedChannel;
import io.grpc.stub.AbstractStub;
import java.time.Duration;
import java.time.Instant;
import java.util.Arrays;
import java.util.UUID;
import java.util.concurrent.TimeUnit;
import java.util.function.IntConsumer;

/**
 * Compares the package with bare stubs that send the same messages, alternately in one process.
 * Prints the median times in microseconds.
 */
final class Bench {
  private static final int QUESTIONS = 300;
  private static final int MOVES = 60;
  private static final Duration LIMIT = Duration.ofSeconds(5);

  private final DeviceServiceGrpc.DeviceServiceBlockingStub devices;
  private final StageServiceGrpc.StageServiceBlockingStub stages;

  private Bench(ManagedChannel channel) {
    devices = DeviceServiceGrpc.newBlockingStub(channel);
    stages = StageServiceGrpc.newBlockingStub(channel);
  }

  public static void main(String[] arguments) {
    Target target = Target.of(new ConnectOptions());
    var builder = Grpc.newChannelBuilder(target.uri(), target.credentials());
    if (target.isSocket()) {
      builder.overrideAuthority("localhost");
    }
    try (var stage = Stage.open()) {
      ManagedChannel channel = builder.build();
      Bench bare = new Bench(channel);
      var x = stage.axis("x");
      String questions = compared(QUESTIONS, 2000, i -> stage.status(), i -> bare.getDevice());
      String moves = compared(MOVES, 20, i -> x.moveBy(pulses(pulse(i))), i -> bare.move(pulse(i)));
      System.out.printf("{\"get_device\": %s, \"move\": %s}%n", questions, moves);
      channel.shutdownNow();
    }
  }

  private void getDevice() {
    var request = GetDeviceRequest.newBuilder().setDevice("devices/stage").build();
    limited(devices).getDevice(request);
  }

  private void move(long pulses) {
    var listed = limited(devices).listDevices(ListDevicesRequest.getDefaultInstance());
    var context =
        CallContext.newBuilder()
            .setRequestId(UUID.randomUUID().toString())
            .setRequestMemory(listed.getRequestMemory())
            .setNotAfter(Times.message(Instant.now().plus(LIMIT)));
    var distance = axisgate.v1.Distance.newBuilder().setPulses(pulses);
    var request =
        MoveRequest.newBuilder()
            .setContext(context)
            .setDevice("devices/stage")
            .setRelative(true)
            .addTargets(AxisTarget.newBuilder().setAxis("x").setDistance(distance));
    var motion = limited(stages).move(request.build()).getMotion();
    var wait = WaitMotionRequest.newBuilder().setMotion(motion.getName());
    wait.setMaxWait(Times.message(LIMIT));
    if (limited(stages).waitMotion(wait.build()).getMotion().getState()
        != MotionState.MOTION_STATE_SUCCEEDED) {
      throw new IllegalStateException("a move did not succeed");
    }
  }

  private static <S extends AbstractStub<S>> S limited(S stub) {
    return stub.withDeadlineAfter(2 * LIMIT.toSeconds(), TimeUnit.SECONDS);
  }

  private static long pulse(int i) {
    return i % 2 == 0 ? 1 : -1;
  }

  /** Returns the medians of both, which run alternately after a warm-up, as JSON. */
  private static String compared(int count, int warmUp, IntConsumer ours, IntConsumer bare) {
    long[] oursNs = new long[count];
    long[] bareNs = new long[count];
    for (int i = -warmUp; i < count; i++) {
      long tookNs = timed(ours, i);
      long bareTookNs = timed(bare, i);
      if (i >= 0) {
        oursNs[i] = tookNs;
        bareNs[i] = bareTookNs;
      }
    }
    return "{\"package_us\": %d, \"bare_us\": %d}".formatted(medianUs(oursNs), medianUs(bareNs));
  }

  private static long timed(IntConsumer run, int i) {
    long begun = System.nanoTime();
    run.accept(i);
    return System.nanoTime() - begun;
  }

  private static long medianUs(long[] timesNs) {
    Arrays.sort(timesNs);
    return timesNs[timesNs.length / 2] / 1000;
  }
}
