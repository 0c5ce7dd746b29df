package axisgate;

import axisgate.v1.AxisResult;
import java.time.Duration;
import java.util.List;
import java.util.Optional;
import java.util.stream.Collectors;

/**
 * A Result is the result of a motion that succeeded.
 *
 * @param motion name of the motion
 * @param positions final positions, in the order of the axes' numbers
 * @param duration time from the start to the outcome
 * @param scan result of a scan. Empty: the motion was no scan
 */
public record Result(
    String motion, List<Position> positions, Duration duration, Optional<ScanResult> scan) {
  /** Result of a motion that was not necessary. */
  static final Result NONE = new Result("", List.of(), Duration.ZERO, Optional.empty());

  static Result of(axisgate.v1.Motion motion) {
    var began = motion.hasStartTime() ? motion.getStartTime() : motion.getCreateTime();
    return new Result(
        motion.getName(),
        motion.getResultsList().stream().map(Result::positionOf).toList(),
        Duration.between(Times.instant(began), Times.instant(motion.getEndTime())),
        motion.hasScan() ? Optional.of(ScanResult.of(motion.getScan())) : Optional.empty());
  }

  private static Position positionOf(AxisResult result) {
    return new Position(
        Names.axis(result.getName(), result.getAxis()),
        result.getPosition(),
        Unit.symbolOf(result.getUnitValue()),
        ScanResult.known(result.hasCommandPulses(), result.getCommandPulses()));
  }

  /**
   * Returns the final position of an axis.
   *
   * @param axis name of the axis
   * @return the position; empty if the motion does not have this axis
   */
  public Optional<Position> position(String axis) {
    return positions.stream().filter(position -> position.axis().equals(axis)).findFirst();
  }

  /** Returns the positions: "x 1.5 mm, y -0.25 mm". */
  @Override
  public String toString() {
    return joined(positions);
  }

  static String joined(List<?> items) {
    return items.stream().map(Object::toString).collect(Collectors.joining(", "));
  }
}
