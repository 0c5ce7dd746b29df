package axisgate;

import java.util.Optional;

/**
 * An AxisStop is the result of a stop for one axis.
 *
 * @param position position that was seen after the stop
 * @param stationary true if the axis is stationary. Empty: the axis was not seen after the stop
 */
public record AxisStop(Position position, Optional<Boolean> stationary) {
  static AxisStop of(axisgate.v1.AxisStop stop) {
    Position position =
        new Position(
            Names.axis(stop.getName(), stop.getAxis()),
            stop.getPosition(),
            Unit.symbolOf(stop.getUnitValue()),
            ScanResult.known(stop.hasPositionPulses(), stop.getPositionPulses()));
    return new AxisStop(
        position, stop.hasReady() ? Optional.of(stop.getReady()) : Optional.empty());
  }

  /** Returns the position, and whether the axis is stationary. */
  @Override
  public String toString() {
    String state =
        stationary.map(is -> is ? "stationary" : "still moving").orElse("not seen stationary");
    return position + " (" + state + ")";
  }
}
