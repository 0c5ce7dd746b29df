package axisgate;

import java.math.BigDecimal;

/**
 * Distances from numbers with units, for {@code import static axisgate.Units.*}.
 *
 * <p>A text, a {@code long} and a {@link BigDecimal} are exact: the daemon refuses an amount that
 * is not a whole number of pulses. A {@code double} becomes the nearest whole number of pulses, and
 * the result of the motion says which. Every function throws {@link IllegalArgumentException} for a
 * text that is not a decimal number, and for a number that is not finite.
 */
public final class Units {
  private Units() {}

  /**
   * Returns an exact distance in millimetres.
   *
   * @param number number of the distance
   * @return the distance
   */
  public static Distance mm(String number) {
    return new Distance(Amount.exact(number, Unit.MILLIMETERS));
  }

  /**
   * Returns an exact distance in millimetres.
   *
   * @param number number of the distance
   * @return the distance
   */
  public static Distance mm(long number) {
    return new Distance(Amount.exact(Long.toString(number), Unit.MILLIMETERS));
  }

  /**
   * Returns an exact distance in millimetres.
   *
   * @param number number of the distance
   * @return the distance
   */
  public static Distance mm(BigDecimal number) {
    return new Distance(Amount.exact(number.toString(), Unit.MILLIMETERS));
  }

  /**
   * Returns a rounded distance in millimetres.
   *
   * @param number number of the distance
   * @return the distance
   */
  public static Distance mm(double number) {
    return new Distance(Amount.nearest(number, Unit.MILLIMETERS));
  }

  /**
   * Returns an exact distance in micrometres.
   *
   * @param number number of the distance
   * @return the distance
   */
  public static Distance um(String number) {
    return new Distance(Amount.exact(number, Unit.MICROMETERS));
  }

  /**
   * Returns an exact distance in micrometres.
   *
   * @param number number of the distance
   * @return the distance
   */
  public static Distance um(long number) {
    return new Distance(Amount.exact(Long.toString(number), Unit.MICROMETERS));
  }

  /**
   * Returns an exact distance in micrometres.
   *
   * @param number number of the distance
   * @return the distance
   */
  public static Distance um(BigDecimal number) {
    return new Distance(Amount.exact(number.toString(), Unit.MICROMETERS));
  }

  /**
   * Returns a rounded distance in micrometres.
   *
   * @param number number of the distance
   * @return the distance
   */
  public static Distance um(double number) {
    return new Distance(Amount.nearest(number, Unit.MICROMETERS));
  }

  /**
   * Returns an exact distance in nanometres.
   *
   * @param number number of the distance
   * @return the distance
   */
  public static Distance nm(String number) {
    return new Distance(Amount.exact(number, Unit.NANOMETERS));
  }

  /**
   * Returns an exact distance in nanometres.
   *
   * @param number number of the distance
   * @return the distance
   */
  public static Distance nm(long number) {
    return new Distance(Amount.exact(Long.toString(number), Unit.NANOMETERS));
  }

  /**
   * Returns an exact distance in nanometres.
   *
   * @param number number of the distance
   * @return the distance
   */
  public static Distance nm(BigDecimal number) {
    return new Distance(Amount.exact(number.toString(), Unit.NANOMETERS));
  }

  /**
   * Returns a rounded distance in nanometres.
   *
   * @param number number of the distance
   * @return the distance
   */
  public static Distance nm(double number) {
    return new Distance(Amount.nearest(number, Unit.NANOMETERS));
  }

  /**
   * Returns an exact distance in degrees, for a rotary axis.
   *
   * @param number number of the distance
   * @return the distance
   */
  public static Distance deg(String number) {
    return new Distance(Amount.exact(number, Unit.DEGREES));
  }

  /**
   * Returns an exact distance in degrees, for a rotary axis.
   *
   * @param number number of the distance
   * @return the distance
   */
  public static Distance deg(long number) {
    return new Distance(Amount.exact(Long.toString(number), Unit.DEGREES));
  }

  /**
   * Returns an exact distance in degrees, for a rotary axis.
   *
   * @param number number of the distance
   * @return the distance
   */
  public static Distance deg(BigDecimal number) {
    return new Distance(Amount.exact(number.toString(), Unit.DEGREES));
  }

  /**
   * Returns a rounded distance in degrees, for a rotary axis.
   *
   * @param number number of the distance
   * @return the distance
   */
  public static Distance deg(double number) {
    return new Distance(Amount.nearest(number, Unit.DEGREES));
  }

  /**
   * Returns a distance in drive pulses, the smallest step of an axis.
   *
   * @param number number of pulses
   * @return the distance
   */
  public static Distance pulses(long number) {
    return new Distance(Amount.exact(Long.toString(number), Unit.PULSES));
  }
}
