package axisgate;

import axisgate.v1.AxisJog;
import axisgate.v1.AxisTarget;
import axisgate.v1.CallContext;
import axisgate.v1.Capability;
import axisgate.v1.Device;
import axisgate.v1.MoveRequest;
import com.google.protobuf.ByteString;
import com.google.protobuf.Message;
import java.time.Duration;
import java.time.Instant;
import java.util.List;
import java.util.Map;
import java.util.TreeMap;
import java.util.UUID;
import java.util.stream.Collectors;

/** Makes the messages of requests. */
final class Requests {
  private Requests() {}

  /** Returns the context of a request that is sent for the first time. */
  static CallContext context(String memory, ByteString lease, Instant notAfter) {
    return CallContext.newBuilder()
        .setRequestId(UUID.randomUUID().toString())
        .setRequestMemory(memory)
        .setLeaseToken(lease)
        .setNotAfter(Times.message(notAfter))
        .build();
  }

  /** Returns the request with its context, which is the field of that name. */
  @SuppressWarnings("unchecked") // The builder of a message builds the same message.
  static <Q extends Message> Q withContext(Q request, CallContext context) {
    var field = request.getDescriptorForType().findFieldByName("context");
    return (Q) request.toBuilder().setField(field, context).build();
  }

  /**
   * Returns by how much the daemon's clock is ahead of this machine's, just after the devices were
   * listed. 0 if nothing was read from any device yet.
   */
  static Duration clockAhead(List<Device> devices, Instant now) {
    return devices.stream()
        .filter(device -> device.hasReadTime() && device.hasAge())
        .findFirst()
        .map(
            device ->
                Duration.between(
                    now, Times.instant(device.getReadTime()).plus(Times.duration(device.getAge()))))
        .orElse(Duration.ZERO);
  }

  /** Returns the device with the capability and the name, or the only one if the name is empty. */
  static Device choose(List<Device> devices, Capability capability, String name) {
    List<Device> able =
        devices.stream()
            .filter(device -> device.getCapabilitiesList().contains(capability))
            .filter(device -> name.isEmpty() || device.getName().equals(Names.resource(name)))
            .toList();
    if (able.size() == 1) {
      return able.get(0);
    }
    String all =
        devices.stream()
            .map(device -> Names.device(device.getName()))
            .collect(Collectors.joining(", "));
    if (able.isEmpty()) {
      throw new IllegalArgumentException(
          "the daemon has no such device"
              + (name.isEmpty() ? "" : ": " + name)
              + "; its devices: "
              + all);
    }
    throw new IllegalArgumentException(
        "the daemon has several such devices; choose one of these by device(name): " + all);
  }

  /** Returns a move without its context. */
  static MoveRequest move(
      String device, Map<String, Distance> targets, boolean relative, MoveOption... options) {
    if (targets.isEmpty()) {
      throw new IllegalArgumentException("a move needs at least one axis");
    }
    MoveRequest.Builder request = MoveRequest.newBuilder().setDevice(device).setRelative(relative);
    new TreeMap<>(targets)
        .forEach((axis, distance) -> request.addTargets(target(axis, distance, options)));
    return request.build();
  }

  private static AxisTarget target(String axis, Distance distance, MoveOption... options) {
    AxisTarget.Builder target =
        AxisTarget.newBuilder().setAxis(axis).setDistance(Distance.message(distance));
    for (MoveOption option : options) {
      option.addTo(target);
    }
    return target.build();
  }

  static AxisJog jog(String axis, Speed speed) {
    Speed size = speed.isNegative() ? speed.negate() : speed;
    return AxisJog.newBuilder()
        .setAxis(axis)
        .setDirection(
            speed.isNegative()
                ? AxisJog.Direction.DIRECTION_MINUS
                : AxisJog.Direction.DIRECTION_PLUS)
        .setSpeed(Speed.message(size))
        .build();
  }
}
