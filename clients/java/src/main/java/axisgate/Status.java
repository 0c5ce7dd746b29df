package axisgate;

import axisgate.v1.LinkState;
import axisgate.v1.Mode;
import java.util.List;
import java.util.Optional;

/**
 * A Status is the state of a stage. Axes that the controller does not allow to be moved are left
 * out.
 *
 * @param device name of the device
 * @param link "UP" if the controller answers
 * @param linkProblem reason why the controller does not answer; empty if it does
 * @param mode mode of the controller: "HOST"
 * @param axes axes in the order of their numbers
 * @param message whole state, as the API's message
 */
public record Status(
    String device,
    String link,
    String linkProblem,
    String mode,
    List<AxisState> axes,
    axisgate.v1.Device message) {

  static Status of(axisgate.v1.Device device) {
    return new Status(
        Names.device(device.getName()),
        Names.enumName(LinkState.getDescriptor(), device.getLinkValue(), "LINK_STATE_"),
        device.getLinkProblem(),
        Names.enumName(Mode.getDescriptor(), device.getModeValue(), "MODE_"),
        device.getAxesList().stream()
            .filter(axisgate.v1.Axis::getControllable)
            .map(AxisState::of)
            .toList(),
        device);
  }

  /**
   * Returns the state of an axis.
   *
   * @param name name of the axis
   * @return the state; empty if there is no such axis
   */
  public Optional<AxisState> axis(String name) {
    return axes.stream().filter(axis -> axis.name().equals(name)).findFirst();
  }

  // Returns the axes. Throws Unavailable while they are unknown, because the controller has not
  // answered yet.
  List<AxisState> knownAxes() {
    if (!axes.isEmpty()) {
      return axes;
    }
    throw new Unavailable(
        Problem.of(
            "LINK_DOWN",
            "the axes of "
                + device
                + " are unknown: "
                + (linkProblem.isEmpty() ? "the controller is read" : linkProblem),
            "wait until the controller answers",
            ""));
  }

  /** Returns the state of the link and the positions. */
  @Override
  public String toString() {
    String shown =
        linkProblem.isEmpty()
            ? Result.joined(axes.stream().map(AxisState::position).toList())
            : linkProblem;
    return device + " " + link + ": " + shown;
  }
}
