package axisgate;

import java.util.OptionalDouble;
import java.util.OptionalLong;

/**
 * A Position is the position of one axis.
 *
 * @param axis name of the axis, or its number as text
 * @param value position in {@code unit} as an exact decimal: "-0.25". Empty if unknown
 * @param unit symbol of the axis's unit: "mm"
 * @param pulses position in drive pulses. Empty if unknown
 */
public record Position(String axis, String value, String unit, OptionalLong pulses) {
  /**
   * Returns the value as a floating-point number.
   *
   * @return the value; empty if unknown
   */
  public OptionalDouble toDouble() {
    return value.isEmpty() ? OptionalDouble.empty() : OptionalDouble.of(Double.parseDouble(value));
  }

  /** Returns the position with the name of its axis: "x 1.5 mm". */
  @Override
  public String toString() {
    return axis + " " + (value.isEmpty() ? "unknown" : value + " " + unit);
  }
}
