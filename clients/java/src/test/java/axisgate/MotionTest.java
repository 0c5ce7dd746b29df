package axisgate;

import static axisgate.Units.mm;
import static axisgate.Units.pulses;
import static axisgate.Units.um;
import static org.junit.jupiter.api.Assertions.assertEquals;
import static org.junit.jupiter.api.Assertions.assertFalse;
import static org.junit.jupiter.api.Assertions.assertInstanceOf;
import static org.junit.jupiter.api.Assertions.assertThrows;
import static org.junit.jupiter.api.Assertions.assertTrue;

import java.io.IOException;
import java.time.Duration;
import java.util.List;
import java.util.Map;
import java.util.Optional;
import java.util.concurrent.CompletionException;
import org.junit.jupiter.api.Test;

/** Moves and their outcomes, with the real daemon. */
class MotionTest {
  private static Motion started(Stage stage, Distance target) {
    return stage.axis("x").start(target);
  }

  @Test
  void moves() throws IOException {
    try (var daemon = new TestDaemon()) {
      Stage stage = daemon.open();
      Axis x = stage.axis("1");
      assertEquals("x 1.5 mm", x.moveTo(mm("1.5")).toString());
      var options =
          new MoveOption[] {MoveOption.speed(mm(5).perSecond()), MoveOption.approach(um(10))};
      assertEquals("x 1.25 mm", x.moveBy(um(-250), options).toString());
      assertEquals("x 1 mm, y -0.1 mm", stage.moveTo(Map.of("x", mm(1), "y", um(-100))).toString());
      assertEquals(
          "x 1.3 mm, y -0.09995 mm",
          stage.moveBy(Map.of("x", mm(0.1 + 0.2), "y", pulses(5))).toString());
      var refused = assertThrows(Refused.class, () -> x.moveTo(mm("0.123456789")));
      assertEquals("NOT_REPRESENTABLE", refused.reason());
      assertThrows(OutsideTravel.class, () -> x.moveTo(mm(20)));
      assertThrows(OutsideTravel.class, () -> stage.check(Map.of("x", mm(20))));
      stage.check(Map.of("x", mm(1)));
      assertThrows(IllegalArgumentException.class, () -> stage.axis("z"));
      assertEquals("x 1.3 mm", x.position().toString());
      assertEquals(Optional.of(mm("15")), x.state().maximum());
      assertEquals("x 0 mm", x.home().toString());
      assertEquals(List.of(), stage.homeIfNeeded("x").positions());
      assertEquals("y 0 mm, 3 0 um", stage.homeIfNeeded().toString());
      var elsewhere = new ConnectOptions().target(daemon.socket()).device("other");
      assertThrows(IllegalArgumentException.class, () -> Stage.open(elsewhere));
    }
  }

  @Test
  void ends() throws IOException {
    try (var daemon = new TestDaemon()) {
      Stage stage = daemon.open();
      Stage other = daemon.openOther();
      Motion first = started(stage, mm(14));
      assertThrows(WaitTimeout.class, () -> first.await(Duration.ofMillis(200)));
      assertFalse(first.isDone());
      assertEquals("RUNNING", first.state());
      Thread.currentThread().interrupt();
      StopReport report = stage.stop("x"); // although the thread is interrupted
      assertTrue(Thread.interrupted());
      assertFalse(report.staysOpen());
      assertEquals(Optional.of(true), report.axes().get(0).stationary());
      assertThrows(Stopped.class, first::await);

      Motion second = started(stage, mm(14)); // a stop of the same program latches nothing
      second.cancel();
      var stopped =
          assertThrows(CompletionException.class, () -> second.toFuture().join()).getCause();
      assertInstanceOf(Stopped.class, stopped);

      Motion third = started(stage, mm(14));
      other.stop();
      assertThrows(Stopped.class, third::await);
      var latched = assertThrows(StoppedBy.class, () -> started(stage, mm(0)));
      assertTrue(latched.hint().contains("stage.rearm()"), latched.hint());
      assertEquals(List.of(1), stage.rearm());

      Motion fourth = started(stage, mm(14));
      stage.emergencyStop();
      assertThrows(AxisgateException.class, fourth::await);
      var emergency = assertThrows(Refused.class, () -> started(stage, mm(0)));
      assertEquals("EMERGENCY_STOPPED", emergency.reason());
      stage.clearErrors();
    }
  }

