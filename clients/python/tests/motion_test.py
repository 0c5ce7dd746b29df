"""Motions, refusals, stops and lost answers, with the real daemon."""

import _thread
import signal
import threading
import time
import unittest
from unittest import mock

from axisgate import (AxisgateError, MotionFailed, OutcomeUnknown, OutsideTravel, Refused, Stage, Stopped,
                      StoppedBy, Unavailable, mm, pulses, s, um)
from daemon import DaemonTest, Relay, wait_until


class Moves(DaemonTest):
    def setUp(self):
        super().setUp()
        self.stage = self.open()

    def test_moves_to_a_position(self):
        result = self.stage["x"].move_to(1.5 * mm)
        self.assertEqual(str(result), "x 1.5 mm")
        self.assertEqual(result.positions["x"].pulses, 150000)
        self.assertGreater(result.duration, 0)

    def test_moves_axes_together_by_displacements(self):
        self.stage.move_to(x=1 * mm, y=-100 * um)
        self.assertEqual(str(self.stage.move_by(x=(0.1 + 0.2) * mm, y=5 * pulses)), "x 1.3 mm, y -0.09995 mm")

    def test_rounds_floats_and_refuses_inexact_decimals(self):
        self.assertEqual(self.stage["x"].move_to(0.123456789 * mm).positions["x"].pulses, 12346)
        with self.assertRaises(Refused) as caught:
            self.stage["x"].move_to(mm("0.123456789"))
        self.assertEqual(caught.exception.reason, "NOT_REPRESENTABLE")

    def test_names_what_is_wrong_with_a_target(self):
        with self.assertRaises(OutsideTravel) as caught:
            self.stage["x"].move_to(20 * mm)
        error = caught.exception
        self.assertEqual((error.reason, error.axis, error.code), ("OUTSIDE_TRAVEL", 1, "OUT_OF_RANGE"))
        self.assertTrue(error.hint)
        self.assertIn(error.hint, str(error))
        self.assertRaises(OutsideTravel, self.stage.check, x=20 * mm)
        self.stage.check(x=1 * mm)
        self.assertEqual(self.stage.motions(), [])

    def test_names_axes(self):
        self.assertEqual([axis.name for axis in self.stage.axes], ["x", "y", "3"])
        self.assertIs(self.stage["x"], self.stage[1])
        self.assertRaises(KeyError, lambda: self.stage["z"])
        self.assertEqual(self.stage["x"].limits, (mm("-15"), mm("15")))
        self.assertEqual(str(self.stage["x"].position), "x 0 mm")

    def test_homes_only_if_needed(self):
        self.assertEqual(str(self.stage.home("x")), "x 0 mm")
        self.assertEqual(self.stage.home("x", if_needed=True).positions, {})
        self.assertEqual(list(self.stage.home(if_needed=True).positions), ["y", "3"])

    def test_starts_homing(self):
        motion = self.stage.start_home("x", "y")
        self.assertEqual(str(motion.wait()), "x 0 mm, y 0 mm")

    def test_scan_counts_trigger_pulses(self):
        scan = self.stage.scan("x", 0 * mm, 1 * mm, every=100 * um, speed=0.2 * mm / s).wait().scan
        self.assertEqual(scan.expected_in_range, 11)
        self.assertEqual(scan.observed, scan.expected)

    def test_refuses_bare_numbers(self):
        self.assertRaises(TypeError, self.stage["x"].move_to, 1.5)
        self.assertRaises(TypeError, self.stage.move_to)

    def test_finds_stages(self):
        self.assertEqual(Stage.find(self.daemon.socket), ["stage"])
        self.assertRaises(LookupError, Stage, self.daemon.socket, device="other")


class Ends(DaemonTest):
    def setUp(self):
        super().setUp()
        self.stage = self.open()
        self.motion = self.stage.start(x=14 * mm)

    def test_timeout_stops_nothing(self):
        self.assertRaises(TimeoutError, self.motion.wait, 0.2)
        self.assertEqual(self.motion.state, "RUNNING")
        self.assertFalse(self.motion.done)

    def test_stop_by_the_same_program_latches_nothing(self):
        report = self.stage.stop("x")
        self.assertFalse(report.stays_open)
        self.assertIs(report.axes[0].stationary, True)
        self.assertRaises(Stopped, self.motion.wait)
        self.stage["x"].move_to(0 * mm)

    def test_cancel(self):
        self.motion.cancel()
        self.assertRaises(Stopped, self.motion.wait)

    def test_block_that_fails_cancels(self):
        with self.assertRaises(ZeroDivisionError), self.motion:
            raise ZeroDivisionError
        self.assertRaises(Stopped, self.motion.wait)

    def test_callback(self):
        ended = threading.Event()
        self.motion.add_done_callback(lambda motion: ended.set())
        self.motion.cancel()
        self.assertTrue(ended.wait(5))

    def test_stop_by_another_caller_needs_rearm(self):
        with mock.patch("axisgate._target.SESSION", "another-program"):
            other = self.open(self.daemon.address())
        other.stop("x")
        self.assertRaises(Stopped, self.motion.wait)
        with self.assertRaises(StoppedBy) as caught:
            self.stage["x"].move_to(0 * mm)
        self.assertIn("stage.rearm()", caught.exception.hint)
        self.assertEqual(self.stage.rearm(), (1,))
        self.stage["x"].move_to(0 * mm)

    def test_emergency_stop_needs_clear_errors(self):
        self.stage.emergency_stop()
        self.assertRaises(AxisgateError, self.motion.wait)
        with self.assertRaises(Refused) as caught:
            self.stage["x"].move_to(0 * mm)
        self.assertEqual(caught.exception.reason, "EMERGENCY_STOPPED")
        self.assertIn("stage.clear_errors()", caught.exception.hint)
        self.stage.clear_errors()


