package axisgate;

import java.util.Objects;
import java.util.Optional;

/** A Distance is a position or a displacement, made by {@link Units}. It is immutable. */
public final class Distance {
  private final Amount amount;

  Distance(Amount amount) {
    this.amount = amount;
  }

  /**
   * Returns the speed of this distance in each second.
   *
   * @return the speed
   */
  public Speed perSecond() {
    return new Speed(amount);
  }

  /**
   * Returns the opposite distance.
   *
   * @return the opposite distance
   */
  public Distance negate() {
    return new Distance(amount.negate());
  }

  /** Returns the API's message. Throws NullPointerException if there is no distance. */
  static axisgate.v1.Distance message(Distance distance) {
    Objects.requireNonNull(distance, "a distance is missing: write it as mm(\"1.5\")");
    Amount amount = distance.amount;
    var message = axisgate.v1.Distance.newBuilder();
    if (!amount.isExact()) {
      return message.setFloating(amount.floatingMessage()).build();
    }
    switch (amount.unit()) {
      case NANOMETERS -> message.setNm(amount.text());
      case MICROMETERS -> message.setUm(amount.text());
      case MILLIMETERS -> message.setMm(amount.text());
      case DEGREES -> message.setDegrees(amount.text());
      case PULSES -> message.setPulses(amount.pulses());
    }
    return message.build();
  }

  /** Returns a distance of the API. Empty: it has no amount that this package knows. */
  static Optional<Distance> of(axisgate.v1.Distance message) {
    return switch (message.getAmountCase()) {
      case PULSES -> Optional.of(Units.pulses(message.getPulses()));
      case NM -> Optional.of(Units.nm(message.getNm()));
      case UM -> Optional.of(Units.um(message.getUm()));
      case MM -> Optional.of(Units.mm(message.getMm()));
      case DEGREES -> Optional.of(Units.deg(message.getDegrees()));
      case FLOATING, AMOUNT_NOT_SET -> Optional.empty();
    };
  }

  @Override
  public boolean equals(Object other) {
    return other instanceof Distance distance && amount.equals(distance.amount);
  }

  @Override
  public int hashCode() {
    return amount.hashCode();
  }

  /** Returns the number with its unit: "1.5 mm". */
  @Override
  public String toString() {
    return amount.toString();
  }
}
