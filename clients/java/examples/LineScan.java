import static axisgate.Units.mm;
import static axisgate.Units.um;

import axisgate.Scan;
import axisgate.Stage;

/**
 * Runs the axis x of the local stage over 2 mm, with a trigger pulse every 10 um, and prints the
 * numbers of pulses.
 */
final class LineScan {
  private LineScan() {}

  public static void main(String[] arguments) {
    try (var stage = Stage.open()) {
      var scan = new Scan("x", mm(0), mm(2), um(10)).withSpeed(um(200).perSecond());
      var pulses = stage.scan(scan).await().scan().orElseThrow();
      if (pulses.observed().isPresent() && pulses.expected().isPresent()) {
        System.out.println(
            pulses.observed().getAsLong() + " of " + pulses.expected().getAsLong() + " pulses");
      }
    }
  }
}
