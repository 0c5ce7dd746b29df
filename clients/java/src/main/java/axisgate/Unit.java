package axisgate;

/** Units of distances. */
enum Unit {
  PULSES("pulses", axisgate.v1.Unit.UNIT_PULSES),
  NANOMETERS("nm", axisgate.v1.Unit.UNIT_NANOMETERS),
  MICROMETERS("um", axisgate.v1.Unit.UNIT_MICROMETERS),
  MILLIMETERS("mm", axisgate.v1.Unit.UNIT_MILLIMETERS),
  DEGREES("deg", axisgate.v1.Unit.UNIT_DEGREES);

  final String symbol;
  final axisgate.v1.Unit message;

  Unit(String symbol, axisgate.v1.Unit message) {
    this.symbol = symbol;
    this.message = message;
  }

  /** Returns the symbol of a unit of the API, or "UNIT 9" for a unit of a newer daemon. */
  static String symbolOf(int number) {
    for (Unit unit : values()) {
      if (unit.message.getNumber() == number) {
        return unit.symbol;
      }
    }
    return "UNIT " + number;
  }
}
