"""Axes and lines as devices of a RunEngine, with the real daemon."""

import threading
import time
import unittest
from unittest import mock

from axisgate import LeaseHeld, OutcomeUnknown, OutsideTravel, Stopped, StoppedBy, Unavailable, mm
from axisgate.bluesky import BlueskyAxis, BlueskyLine, Line, Status
from axisgate.state import status_of
from daemon import DaemonTest, wait_until

try:
    from bluesky import RunEngine, plan_stubs, plans, preprocessors, protocols
    from bluesky.utils import FailedStatus, RunEngineInterrupted
except ImportError:
    RunEngine = None


class BlueskyTest(DaemonTest):
    def setUp(self):
        super().setUp()
        self.stage = self.open()
        self.x, self.y = BlueskyAxis(self.stage["x"], "x"), BlueskyAxis(self.stage["y"], "sample_y")

    def another(self):
        with mock.patch("axisgate._target.SESSION", "another-program"):
            return self.open(self.daemon.address())


class WithoutBluesky(BlueskyTest):
    def test_statuses(self):
        called, updates = [], []
        status = self.x.set(1)
        status.add_callback(called.append)
        status.watch(lambda **update: updates.append(update))
        self.assertFalse(status.done or status.success)
        self.assertRaises(TimeoutError, status.exception)
        self.assertEqual(self.x.locate()["setpoint"], 1)
        self.assertIsNone(status.exception(timeout=20))
        self.assertTrue(status.done and status.success)
        wait_until(lambda: called == [status], "the callback")
        status.add_callback(called.append)
        self.assertEqual(called, [status, status])
        self.assertEqual((updates[0]["target"], updates[0]["unit"]), (1, "mm"))
        self.assertEqual(self.x.locate(), {"setpoint": 1, "readback": 1})

    def test_stop_with_and_without_success(self):
        for success in (True, False):
            status = self.x.set(14)
            self.x.stop(success=success)
            self.assertEqual(isinstance(status.exception(timeout=20), Stopped), not success)
            self.assertEqual(self.x.locate()["setpoint"], self.x.position)

    def test_stop_leaves_the_motion_of_another_program(self):
        other = self.another().start(x=0.5 * mm)
        self.x.stop()
        self.assertEqual(str(other.wait()), "x 0.5 mm")

    def test_stop_by_another_program_fails_the_status(self):
        status = self.x.set(14)
        self.another().stop("x")
        self.assertIsInstance(status.exception(timeout=20), Stopped)
        self.assertRaises(StoppedBy, self.x.set, 0)

    def test_killed_daemon_fails_the_status(self):
        status = self.x.set(14)
        time.sleep(0.3)
        self.daemon.kill()
        self.daemon.start()
        self.assertIsInstance(status.exception(timeout=20), OutcomeUnknown)

    def test_checks_and_refuses(self):
        self.assertRaises(OutsideTravel, self.x.check_value, 20)
        self.x.check_value(10)
        self.assertRaises(OutsideTravel, self.x.set, 20)
        self.assertEqual(self.stage.motions(), [])

    def test_describes(self):
        key = self.x.describe()["x"]
        self.assertEqual((key["units"], key["precision"]), ("mm", 5))
        self.assertEqual(key["limits"], {"control": {"low": -15.0, "high": 15.0}})
        self.assertNotIn("limits", self.y.describe()["sample_y"])
        self.assertEqual(self.x.read_configuration().keys(), self.x.describe_configuration().keys())
        self.assertEqual((self.x.name, self.y.hints, self.x.parent), ("x", {"fields": ["sample_y"]}, None))

    def test_lease(self):
        other = self.another()
        self.assertEqual(self.x.stage(), [self.x])
        self.assertRaises(LeaseHeld, other["x"].move_to, 0 * mm)
        self.x.set(0.1).wait(20)
        self.assertRaises(RuntimeError, self.x.stage)
        self.x.unstage()
        with other.lease("x"):
            self.assertRaises(LeaseHeld, self.x.stage)
        with self.stage.lease("x") as lease:
            staged = BlueskyAxis(self.stage["x"], lease=lease)
            staged.stage()
            moving = []
            mover = threading.Thread(target=lambda: moving.append(staged.set(0)))
            mover.start()  # a thread without the lease of this one
            mover.join()
            moving[0].wait(20)

    def test_subscription(self):
        seen = []
        self.x.subscribe(seen.append)
        self.x.set(0.5).wait(20)
        wait_until(lambda: seen and seen[-1]["x"]["value"] == 0.5, "the last reading")
        self.x.clear_sub(seen.append)

    def test_subscription_survives_a_restart(self):
        seen, statuses = [], []

        def noted(device):
            statuses.append(status_of(device))
            return statuses[-1]
        with mock.patch("axisgate.samples.status_of", noted):
            self.x.subscribe(seen.append)
            self.daemon.restart_without_controller()
            self.assertRaises(Unavailable, self.x.describe)
            self.assertRaises(Unavailable, self.x.read)
            wait_until(lambda: any(not status.axes for status in statuses), "a state without axes")
            before = len(seen)
            self.daemon.let_controller_answer()
            wait_until(lambda: len(seen) > before, "a reading after the restart")
        self.x.clear_sub(seen.append)

    def test_line(self):
        line = BlueskyLine(self.stage["x"], "line")
        self.assertRaises(RuntimeError, line.kickoff)
        self.assertRaises(OutsideTravel, line.prepare, Line(0, 20, every=0.1))
        line.prepare(Line(0, 1, every=0.1, speed=0.5)).wait(0)
        line.kickoff().wait(0)
        self.assertEqual(list(line.collect()), [])
        line.complete().wait(30)
        events = list(line.collect())
        self.assertEqual(len(events), self.stage.motions()[0].result.scan.expected)
        self.assertEqual(list(line.collect()), [])
        line.kickoff()
        status = line.complete()
        line.unstage()
        self.assertTrue(status.exception(timeout=20) is None and not list(line.collect()))


