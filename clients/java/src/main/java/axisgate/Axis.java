package axisgate;

import java.time.Duration;
import java.util.Map;

/** An Axis is one axis of a {@link Stage}. Thread safe. */
public final class Axis {
  private final Stage stage;
  private final String name;
  private final int number;
  private final String unit;

  Axis(Stage stage, AxisState state) {
    this.stage = stage;
    name = state.name();
    number = state.number();
    unit = state.position().unit();
  }

  /**
   * Returns the name from the configuration, or the number as text.
   *
   * @return the name
   */
  public String name() {
    return name;
  }

  /**
   * Returns the number of the axis, from 1.
   *
   * @return the number
   */
  public int number() {
    return number;
  }

  /**
   * Returns the symbol of the unit in which positions of the axis are shown: "mm".
   *
   * @return the unit
   */
  public String unit() {
    return unit;
  }

  boolean is(String other) {
    return other.equals(name) || other.equals(Integer.toString(number));
  }

  /**
   * Reads the present state of the axis from the controller.
   *
   * @return the state
   */
  public AxisState state() {
    return stage
        .status(Duration.ZERO)
        .axis(name)
        .orElseThrow(() -> new IllegalStateException("the stage no longer has the axis " + name));
  }

  /**
   * Reads the present position of the axis from the controller.
   *
   * @return the position
   */
  public Position position() {
    return state().position();
  }

  /**
   * Starts a move to a position.
   *
   * @param target position
   * @param options terms of the move
   * @return the motion
   */
  public Motion start(Distance target, MoveOption... options) {
    return stage.start(only(target), options);
  }

  /**
   * Starts a move by a displacement from the present position.
   *
   * @param displacement displacement
   * @param options terms of the move
   * @return the motion
   */
  public Motion startBy(Distance displacement, MoveOption... options) {
    return stage.startBy(only(displacement), options);
  }

  /**
   * Moves the axis to a position, and waits for the outcome. An interruption of the thread cancels
   * the move.
   *
   * @param target position
   * @param options terms of the move
   * @return the result
   * @throws Refused if nothing moved
   * @throws Stopped if a stop ended the move
   * @throws MotionFailed if the move ended with an error
   * @throws OutcomeUnknown if the outcome could not be seen
   * @throws Interrupted if the thread is interrupted
   */
  public Result moveTo(Distance target, MoveOption... options) {
    return stage.moveTo(only(target), options);
  }

  /**
   * Does the same as {@link #moveTo} with a displacement from the present position.
   *
   * @param displacement displacement
   * @param options terms of the move
   * @return the result
   */
  public Result moveBy(Distance displacement, MoveOption... options) {
    return stage.moveBy(only(displacement), options);
  }

  /**
   * Homes the axis, and waits for the outcome. An interruption of the thread cancels the motion.
   *
   * @return the result
   */
  public Result home() {
    return stage.home(name);
  }

  /**
   * Stops the axis. See {@link Stage#stop}.
   *
   * @return what was seen
   */
  public StopReport stop() {
    return stage.stop(name);
  }

  private Map<String, Distance> only(Distance distance) {
    Distance.message(distance);
    return Map.of(name, distance);
  }

  /** Returns the name of the axis. */
  @Override
  public String toString() {
    return name;
  }
}
