"""The policies of repeating and following, the mapping of errors, and targets: without a daemon."""

import time
import unittest

import grpc

import axisgate
from axisgate import (LeaseHeld, LeaseLost, MotionFailed, NotAllowed, OutcomeUnknown, OutsideTravel, Refused, Stopped,
                      Unavailable, _status_pb2)
from axisgate._cursor import Cursor
from axisgate._following import LOST_LIMIT_S, Following
from axisgate._hints import with_methods
from axisgate._keeping import Keeping
from axisgate._outcomes import Failure, error_of, failure_of
from axisgate._record import ProgressMeter
from axisgate._repeat import Repeat, for_action
from axisgate._target import resolve
from axisgate.results import outcome_of
from axisgate.v1 import common_pb2, device_pb2, event_pb2, motion_pb2

CODE = grpc.StatusCode
BROKEN = Failure(CODE.UNAVAILABLE, "Socket closed", None)
NEVER = Failure(CODE.UNAVAILABLE, "failed to connect to all addresses; last error: ...", None)


def refusal(reason, code=CODE.FAILED_PRECONDITION, **fields):
    number = common_pb2.Reason.Value(f"REASON_{reason}") if isinstance(reason, str) else reason
    return Failure(code, "text", common_pb2.Problem(reason=number, message="a sentence.", **fields))


class Repeating(unittest.TestCase):
    def pauses(self, repeat, failure):
        """The pauses until the end, on a clock that only pauses move."""
        now, pauses = 0.0, []
        while (pause := repeat.pause_after(failure, now)) is not None:
            now += pause
            pauses.append(pause)
        return pauses

    def test_lost_answer(self):
        repeat = Repeat(5.0, "here", 5.0)
        self.assertEqual(self.pauses(repeat, BROKEN), [0.25, 0.5, 1.0, 2.0, 1.25])
        self.assertIsInstance(repeat.error, OutcomeUnknown)

    def test_deadline_covers_the_answer(self):
        repeat = Repeat(5.0, "here", 3.0)
        self.assertEqual((repeat.attempt_timeout(1.0), repeat.attempt_timeout(9.0)), (7.0, 3.0))

    def test_no_connection_at_all(self):
        repeat = Repeat(5.0, "here", 5.0)
        self.assertEqual(len(self.pauses(repeat, NEVER)), 5)
        self.assertIsInstance(repeat.error, Unavailable)

    def test_no_connection_after_a_lost_answer(self):
        repeat = Repeat(1.0, "here", 5.0)
        repeat.pause_after(BROKEN, 0.0)
        self.pauses(repeat, NEVER)
        self.assertIsInstance(repeat.error, OutcomeUnknown)

    def test_refusal_is_final(self):
        repeat = Repeat(5.0, "here", 5.0)
        self.assertIsNone(repeat.pause_after(refusal("OUTSIDE_TRAVEL"), 0.0))
        self.assertIsInstance(repeat.error, OutsideTravel)

    def test_unavailable_is_repeated(self):
        repeat = Repeat(5.0, "here", 5.0)
        self.assertEqual(len(self.pauses(repeat, refusal("LINK_DOWN", CODE.UNAVAILABLE))), 5)
        self.assertEqual((type(repeat.error), repeat.error.reason), (Unavailable, "LINK_DOWN"))

    def test_refusal_after_a_lost_answer(self):
        for reason, decides in (("OUTSIDE_TRAVEL", True), ("DEADLINE_PASSED", True), ("LEASE_LOST", False),
                                ("UNAUTHENTICATED", False), ("REQUEST_MEMORY_LOST", False)):
            repeat = Repeat(5.0, "here", 5.0)
            self.assertEqual(repeat.pause_after(BROKEN, 0.0), 0.25)
            self.assertIsNone(repeat.pause_after(refusal(reason), 0.5))
            self.assertEqual(isinstance(repeat.error, Refused), decides, reason)
            self.assertEqual(isinstance(repeat.error, OutcomeUnknown), not decides, reason)

    def test_without_a_memory(self):
        repeat = Repeat(5.0, "here", 5.0, remembered=False)
        self.assertEqual(repeat.pause_after(NEVER, 0.0), 0.25)
        self.assertIsNone(repeat.pause_after(BROKEN, 0.5))
        self.assertIsInstance(repeat.error, OutcomeUnknown)

    def test_question(self):
        repeat = Repeat(5.0, "here", 5.0, acts=False, remembered=False)
        self.assertEqual(len(self.pauses(repeat, BROKEN)), 5)
        self.assertIsInstance(repeat.error, Unavailable)


