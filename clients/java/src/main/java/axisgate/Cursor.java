package axisgate;

import axisgate.v1.ListDevicesResponse;
import axisgate.v1.WatchRequest;
import java.util.Optional;

/** A Cursor knows the first event that a watcher has not received yet. Not thread safe. */
final class Cursor {
  private final WatchRequest.Builder next;

  private Cursor(String device) {
    next = WatchRequest.newBuilder().setDevice(device);
  }

  /** Returns a cursor after all events up to the listing of the devices. */
  static Cursor fromNow(String device, ListDevicesResponse listed) {
    Cursor cursor = from(device, listed.getNextRevision());
    cursor.next.setRun(listed.getRun());
    return cursor;
  }

  /** Returns a cursor before an event. Revision 0: all kept events. */
  static Cursor from(String device, long revision) {
    Cursor cursor = new Cursor(device);
    cursor.next.setFromRevision(revision);
    return cursor;
  }

  static Cursor after(String device, axisgate.v1.Event event) {
    Cursor cursor = new Cursor(device);
    cursor.take(event);
    return cursor;
  }

  WatchRequest request() {
    return next.build();
  }

  /** Moves past an event. */
  void take(axisgate.v1.Event event) {
    next.setFromRevision(event.getRevision() + 1).setRun(event.getRun());
  }

  /**
   * Returns the gap that the failure reports, and moves to its end. Empty: the failure is another
   * one.
   */
  Optional<Gap> gapAfter(Failure failure) {
    if (!failure.reason().equals("COMPACTED")) {
      return Optional.empty();
    }
    String resume = failure.problem().getMetadataOrDefault("resume_revision", "");
    if (resume.isEmpty()) {
      return Optional.empty();
    }
    long revision = Long.parseUnsignedLong(resume);
    next.setFromRevision(revision).setRun("");
    return Optional.of(new Gap(revision));
  }
}
