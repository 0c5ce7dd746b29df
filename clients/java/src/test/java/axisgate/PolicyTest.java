package axisgate;

import static org.junit.jupiter.api.Assertions.assertEquals;
import static org.junit.jupiter.api.Assertions.assertInstanceOf;
import static org.junit.jupiter.api.Assertions.assertSame;
import static org.junit.jupiter.api.Assertions.assertThrows;
import static org.junit.jupiter.api.Assertions.assertTrue;

import axisgate.v1.ListDevicesResponse;
import axisgate.v1.Reason;
import io.grpc.Status;
import java.time.Duration;
import java.util.ArrayList;
import java.util.List;
import java.util.Map;
import org.junit.jupiter.api.Test;

/**
 * When requests are sent again, how a motion is followed, and what errors become: without a daemon.
 */
class PolicyTest {
  private static final Duration START = Duration.ofSeconds(1000);
  private static final Failure BROKEN =
      new Failure(Status.Code.UNAVAILABLE, "connection reset", null, true);
  private static final Failure NEVER =
      new Failure(Status.Code.UNAVAILABLE, "connection refused", null, false);

  static Failure refusal(String reason, Status.Code code) {
    var problem = axisgate.v1.Problem.newBuilder().setReason(Reason.valueOf("REASON_" + reason));
    return new Failure(code, "text", problem.setMessage("a sentence.").build(), true);
  }

  private static Repeat repeat(boolean acts, boolean remembered) {
    Duration until = START.plusSeconds(5);
    return new Repeat(new Repeat.Terms(until, Duration.ofSeconds(3), "here", acts, remembered));
  }

  /** Returns the error that ends the repeats, on a clock that only pauses move. */
  private static RuntimeException end(Repeat repeat, Failure failure, List<Long> pauses) {
    Duration now = START;
    for (; ; ) {
      try {
        Duration pause = repeat.after(failure, now);
        now = now.plus(pause);
        pauses.add(pause.toMillis());
      } catch (RuntimeException e) {
        return e;
      }
    }
  }

  @Test
  void lostAnswerIsRepeated() {
    List<Long> pauses = new ArrayList<>();
    assertInstanceOf(OutcomeUnknown.class, end(repeat(true, true), BROKEN, pauses));
    assertEquals(List.of(250L, 500L, 1000L, 2000L, 1250L), pauses);
  }

  @Test
  void deadlineCoversTheAnswer() {
    assertEquals(Duration.ofSeconds(7), repeat(true, true).timeout(START.plusSeconds(1)));
    assertEquals(Duration.ofSeconds(3), repeat(true, true).timeout(START.plusSeconds(9)));
  }

  @Test
  void withoutAnyConnectionNothingActed() {
    List<Long> pauses = new ArrayList<>();
    assertInstanceOf(Unavailable.class, end(repeat(true, true), NEVER, pauses));
    assertEquals(5, pauses.size());
  }

  @Test
  void noConnectionAfterALostAnswerIsUnknown() {
    Repeat repeat = repeat(true, true);
    repeat.after(BROKEN, START);
    assertInstanceOf(OutcomeUnknown.class, end(repeat, NEVER, new ArrayList<>()));
  }

  @Test
  void refusalIsFinal() {
    Failure outside = refusal("OUTSIDE_TRAVEL", Status.Code.OUT_OF_RANGE);
    assertThrows(OutsideTravel.class, () -> repeat(true, true).after(outside, START));
  }

  @Test
  void unavailableControllerIsAskedAgain() {
    List<Long> pauses = new ArrayList<>();
    Failure down = refusal("LINK_DOWN", Status.Code.UNAVAILABLE);
    assertInstanceOf(Unavailable.class, end(repeat(true, true), down, pauses));
    assertEquals(5, pauses.size());
  }