class FollowingTest(unittest.TestCase):
    def setUp(self):
        self.motion = motion_pb2.Motion(name="devices/stage/motions/1", request_id="a")
        self.following = Following(self.motion, "here", 0.0)

    def test_waits_in_parts(self):
        for left, wait in ((100.0, 10.0), (3.0, 3.0), (-1.0, 0.0)):
            request, deadline = self.following.question(left)
            self.assertEqual((request.max_wait.ToMilliseconds() / 1e3, deadline), (wait, wait + 5.0))

    def test_broken_connection(self):
        self.assertEqual([self.following.pause_after(BROKEN, 1.0) for _ in range(7)], [0.25, 0.5, 1, 2, 4, 5, 5])
        self.following.take(self.motion, 50.0)
        self.assertEqual(self.following.pause_after(NEVER, LOST_LIMIT_S + 49.0), 0.25)
        self.assertIsNone(self.following.pause_after(NEVER, LOST_LIMIT_S + 51.0))
        self.assertIsInstance(self.following.error, OutcomeUnknown)

    def test_motion_is_no_longer_kept(self):
        self.assertIsNone(self.following.pause_after(refusal("NOT_FOUND", CODE.NOT_FOUND), 1.0))
        self.assertIsInstance(self.following.error, OutcomeUnknown)

    def test_other_motion_of_the_same_name(self):
        other = motion_pb2.Motion(name=self.motion.name, request_id="b")
        self.assertFalse(self.following.take(other, 1.0))
        self.assertIsInstance(self.following.error, OutcomeUnknown)


class KeepingTest(unittest.TestCase):
    def test_lease_is_lost_after_its_time_to_live(self):
        keeping = Keeping("devices/stage", b"token", 3.0, 10.0)
        self.assertEqual((keeping.every_s, keeping.request.context.lease_token), (1.0, b"token"))
        away = Unavailable("UNAVAILABLE", "nobody answers")
        self.assertIsNone(keeping.loss_after(away, 12.9))
        keeping.renewed(13.0)
        self.assertIsNone(keeping.loss_after(away, 15.9))
        self.assertIsInstance(keeping.loss_after(away, 16.1), LeaseLost)

    def test_refused_renewal_loses_the_lease(self):
        keeping = Keeping("devices/stage", b"token", 3.0, 10.0)
        refused = LeaseLost("LEASE_LOST", "an administrator took it")
        self.assertIs(keeping.loss_after(refused, 10.5), refused)
        self.assertIsInstance(keeping.loss_after(RuntimeError("closed"), 10.5), LeaseLost)


class Action(unittest.TestCase):
    def context(self, target, **listed):
        now = time.time()
        answer = device_pb2.ListDevicesResponse(**listed)
        answer.time.FromNanoseconds(int((now + 1000) * 1e9))
        context, repeat = for_action(answer, resolve(target, None, "ca", None, None, {}), b"lease", 5.0, 5.0, 100.0)
        self.assertEqual((context.lease_token, repeat.until), (b"lease", 105.0))
        return context, round(context.not_after.ToNanoseconds() / 1e9 - now)

    def test_memory_counts_only_if_it_is_kept(self):
        self.assertEqual(self.context("a.sock", request_memory="m", requests_kept=True)[0].request_memory, "m")
        self.assertEqual(self.context("a.sock", request_memory="m")[0].request_memory, "")

    def test_clock_of_another_machine(self):
        self.assertEqual(self.context("a.sock")[1], 5)
        self.assertEqual(self.context("lab")[1], 1005)


class Errors(unittest.TestCase):
    def test_every_reason_has_a_class(self):
        for value in common_pb2.Reason.DESCRIPTOR.values:
            error = error_of(refusal(value.number), "here")
            self.assertEqual(f"REASON_{error.reason}", value.name)

    def test_reason_of_a_newer_daemon(self):
        error = error_of(refusal(99), "here")
        self.assertEqual((type(error), error.reason), (Refused, "REASON 99"))

    def test_details(self):
        error = error_of(refusal("LEASE_HELD", axis=2, hint="acquire it: `AcquireLease`", sent="G:1", wire_reply="NG"),
                         "here")
        self.assertIsInstance(error, LeaseHeld)
        self.assertEqual((error.axis, error.sent, error.wire_reply), (2, "G:1", "NG"))
        self.assertEqual(error.code, "FAILED_PRECONDITION")
        self.assertEqual(str(error), 'LEASE_HELD: a sentence. (acquire it: `stage.lease("2")`)')

    def test_early_refusals(self):
        for code, kind in ((CODE.UNAUTHENTICATED, NotAllowed), (CODE.PERMISSION_DENIED, NotAllowed),
                           (CODE.UNIMPLEMENTED, Refused)):
            failure = Failure(code, "text", None)
            self.assertFalse(failure.lost)
            self.assertIs(type(error_of(failure, "here")), kind)

    def test_too_much_may_have_acted(self):
        self.assertTrue(Failure(CODE.RESOURCE_EXHAUSTED, "the answer is too long", None).lost)

    def test_outcomes(self):
        for state, kind in (("STOPPED", Stopped), ("FAILED", MotionFailed), ("UNKNOWN", OutcomeUnknown)):
            motion = motion_pb2.Motion(state=motion_pb2.MotionState.Value(f"MOTION_STATE_{state}"),
                                       problem=common_pb2.Problem(reason=common_pb2.REASON_LIMIT_DETECTED))
            with self.assertRaises(kind) as caught:
                outcome_of(motion)
            self.assertEqual(caught.exception.reason, "LIMIT_DETECTED")

    def test_decodes_trailers(self):
        class Error:
            def __init__(self, details):
                self._details = details

            def code(self):
                return CODE.OUT_OF_RANGE

            def details(self):
                return "text"

            def trailing_metadata(self):
                return (("grpc-status-details-bin", self._details),)

        status = _status_pb2.Status()
        status.details.add().Pack(common_pb2.Problem(reason=common_pb2.REASON_TOO_FAST))
        self.assertEqual(failure_of(Error(status.SerializeToString())).reason, "TOO_FAST")
        self.assertTrue(failure_of(Error(b"\xff\xff")).lost)

    def test_hints(self):
        self.assertEqual(with_methods("clear it: `ClearErrors`", "1"), "clear it: `stage.clear_errors()`")
        self.assertEqual(with_methods("`ChangeSettings` with `excited`", ""),
                         "`stage.settings.change(axis, motor_on=True)`")

    def test_common_base(self):
        for name in axisgate.__all__:
            self.assertTrue(getattr(axisgate, name).__doc__, name)
            kind = getattr(axisgate, name)
            if isinstance(kind, type) and issubclass(kind, Exception):
                self.assertTrue(issubclass(kind, axisgate.AxisgateError))


