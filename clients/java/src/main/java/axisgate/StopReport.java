package axisgate;

import axisgate.v1.DeviceStop;
import java.util.List;
import java.util.Optional;

/**
 * A StopReport is what was seen of a stop.
 *
 * @param axes results of the axes, in the order of their numbers
 * @param staysOpen true if the axes were not confirmed stationary. The daemon then repeats the
 *     stop, and refuses motion of these axes
 * @param problem reason why. Empty: no problem
 */
public record StopReport(List<AxisStop> axes, boolean staysOpen, Optional<Problem> problem) {
  static StopReport of(List<DeviceStop> devices, boolean staysOpen) {
    return new StopReport(
        devices.stream()
            .flatMap(device -> device.getAxesList().stream())
            .map(AxisStop::of)
            .toList(),
        staysOpen,
        devices.stream()
            .filter(DeviceStop::hasProblem)
            .findFirst()
            .map(device -> Outcomes.problemOf(device.getProblem(), "")));
  }

  /** Returns the results of the axes, and the problem. */
  @Override
  public String toString() {
    return Result.joined(axes)
        + (staysOpen ? "; the stop stays open" : "")
        + problem.map(found -> ": " + found).orElse("");
  }
}
