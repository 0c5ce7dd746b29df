package axisgate;

import java.time.Instant;
import java.util.Locale;

/**
 * An Event is one fact about a device or the daemon.
 *
 * @param revision number of the event, ascending over all devices and over restarts
 * @param time time of the event by the daemon's clock
 * @param device name of the device. Empty: an event of the daemon itself
 * @param kind name of the fact, such as "motion", "stop_requested" or "condition". Empty for a fact
 *     of a newer daemon
 * @param message event as the API's message, which has the fact
 */
public record Event(
    long revision, Instant time, String device, String kind, axisgate.v1.Event message)
    implements EventOrGap {
  static Event of(axisgate.v1.Event event) {
    var fact = event.getFactCase();
    return new Event(
        event.getRevision(),
        Times.instant(event.getTime()),
        Names.device(event.getDevice()),
        fact == axisgate.v1.Event.FactCase.FACT_NOT_SET ? "" : fact.name().toLowerCase(Locale.ROOT),
        event);
  }
}