  @Test
  void interruptedMoveIsCancelled() throws Exception {
    try (var daemon = new TestDaemon()) {
      Stage stage = daemon.open();
      Thread moving = Thread.currentThread();
      Stage watching = daemon.open();
      Thread interrupting =
          new Thread(
              () -> {
                TestDaemon.until(
                    "a running motion",
                    () -> watching.motions().stream().anyMatch(m -> m.state().equals("RUNNING")));
                moving.interrupt();
              });
      interrupting.start();
      assertThrows(Interrupted.class, () -> stage.axis("x").moveTo(mm(14)));
      assertThrows(Interrupted.class, () -> stage.axis("x").moveTo(mm(14)));
      assertTrue(Thread.interrupted());
      interrupting.join();
      assertEquals(1, stage.motions().size());
      assertThrows(Stopped.class, () -> stage.motions().get(0).await());
    }
  }

  @Test
  void closedStage() throws IOException {
    try (var daemon = new TestDaemon()) {
      Stage stage = daemon.open();
      var outcome = started(stage, mm(14)).toFuture();
      stage.close();
      var error = assertThrows(CompletionException.class, outcome::join).getCause();
      assertInstanceOf(IllegalStateException.class, error);
      assertThrows(IllegalStateException.class, () -> stage.axis("x").moveTo(mm(1)));
    }
  }

  @Test
  void lostAnswers() throws IOException {
    try (var daemon = new TestDaemon();
        var relay = new TestRelay(daemon)) {
      Stage direct = daemon.open();
      Stage stage = daemon.open(relay.options().timeout(Duration.ofSeconds(8)));
      relay.cutAnswers(5, 3); // stream 3, the first of grpc-java, asks for the request memory
      assertEquals("x 1 mm", stage.axis("x").moveBy(mm(1)).toString());
      assertEquals(3, relay.cuts());
      assertEquals(1, direct.motions().size());

      Motion motion = started(stage, mm(10));
      relay.cutAnswers(1, 3);
      assertEquals("x 10 mm", motion.await().toString());

      Stage hasty = daemon.open(relay.options().timeout(Duration.ofSeconds(2)));
      relay.cutAnswers(5, 1000);
      assertThrows(OutcomeUnknown.class, () -> hasty.axis("x").moveBy(mm(-1)));
      assertEquals(3, direct.motions().size());
    }
  }

  @Test
  void lostAnswerWithoutJournal() throws IOException {
    try (var daemon = new TestDaemon(false, "");
        var relay = new TestRelay(daemon)) {
      Stage stage = daemon.open(relay.options());
      relay.cutAnswers(5, 1);
      assertThrows(OutcomeUnknown.class, () -> stage.axis("x").moveBy(mm(1)));
      assertEquals(1, daemon.open().motions().size());
    }
  }

  @Test
  void limitSensor() throws IOException {
    try (var daemon = new TestDaemon()) {
      Motion motion = started(daemon.open(), mm(14));
      daemon.atStage("limit 1 cw on");
      assertEquals("LIMIT_DETECTED", assertThrows(MotionFailed.class, motion::await).reason());
    }
  }

  @Test
  void killedDaemon() throws IOException {
    try (var daemon = new TestDaemon()) {
      var options = new ConnectOptions().target(daemon.socket()).timeout(Duration.ofSeconds(2));
      Stage stage = daemon.open(options);
      Motion motion = started(stage, mm(14));
      daemon.kill();
      assertThrows(Unavailable.class, () -> stage.axis("x").moveTo(mm(1)));
      assertEquals("UNAVAILABLE", assertThrows(OutcomeUnknown.class, stage::stop).reason());
      assertThrows(Unavailable.class, () -> Stage.open(options));
      daemon.start();
      assertThrows(OutcomeUnknown.class, motion::await);
      TestDaemon.until(
          "the stop after the restart", () -> stage.status().message().getOpenStopsCount() == 0);
      assertEquals("x 0 mm", stage.axis("x").moveTo(mm(0)).toString());
    }
  }
}