class Interrupted(DaemonTest):
    def setUp(self):
        super().setUp()
        # A shell's background jobs ignore it.
        self.addCleanup(signal.signal, signal.SIGINT, signal.signal(signal.SIGINT, signal.default_int_handler))

    def test_ctrl_c_cancels_a_move(self):
        stage = self.open()
        wait_until(lambda: stage.status().link == "UP", "the link")
        threading.Timer(0.5, _thread.interrupt_main).start()
        with self.assertRaises(KeyboardInterrupt):
            stage["x"].move_to(14 * mm)
        self.assertRaises(Stopped, stage.motions()[0].wait)


class LostAnswers(DaemonTest):
    def setUp(self):
        super().setUp()
        self.relay = Relay(self.folder, self.daemon.socket)
        self.addCleanup(self.relay.end)
        self.stage = self.open(self.relay.socket)
        self.direct = self.open()

    def test_the_motion_of_the_first_request_is_adopted(self):
        self.relay.cut_answers(stream=3, times=3)  # stream 1 asks for the request memory
        self.assertEqual(str(self.stage.move_by(x=1 * mm)), "x 1 mm")
        self.assertEqual(self.relay.cuts, 3)
        self.assertEqual(len(self.direct.motions()), 1)

    def test_without_an_answer_the_outcome_is_unknown(self):
        self.relay.cut_answers(stream=3, times=1000)
        with self.assertRaises(OutcomeUnknown):
            self.stage.move_by(x=1 * mm)
        self.assertEqual(len(self.direct.motions()), 1)

    def test_waiting_survives_broken_connections(self):
        motion = self.stage.start(x=10 * mm)
        self.relay.cut_answers(stream=5, times=3)
        self.assertEqual(str(motion.wait()), "x 10 mm")
        self.assertEqual(self.relay.cuts, 3)


class LostAnswersWithoutJournal(DaemonTest):
    journal = "false"

    def test_is_not_repeated(self):
        relay = Relay(self.folder, self.daemon.socket)
        self.addCleanup(relay.end)
        stage = self.open(relay.socket)
        relay.cut_answers(stream=3)
        self.assertRaises(OutcomeUnknown, stage.move_by, x=1 * mm)
        self.assertEqual(len(self.open().motions()), 1)


class AtTheStage(DaemonTest):
    def test_cable_is_unplugged(self):
        motion = self.open().start(x=14 * mm)
        self.daemon.at_stage("unplug 60")
        self.assertRaises(OutcomeUnknown, motion.wait)

    def test_limit_sensor(self):
        motion = self.open().start(x=14 * mm)
        self.daemon.at_stage("limit 1 cw on")
        with self.assertRaises(MotionFailed) as caught:
            motion.wait()
        self.assertEqual(caught.exception.reason, "LIMIT_DETECTED")


class Killed(DaemonTest):
    def test_killed_during_a_motion(self):
        stage = self.open()
        motion = stage.start(x=14 * mm)
        time.sleep(0.3)
        self.daemon.kill()
        self.daemon.start()
        with self.assertRaises(OutcomeUnknown):
            motion.wait()
        wait_until(lambda: not stage.status().message.open_stops, "the stop after the restart")
        stage["x"].move_to(0 * mm)

    def test_killed_before_a_motion(self):
        stage = self.open()
        self.daemon.kill()
        self.assertRaises(Unavailable, stage["x"].move_to, 1 * mm)
        with self.assertRaisesRegex(OutcomeUnknown, "the stop was not delivered"):
            stage.stop()
        with self.assertRaises(Unavailable) as caught:
            Stage(self.daemon.socket)
        self.assertIn("AXISGATE_TARGET", caught.exception.hint)

    def test_restarted_before_a_motion(self):
        stage = self.open()
        self.daemon.kill()
        threading.Timer(1, self.daemon.start).start()
        try:
            self.assertEqual(str(stage["x"].move_to(1 * mm)), "x 1 mm")
        finally:
            wait_until(lambda: "is UP" in self.daemon.log(), "the daemon")

    def test_axes_are_unknown_after_a_restart(self):
        stage = self.open()
        self.daemon.restart_without_controller()
        for unknown in (lambda: stage.home("x", if_needed=True), lambda: stage.home(if_needed=True),
                        lambda: stage["x"].position):
            with self.assertRaises(Unavailable) as caught:
                unknown()
            self.assertEqual(caught.exception.reason, "LINK_DOWN")


if __name__ == "__main__":
    unittest.main()