@unittest.skipIf(RunEngine is None, "bluesky is not installed")
class InARunEngine(BlueskyTest):
    def setUp(self):
        super().setUp()
        self.engine = RunEngine({}, call_returns_result=True)
        self.documents = []
        self.engine.subscribe(lambda name, document: self.documents.append((name, document)))

    def events(self, *names):
        return [tuple(round(document["data"][name], 6) for name in names) for kind, document in self.documents
                if kind == "event"]

    def soon(self, act, seconds=0.5):
        timer = threading.Timer(seconds, act)
        timer.start()
        self.addCleanup(timer.join)

    def test_protocols(self):
        for protocol in ("Movable", "Readable", "Configurable", "Locatable", "Checkable", "Stageable", "Stoppable",
                         "Subscribable", "HasHints", "HasParent"):
            self.assertIsInstance(self.x, getattr(protocols, protocol), protocol)
        line = BlueskyLine(self.stage["x"], "line")
        for protocol in ("Preparable", "Flyable", "EventCollectable", "Stageable", "Stoppable"):
            self.assertIsInstance(line, getattr(protocols, protocol), protocol)
        self.assertIsInstance(Status("x"), protocols.Status)

    def test_scans(self):
        self.engine(plans.scan([], self.x, 0, 0.4, 5))
        self.assertEqual(self.events("x"), [(0,), (0.1,), (0.2,), (0.3,), (0.4,)])
        self.documents.clear()
        self.engine(plans.rel_scan([], self.x, -0.1, 0.1, 3))
        self.assertEqual(self.events("x"), [(0.3,), (0.4,), (0.5,)])
        self.assertEqual(self.x.position, 0.4)
        self.documents.clear()
        self.engine(plans.grid_scan([], self.y, 0, 0.1, 2, self.x, 0, 0.2, 3))
        self.assertEqual(self.events("sample_y", "x"),
                         [(0, 0), (0, 0.1), (0, 0.2), (0.1, 0), (0.1, 0.1), (0.1, 0.2)])
        self.another()["x"].move_to(0 * mm)  # the leases were released

    def test_moves(self):
        self.engine(plan_stubs.mv(self.x, 0.3, self.y, -0.1))
        self.engine(plan_stubs.mvr(self.x, 0.1))
        self.assertEqual((self.x.position, self.y.position), (0.4, -0.1))
        with self.assertRaises(OutsideTravel):
            self.engine(plan_stubs.mv(self.x, 20))

    def test_monitor(self):
        @preprocessors.run_decorator()
        def plan():
            yield from plan_stubs.monitor(self.x, name="positions")
            yield from plan_stubs.mv(self.x, 0.5)
            yield from plan_stubs.unmonitor(self.x)
        self.engine(plan())
        self.assertGreater(len(self.events("x")), 1)

    def test_pause_and_resume(self):
        self.soon(self.engine.request_pause)
        with self.assertRaises(RunEngineInterrupted):
            self.engine(plans.scan([], self.x, 0, 10, 2))
        self.assertFalse(self.stage.status(max_age=0).axes["x"].moving)
        self.assertLess(self.x.position, 10)
        result = self.engine.resume()
        self.assertEqual(result.exit_status, "success")
        self.assertEqual(self.events("x"), [(0,), (10,)])

    def test_abort_stops_the_axis(self):
        self.soon(lambda: self.engine.abort("a test"))
        with self.assertRaises(RunEngineInterrupted):
            self.engine(plans.scan([], self.x, 14, 0, 2))
        wait_until(lambda: self.engine.state == "idle", "the end of the plan")
        position = self.x.position
        self.assertTrue(0 < position < 14)
        time.sleep(0.3)
        self.assertEqual(self.x.position, position)
        self.another()["x"].move_to(0 * mm)  # the lease was released

    def test_stop_by_another_program(self):
        other = self.another()
        self.soon(lambda: other.stop("x"))
        with self.assertRaises(FailedStatus) as caught:
            self.engine(plans.scan([], self.x, 0, 14, 2))
        self.assertIsInstance(caught.exception.__cause__, Stopped)
        with self.assertRaises(StoppedBy):
            self.engine(plan_stubs.mv(self.x, 0))
        self.stage.rearm()
        self.engine(plan_stubs.mv(self.x, 0))

    def line_plan(self, line, speed=0.5):
        @preprocessors.stage_decorator([line])
        @preprocessors.run_decorator()
        def plan():
            yield from plan_stubs.prepare(line, Line(0, 1, every=0.05, speed=speed), wait=True)
            yield from plan_stubs.kickoff(line, wait=True)
            yield from plan_stubs.complete(line, wait=True)
            yield from plan_stubs.collect(line)
        return plan()

    def test_fly_scan(self):
        self.engine(self.line_plan(BlueskyLine(self.stage["x"], "line")))
        scan = self.stage.motions()[0].result.scan
        pages = [document for name, document in self.documents if name == "event_page"]
        positions = [position for page in pages for position in page["data"]["line"]]
        self.assertEqual(positions, [float(position) for position in scan.positions])
        self.assertEqual(len(positions), scan.observed)
        self.assertEqual([round(position, 6) for position in positions if 0 <= position <= 1],
                         [round(0.05 * number, 6) for number in range(21)])

    def test_abort_of_a_fly_scan(self):
        self.soon(lambda: self.engine.abort("a test"), 1)
        with self.assertRaises(RunEngineInterrupted):
            self.engine(self.line_plan(BlueskyLine(self.stage["x"], "line"), speed=0.05))
        wait_until(lambda: self.engine.state == "idle", "the end of the plan")
        self.assertRaises(Stopped, self.stage.motions()[0].wait)


if __name__ == "__main__":
    unittest.main()
