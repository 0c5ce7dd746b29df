package axisgate;

import static org.junit.jupiter.api.Assertions.assertEquals;
import static org.junit.jupiter.api.Assertions.assertFalse;
import static org.junit.jupiter.api.Assertions.assertInstanceOf;
import static org.junit.jupiter.api.Assertions.assertThrows;
import static org.junit.jupiter.api.Assertions.assertTrue;

import axisgate.v1.MotionState;
import axisgate.v1.Reason;
import com.google.protobuf.Any;
import io.grpc.Metadata;
import io.grpc.Status;
import io.grpc.protobuf.StatusProto;
import java.util.Map;
import org.junit.jupiter.api.Test;

/** Errors of failed calls and motions, without a daemon. */
class OutcomesTest {
  @Test
  void everyReasonHasAnError() {
    for (Reason reason : Reason.values()) {
      if (reason != Reason.UNRECOGNIZED) {
        String name = reason.name().substring("REASON_".length());
        Failure refusal = PolicyTest.refusal(name, Status.Code.FAILED_PRECONDITION);
        assertEquals(name, Outcomes.errorOf(refusal, "here").reason());
      }
    }
    assertEquals("REASON 999", Names.reason(999));
  }

  @Test
  void detailsOfAnError() {
    var problem =
        axisgate.v1.Problem.newBuilder()
            .setReason(Reason.REASON_LEASE_HELD)
            .setMessage("a sentence.")
            .setHint("acquire it: `AcquireLease`")
            .setAxis(2)
            .setSent("G:1")
            .setWireReply("NG")
            .build();
    var status =
        com.google.rpc.Status.newBuilder()
            .setCode(Status.Code.FAILED_PRECONDITION.value())
            .addDetails(Any.pack(problem));
    var failed = StatusProto.toStatusRuntimeException(status.build());
    Failure failure = Failure.of(failed.getStatus(), failed.getTrailers(), true);
    AxisgateException error = Outcomes.errorOf(failure, "here");
    assertInstanceOf(LeaseHeld.class, error);
    assertEquals("LEASE_HELD: a sentence. (acquire it: `stage.lease(\"2\")`)", error.getMessage());
    assertEquals(
        new Problem(
            "LEASE_HELD",
            "a sentence.",
            "acquire it: `stage.lease(\"2\")`",
            2,
            "G:1",
            "NG",
            "FAILED_PRECONDITION"),
        error.problem());
  }

  @Test
  void earlyRefusalsHaveReasons() {
    Failure early = new Failure(Status.Code.UNAUTHENTICATED, "text", null, true);
    assertFalse(early.lost());
    assertEquals("UNAUTHENTICATED", early.reason());
    assertInstanceOf(NotAllowed.class, Outcomes.errorOf(early, "here"));
  }

  @Test
  void resourceExhaustedWithoutAProblemIsALostAnswer() {
    Status tooLong = Status.RESOURCE_EXHAUSTED.withDescription("message exceeds maximum size");
    Failure failure = Failure.of(tooLong, new Metadata(), true);
    assertTrue(failure.lost());
    assertEquals("", failure.reason());
    assertInstanceOf(OutcomeUnknown.class, Outcomes.errorOf(failure, "here"));
  }

  @Test
  void motionOfAnotherRequestIsUnknown() {
    var motion =
        axisgate.v1.Motion.newBuilder().setName("devices/stage/motions/7").setRequestId("a");
    assertEquals("a", Outcomes.own(motion.build(), "a").getRequestId());
    var error = assertThrows(OutcomeUnknown.class, () -> Outcomes.own(motion.build(), "b"));
    assertEquals(
        "the daemon answered with devices/stage/motions/7, which another request started",
        error.problem().message());
  }

  @Test
  void outcomesOfMotions() {
    Map<MotionState, Class<? extends AxisgateException>> errors =
        Map.of(
            MotionState.MOTION_STATE_STOPPED, Stopped.class,
            MotionState.MOTION_STATE_FAILED, MotionFailed.class,
            MotionState.MOTION_STATE_UNKNOWN, OutcomeUnknown.class);
    errors.forEach(
        (state, type) -> {
          var motion = axisgate.v1.Motion.newBuilder().setState(state).build();
          assertThrows(type, () -> Outcomes.resultOf(motion));
        });
  }

  @Test
  void hintsNameMethods() {
    assertEquals("home it: `stage.home(\"1\")`", Hints.withMethods("home it: `Home`", 1));
    assertEquals(
        "see `ListHistory` or `stage.rearm()`",
        Hints.withMethods("see `ListHistory` or `Rearm`", 0));
  }
}
