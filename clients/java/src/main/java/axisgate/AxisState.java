package axisgate;

import axisgate.v1.Condition;
import java.util.List;
import java.util.Optional;

/**
 * An AxisState is the state of one axis. Empty means unknown; a limit that is empty does not exist.
 *
 * @param number number of the axis, from 1
 * @param name name from the configuration, or the number as text
 * @param position position as last read
 * @param moving true if the axis moves
 * @param motorOn true if the motor has current
 * @param homed true if the daemon has homed the axis
 * @param minimum lower travel limit
 * @param maximum upper travel limit
 * @param conditions names of the present conditions, such as "CW_LIMIT"
 */
public record AxisState(
    int number,
    String name,
    Position position,
    Optional<Boolean> moving,
    Optional<Boolean> motorOn,
    boolean homed,
    Optional<Distance> minimum,
    Optional<Distance> maximum,
    List<String> conditions) {

  static AxisState of(axisgate.v1.Axis axis) {
    String name = Names.axis(axis.getName(), axis.getNumber());
    Position position =
        new Position(
            name,
            axis.getPosition(),
            Unit.symbolOf(axis.getUnitValue()),
            ScanResult.known(axis.hasPositionPulses(), axis.getPositionPulses()));
    return new AxisState(
        axis.getNumber(),
        name,
        position,
        axis.hasBusy() ? Optional.of(axis.getBusy()) : Optional.empty(),
        axis.hasExcited() ? Optional.of(axis.getExcited()) : Optional.empty(),
        axis.getHomed(),
        Distance.of(axis.getTravelMinimum()),
        Distance.of(axis.getTravelMaximum()),
        axis.getConditionsValueList().stream().map(AxisState::conditionName).toList());
  }

  private static String conditionName(int number) {
    return Names.enumName(Condition.getDescriptor(), number, "CONDITION_");
  }
}
