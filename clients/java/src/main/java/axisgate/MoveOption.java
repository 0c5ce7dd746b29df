package axisgate;

import axisgate.v1.AxisTarget;
import axisgate.v1.Profile;
import java.util.function.Consumer;

/** A MoveOption is a term of a move, for all its axes. It is immutable. */
public final class MoveOption {
  private final Consumer<AxisTarget.Builder> term;

  private MoveOption(Consumer<AxisTarget.Builder> term) {
    this.term = term;
  }

  /**
   * Sets the highest speed of the move. Without it: the present speed profile of the axis.
   *
   * @param speed highest speed
   * @return the option
   */
  public static MoveOption speed(Speed speed) {
    Profile profile = Profile.newBuilder().setMaximum(Speed.message(speed)).build();
    return new MoveOption(target -> target.setProfile(profile));
  }

  /**
   * Sets the displacement of the last part of the move, whose direction is then always the same, so
   * that backlash does not matter. Without it, the axis moves directly.
   *
   * @param displacement displacement of the last part
   * @return the option
   */
  public static MoveOption approach(Distance displacement) {
    var message = Distance.message(displacement);
    return new MoveOption(target -> target.setApproach(message));
  }

  void addTo(AxisTarget.Builder target) {
    term.accept(target);
  }
}
