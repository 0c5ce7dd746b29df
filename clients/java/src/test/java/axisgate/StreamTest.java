package axisgate;

import static axisgate.Units.mm;
import static axisgate.Units.um;
import static org.junit.jupiter.api.Assertions.assertEquals;
import static org.junit.jupiter.api.Assertions.assertFalse;
import static org.junit.jupiter.api.Assertions.assertThrows;
import static org.junit.jupiter.api.Assertions.assertTrue;

import axisgate.v1.AxisSettings;
import axisgate.v1.MotionState;
import axisgate.v1.Settings;
import java.io.IOException;
import java.time.Duration;
import java.util.List;
import java.util.NoSuchElementException;
import java.util.concurrent.CompletableFuture;
import java.util.stream.IntStream;
import org.junit.jupiter.api.Test;

/** Paths, places, settings, states and events, with the real daemon. */
class StreamTest {
  @Test
  void paths() throws IOException {
    try (var daemon = new TestDaemon()) {
      Stage stage = daemon.open();
      List<List<Distance>> diagonal =
          IntStream.rangeClosed(1, 10).mapToObj(i -> List.of(um(100 * i), um(50 * i))).toList();
      StagePath path = new StagePath(List.of("x", "y"), diagonal).withSpeed(mm(0.5).perSecond());
      Motion motion = stage.path(path);
      for (Progress progress : motion.progress(Duration.ofMillis(50))) {
        assertTrue(progress.fraction().getAsDouble() >= 0);
        assertEquals(2, progress.positions().size());
      }
      assertEquals("x 1 mm, y 0.5 mm", motion.await().toString());
      StagePath outside = new StagePath(path.axes(), List.of(List.of(mm(20), mm(1))), path.speed());
      assertThrows(OutsideTravel.class, () -> stage.path(outside));
      StagePath shorter = new StagePath(path.axes(), List.of(List.of(mm(1))));
      assertThrows(IllegalArgumentException.class, () -> stage.path(shorter));

      Scan scan = new Scan("x", mm(0), mm(1), um(100)).withSpeed(mm(0.2).perSecond());
      var pulses = stage.scan(scan).await().scan().orElseThrow();
      assertEquals(11, pulses.expectedInRange().getAsLong());
      assertEquals(pulses.expected(), pulses.observed());
      assertEquals(List.of("OK", "OK"), stage.execute("M:1+P1000", "G:1").answers());
    }
  }

  @Test
  void placesAndSettings() throws IOException {
    try (var daemon = new TestDaemon()) {
      Stage stage = daemon.open();
      int visited = 0;
      for (Result at :
          stage.visit(new StagePath(List.of("x"), List.of(List.of(mm(0.1)), List.of(mm(0.2)))))) {
        visited += at.positions().size();
      }
      assertEquals(2, visited);
      Places places = stage.places();
      places.save("sample");
      stage.axis("x").moveTo(mm(1));
      assertEquals("x 0.2 mm", places.moveTo("sample").positions().get(0).toString());
      assertEquals("x 0.2 mm", places.list().get("sample").get(0).toString());
      places.delete("sample");
      assertThrows(Refused.class, () -> places.delete("sample"));

      var off = AxisSettings.newBuilder().setAxis("x").setExcited(false);
      stage.changeSettings(Settings.newBuilder().addAxes(off).build());
      assertFalse(stage.settings().getAxes(0).getExcited());
      var refused = assertThrows(Refused.class, () -> stage.axis("x").moveTo(mm(1)));
      assertEquals("NOT_EXCITED", refused.reason());
    }
  }

  @Test
  void events() throws IOException {
    try (var daemon = new TestDaemon();
        var relay = new TestRelay(daemon)) {
      Stage stage = daemon.open(relay.options());
      try (var states = stage.watch(Duration.ZERO)) {
        assertEquals("UP", states.next().link());
      }
      try (var events = stage.eventsFrom(0)) {
        Event first = moved(daemon.open(), events, null);
        relay.cutAnswers(1, 1);
        Event second = moved(daemon.open(), events, first);
        daemon.kill();
        daemon.start();
        moved(daemon.open(), events, second);
        try (var again = stage.eventsAfter(first)) {
          assertEquals(first.revision() + 1, ((Event) again.next()).revision());
        }
      }
    }
  }

  /** Moves, and returns the event of its success, which must come after {@code last}. */
  private static Event moved(Stage direct, Updates<EventOrGap> events, Event last) {
    direct.axis("x").moveTo(mm(1));
    long after = last == null ? 0 : last.revision();
    for (EventOrGap item : events) {
      Event event = (Event) item;
      assertTrue(event.revision() > after);
      if (event.message().getMotion().getState() == MotionState.MOTION_STATE_SUCCEEDED) {
        return event;
      }
    }
    throw new NoSuchElementException("the events have ended");
  }

  @Test
  void closedSeriesEndsForItsReader() throws IOException {
    try (var daemon = new TestDaemon()) {
      var events = daemon.open().events();
      var reading = CompletableFuture.supplyAsync(events::hasNext);
      events.close();
      assertFalse(reading.join());
      assertThrows(NoSuchElementException.class, events::next);
    }
  }
}
