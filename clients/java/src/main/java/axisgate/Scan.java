package axisgate;

import axisgate.v1.ScanRequest;
import java.util.Optional;

/**
 * A Scan is a run of one axis at constant speed, with trigger pulses at equal intervals.
 *
 * @param axis name or number of the axis
 * @param start beginning of the range, on which one pulse falls
 * @param end end of the range
 * @param every interval of the pulses
 * @param speed speed in the range. Empty: the present speed of the axis
 */
public record Scan(
    String axis, Distance start, Distance end, Distance every, Optional<Speed> speed) {

  /**
   * Makes a scan with the present speed of the axis.
   *
   * @param axis name or number of the axis
   * @param start beginning of the range, on which one pulse falls
   * @param end end of the range
   * @param every interval of the pulses
   */
  public Scan(String axis, Distance start, Distance end, Distance every) {
    this(axis, start, end, every, Optional.empty());
  }

  /**
   * Returns the same scan with a speed.
   *
   * @param speed speed in the range
   * @return the scan
   */
  public Scan withSpeed(Speed speed) {
    return new Scan(axis, start, end, every, Optional.of(speed));
  }

  ScanRequest request(String device) {
    ScanRequest.Builder request =
        ScanRequest.newBuilder()
            .setDevice(device)
            .setAxis(axis)
            .setStart(Distance.message(start))
            .setEnd(Distance.message(end))
            .setDistance(Distance.message(every));
    speed.ifPresent(given -> request.setSpeed(Speed.message(given)));
    return request.build();
  }
}