class ProgressTest(unittest.TestCase):
    def test_unknown_positions(self):
        motion = motion_pb2.Motion(axes=[1], results=[motion_pb2.AxisResult(axis=1, target_pulses=100)])
        meter = ProgressMeter()

        def fraction(pulses):
            return meter.take(motion, device_pb2.Device(name="devices/stage", axes=[
                device_pb2.Axis(number=1, position_pulses=pulses)])).fraction
        self.assertEqual([fraction(pulses) for pulses in (None, 20, 60, None)], [None, 0, 0.5, None])


class Cursors(unittest.TestCase):
    def test_resumes_after_the_last_event(self):
        cursor = Cursor("devices/stage", 5, "")
        self.assertEqual((cursor.request().from_revision, cursor.request().run), (5, ""))
        cursor.take(event_pb2.Event(revision=7, run="a"))
        self.assertEqual((cursor.request().from_revision, cursor.request().run), (8, "a"))

    def test_gap(self):
        cursor = Cursor("devices/stage", 5, "a")
        compacted = refusal("COMPACTED", CODE.OUT_OF_RANGE, metadata={"resume_revision": "40"})
        self.assertEqual(cursor.gap_after(compacted), 40)
        self.assertEqual((cursor.request().from_revision, cursor.request().run), (40, ""))
        self.assertIsNone(cursor.gap_after(BROKEN))


class Targets(unittest.TestCase):
    def address(self, target=None, environment=None, **arguments):
        chosen = dict.fromkeys(("token", "ca", "certificate", "key"), None)
        return resolve(target, **{**chosen, **arguments}, environment=environment or {}).address

    def test_addresses(self):
        for target, address in (("/run/a.sock", "unix:/run/a.sock"), ("a.sock", "unix:a.sock"), ("lab", "lab:50203"),
                                ("lab:1", "lab:1"), ("[::1]", "[::1]:50203"), ("::1", "[::1]:50203"),
                                ("[::1]:1", "[::1]:1"), ("unix:a", "unix:a")):
            self.assertEqual(self.address(target), address)
        self.assertEqual(self.address("lab", ca="file"), "lab:50204")

    def test_environment(self):
        self.assertEqual(self.address(environment={"AXISGATE_TARGET": "lab"}), "lab:50203")
        self.assertEqual(self.address("x.sock", {"AXISGATE_TARGET": "lab"}), "unix:x.sock")
        self.assertEqual(self.address(environment={"AXISGATE_SOCKET": "/a"}), "unix:/a")

    def test_token_is_not_sent_in_plaintext(self):
        for target in ("127.0.0.1", "localhost:1", "[::1]", "/a/b.sock", "ipv4:127.0.0.1:1"):
            self.address(target, token="secret")
        for target in ("lab", "127.0.0.1.example", "192.0.2.1:50203", "dns:lab"):
            self.assertRaises(ValueError, self.address, target, token="secret")
        self.address("lab", token="secret", ca="file")
        self.assertRaises(ValueError, self.address, "lab", certificate="file")

    def test_token_is_not_shown(self):
        target = resolve("a.sock", "secret", None, None, None, {})
        self.assertIn(("authorization", "Bearer secret"), target.metadata)
        self.assertNotIn("secret", repr(target))


if __name__ == "__main__":
    unittest.main()
