package axisgate;

import axisgate.v1.FloatingAmount;
import axisgate.v1.Rounding;
import java.util.regex.Pattern;

/**
 * An Amount is a number with its unit: an exact text, or a floating-point number if {@code text} is
 * null.
 */
record Amount(String text, double floating, Unit unit) {
  private static final Pattern DECIMAL =
      Pattern.compile("[+-]?([0-9]+\\.?[0-9]*|\\.[0-9]+)([eE][+-]?[0-9]+)?");

  static Amount exact(String number, Unit unit) {
    String text = number.strip();
    if (!DECIMAL.matcher(text).matches()) {
      throw new IllegalArgumentException("\"" + number + "\" is not a decimal number");
    }
    if (unit == Unit.PULSES) {
      text = wholePulses(text);
    }
    return new Amount(text, 0, unit);
  }

  static Amount nearest(double number, Unit unit) {
    if (!Double.isFinite(number)) {
      throw new IllegalArgumentException(number + " is not an amount: it must be finite");
    }
    return new Amount(null, number, unit);
  }

  private static String wholePulses(String text) {
    try {
      return Long.toString(Long.parseLong(text));
    } catch (NumberFormatException e) {
      throw new IllegalArgumentException(text + " is not a whole number of pulses", e);
    }
  }

  boolean isExact() {
    return text != null;
  }

  boolean isNegative() {
    return isExact() ? text.startsWith("-") : floating < 0;
  }

  Amount negate() {
    if (!isExact()) {
      return new Amount(null, -floating, unit);
    }
    boolean signed = text.startsWith("-") || text.startsWith("+");
    String digits = signed ? text.substring(1) : text;
    return new Amount(isNegative() ? digits : "-" + digits, 0, unit);
  }

  long pulses() {
    return Long.parseLong(text);
  }

  /** Returns the API's message of a floating-point number, which the daemon rounds. */
  FloatingAmount floatingMessage() {
    return FloatingAmount.newBuilder()
        .setValue(floating)
        .setUnit(unit.message)
        .setRounding(Rounding.ROUNDING_NEAREST)
        .build();
  }

  @Override
  public String toString() {
    return (isExact() ? text : Double.toString(floating)) + " " + unit.symbol;
  }
}
