package axisgate;

import java.util.Objects;

/**
 * A Speed is a distance for each second, made by {@link Distance#perSecond}. It is immutable. A jog
 * in the minus direction has a negative speed.
 */
public final class Speed {
  private final Amount amount;

  Speed(Amount amount) {
    this.amount = amount;
  }

  /**
   * Returns the speed in the opposite direction.
   *
   * @return the opposite speed
   */
  public Speed negate() {
    return new Speed(amount.negate());
  }

  boolean isNegative() {
    return amount.isNegative();
  }

  /** Returns the API's message. Throws NullPointerException if there is no speed. */
  static axisgate.v1.Speed message(Speed speed) {
    Objects.requireNonNull(speed, "a speed is missing: write it as mm(2).perSecond()");
    Amount amount = speed.amount;
    var message = axisgate.v1.Speed.newBuilder();
    if (!amount.isExact()) {
      return message.setFloating(amount.floatingMessage()).build();
    }
    switch (amount.unit()) {
      case NANOMETERS -> message.setNmPerS(amount.text());
      case MICROMETERS -> message.setUmPerS(amount.text());
      case MILLIMETERS -> message.setMmPerS(amount.text());
      case DEGREES -> message.setDegreesPerS(amount.text());
      case PULSES -> message.setPulsesPerS(amount.pulses());
    }
    return message.build();
  }

  @Override
  public boolean equals(Object other) {
    return other instanceof Speed speed && amount.equals(speed.amount);
  }

  @Override
  public int hashCode() {
    return amount.hashCode();
  }

  /** Returns the number with its unit: "1.5 mm/s". */
  @Override
  public String toString() {
    return amount + "/s";
  }
}