  @Test
  void refusalAfterALostAnswer() {
    Map<String, Class<? extends AxisgateException>> errors =
        Map.of(
            "OUTSIDE_TRAVEL", OutsideTravel.class,
            "DEADLINE_PASSED", Refused.class,
            "LEASE_LOST", OutcomeUnknown.class,
            "UNAUTHENTICATED", OutcomeUnknown.class,
            "REQUEST_MEMORY_LOST", OutcomeUnknown.class);
    errors.forEach(
        (reason, type) -> {
          Repeat repeat = repeat(true, true);
          repeat.after(BROKEN, START);
          Failure refusal = refusal(reason, Status.Code.FAILED_PRECONDITION);
          assertThrows(type, () -> repeat.after(refusal, START), reason);
        });
  }

  @Test
  void withoutAMemoryALostAnswerIsFinal() {
    Repeat repeat = repeat(true, false);
    repeat.after(NEVER, START);
    assertThrows(OutcomeUnknown.class, () -> repeat.after(BROKEN, START));
  }

  @Test
  void questionIsAlwaysRepeated() {
    List<Long> pauses = new ArrayList<>();
    assertInstanceOf(Unavailable.class, end(repeat(false, false), BROKEN, pauses));
    assertEquals(5, pauses.size());
  }

  @Test
  void abandonedRequestMayHaveActed() {
    RuntimeException cause = new Interrupted("why");
    assertSame(cause, repeat(true, true).abandoned(NEVER, cause));
    RuntimeException error = repeat(true, true).abandoned(BROKEN, cause);
    assertInstanceOf(OutcomeUnknown.class, error);
    assertSame(cause, error.getCause());
  }

  private static Following following() {
    var motion = axisgate.v1.Motion.newBuilder().setName("devices/stage/motions/1");
    return new Following(motion.setRequestId("a").build(), "here", START);
  }

  @Test
  void waitsInParts() {
    assertEquals(Duration.ofSeconds(10), Following.part(Duration.ofSeconds(100)));
    assertEquals(Duration.ofSeconds(3), Following.part(Duration.ofSeconds(3)));
    assertEquals(Duration.ZERO, Following.part(Duration.ofSeconds(-1)));
    assertEquals(3, following().question(Duration.ofSeconds(3)).getMaxWait().getSeconds());
  }

  @Test
  void followsOverBrokenConnections() {
    Following following = following();
    for (long wanted : List.of(250, 500, 1000, 2000, 4000, 5000, 5000)) {
      assertEquals(wanted, following.after(BROKEN, START).toMillis());
    }
    following.take(following.motion(), START.plusSeconds(50));
    assertEquals(Backoff.FIRST, following.after(NEVER, START.plusSeconds(109)));
    assertThrows(OutcomeUnknown.class, () -> following.after(NEVER, START.plusSeconds(111)));
  }

  @Test
  void motionThatIsNoLongerKeptIsUnknown() {
    Failure gone = refusal("NOT_FOUND", Status.Code.NOT_FOUND);
    assertThrows(OutcomeUnknown.class, () -> following().after(gone, START));
  }

  @Test
  void otherMotionOfTheSameNameIsUnknown() {
    Following following = following();
    var other = following.motion().toBuilder().setRequestId("b").build();
    assertThrows(OutcomeUnknown.class, () -> following.take(other, START));
  }

  @Test
  void cursorResumesAfterTheLastEvent() {
    var listed = ListDevicesResponse.newBuilder().setNextRevision(5).setRun("0").build();
    Cursor cursor = Cursor.fromNow("devices/stage", listed);
    assertEquals(5, cursor.request().getFromRevision());
    assertEquals("0", cursor.request().getRun());
    cursor.take(axisgate.v1.Event.newBuilder().setRevision(7).setRun("a").build());
    assertEquals(8, cursor.request().getFromRevision());
    assertEquals("a", cursor.request().getRun());
    Failure refusal = refusal("COMPACTED", Status.Code.OUT_OF_RANGE);
    var problem = refusal.problem().toBuilder().putMetadata("resume_revision", "40").build();
    Failure compacted = new Failure(refusal.code(), "", problem, true);
    assertEquals(40, cursor.gapAfter(compacted).orElseThrow().resumeRevision());
    assertEquals(40, cursor.request().getFromRevision());
    assertEquals("", cursor.request().getRun());
    assertTrue(cursor.gapAfter(BROKEN).isEmpty());
  }
}
