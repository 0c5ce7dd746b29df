package axisgate;

import java.util.OptionalLong;

/**
 * A ScanResult has the numbers of trigger pulses of a scan. Empty means unknown.
 *
 * @param expected number of pulses due in the whole run
 * @param expectedInRange number of pulses due within the range
 * @param observed number of pulses computed from the displacement
 */
public record ScanResult(
    OptionalLong expected, OptionalLong expectedInRange, OptionalLong observed) {
  static ScanResult of(axisgate.v1.Scan scan) {
    return new ScanResult(
        known(scan.hasExpectedTriggers(), scan.getExpectedTriggers()),
        known(scan.hasExpectedTriggersInRange(), scan.getExpectedTriggersInRange()),
        known(scan.hasObservedTriggers(), scan.getObservedTriggers()));
  }

  static OptionalLong known(boolean isKnown, long value) {
    return isKnown ? OptionalLong.of(value) : OptionalLong.empty();
  }
}
