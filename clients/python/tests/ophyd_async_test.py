"""Axes as devices of ophyd-async in a RunEngine, with the real daemon. Skipped without ophyd-async."""

import asyncio
import threading
import time
import unittest
from unittest import mock

from axisgate import LeaseHeld, OutcomeUnknown, OutsideTravel, Stopped, StoppedBy, mm
from daemon import DaemonTest, wait_until

try:
    from bluesky import RunEngine, plan_stubs, plans, preprocessors, protocols
    from bluesky.run_engine import call_in_bluesky_event_loop
    from bluesky.simulators import check_limits
    from bluesky.utils import FailedStatus, RunEngineInterrupted
    from ophyd_async.core import AsyncReadable, AsyncStageable, NotConnectedError, init_devices
    from axisgate.ophyd_async import StageAxis, StageConnection
except ImportError:
    RunEngine = None


class EngineTest:
    """A RunEngine with its documents."""

    def make_engine(self):
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


@unittest.skipIf(RunEngine is None, "ophyd-async is not installed")
class InARunEngine(EngineTest, DaemonTest):
    def setUp(self):
        super().setUp()
        self.make_engine()
        self.connection = StageConnection(self.daemon.socket)
        self.addCleanup(lambda: call_in_bluesky_event_loop(self.connection.close()))
        with init_devices():
            x = StageAxis(self.connection, "x")
            y = StageAxis(self.connection, 2, "sample_y")
        self.x, self.y = x, y
        self.observer = self.open()

    def another(self):
        with mock.patch("axisgate._target.SESSION", "another-program"):
            return self.open(self.daemon.address())

    def position(self, axis="x"):
        return float(self.observer[axis].position.value)

    def in_loop(self, work):
        return call_in_bluesky_event_loop(work)

    def test_protocols(self):
        for protocol in (protocols.Movable, protocols.Locatable, protocols.Checkable, protocols.Stoppable,
                         protocols.Subscribable, protocols.HasHints, protocols.HasParent, AsyncReadable,
                         AsyncStageable):
            self.assertIsInstance(self.x, protocol)

    def test_scans(self):
        self.engine(plans.scan([], self.x, 0, 0.4, 5))
        self.assertEqual(self.events("x"), [(0,), (0.1,), (0.2,), (0.3,), (0.4,)])
        self.documents.clear()
        self.engine(plans.rel_scan([], self.x, -0.1, 0.1, 3))
        self.assertEqual(self.events("x"), [(0.3,), (0.4,), (0.5,)])
        self.assertEqual(self.position(), 0.4)
        self.documents.clear()
        self.engine(plans.grid_scan([], self.y, 0, 0.1, 2, self.x, 0, 0.2, 3))
        self.assertEqual(self.events("sample_y", "x"),
                         [(0, 0), (0, 0.1), (0, 0.2), (0.1, 0), (0.1, 0.1), (0.1, 0.2)])
        key = next(document for name, document in self.documents if name == "descriptor")["data_keys"]["x"]
        self.assertEqual((key["units"], key["precision"], key["source"]), ("mm", 5, "axisgate:stage/x"))
        self.assertEqual(key["limits"], {"control": {"low": -15.0, "high": 15.0}})
        self.assertEqual(self.x.hints, {"fields": ["x"]})
        self.another()["x"].move_to(0 * mm)  # the leases were released

    def test_moves(self):
        self.engine(plan_stubs.mv(self.x, 0.3, self.y, -0.1))
        self.engine(plan_stubs.mvr(self.x, 0.1))
        self.assertEqual((self.position("x"), self.position("y")), (0.4, -0.1))
        with self.assertRaises(FailedStatus) as caught:
            self.engine(plan_stubs.mv(self.x, 20))
        self.assertIsInstance(caught.exception.__cause__, OutsideTravel)
        self.assertEqual(len(self.observer.motions()), 3)

    def test_check_value(self):
        check_limits(plans.scan([], self.x, 0, 10, 3))
        with self.assertRaises(OutsideTravel):
            check_limits(plans.scan([], self.x, 0, 20, 3))
        self.assertEqual(self.observer.motions(), [])

    def test_progress(self):
        updates = []

        async def moved():
            status = self.x.set(1)
            status.watch(lambda **update: updates.append(update))
            await status
        self.in_loop(moved())
        self.assertEqual((updates[0]["target"], updates[0]["unit"], updates[0]["name"]), (1, "mm", "x"))
        self.assertEqual(sorted(one["current"] for one in updates), [one["current"] for one in updates])
        self.assertTrue(0 <= updates[-1]["fraction"] <= 1)

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
        self.assertFalse(self.observer.status(max_age=0).axes["x"].moving)
        self.assertTrue(0 < self.position() < 10)
        result = self.engine.resume()
        self.assertEqual(result.exit_status, "success")
        self.assertEqual(self.events("x"), [(0,), (10,)])

    def test_abort_stops_the_axis(self):
        self.soon(lambda: self.engine.abort("a test"))
        with self.assertRaises(RunEngineInterrupted):
            self.engine(plans.scan([], self.x, 14, 0, 2))
        wait_until(lambda: self.engine.state == "idle", "the end of the plan")
        position = self.position()
        self.assertTrue(0 < position < 14)
        time.sleep(0.3)
        self.assertEqual(self.position(), position)
        self.another()["x"].move_to(0 * mm)  # the lease was released

    def test_stop_by_another_program(self):
        other = self.another()
        self.soon(lambda: other.stop("x"))
        with self.assertRaises(FailedStatus) as caught:
            self.engine(plans.scan([], self.x, 0, 14, 2))
        self.assertIsInstance(caught.exception.__cause__, Stopped)
        with self.assertRaises(FailedStatus) as caught:
            self.engine(plan_stubs.mv(self.x, 0))
        self.assertIsInstance(caught.exception.__cause__, StoppedBy)
        self.observer.rearm()
        self.engine(plan_stubs.mv(self.x, 0))

    def test_stop_at_once(self):
        """The stop comes before the daemon has answered the move."""
        async def stopped(success):
            status = self.x.set(14)
            await self.x.stop(success=success)
            await status
        self.in_loop(stopped(True))
        self.assertRaises(Stopped, self.in_loop, stopped(False))
        self.assertLess(self.position(), 14)

    def test_cancelled_status(self):
        async def cancelled(seconds):
            status = self.x.set(14)
            await asyncio.sleep(seconds)
            status.task.cancel()
            await asyncio.wait([status.task])
            await self.x.stop()
        for seconds in (0, 0.001, 0.3):
            self.in_loop(cancelled(seconds))
            wait_until(lambda: not self.observer.status(max_age=0).axes["x"].moving, "a stationary axis")
            self.assertLess(self.position(), 14)

    def test_timeout_cancels(self):
        async def moved():
            await self.x.set(14, timeout=0.3)
        self.assertRaises(asyncio.TimeoutError, self.in_loop, moved())
        self.assertRaises(Stopped, self.observer.motions()[0].wait)

    def test_stop_leaves_the_motion_of_another_program(self):
        other = self.another().start(x=0.5 * mm)
        self.in_loop(self.x.stop())
        self.assertEqual(str(other.wait()), "x 0.5 mm")

    def test_killed_daemon_fails_the_status(self):
        readings = []

        async def subscribed():
            self.x.subscribe(readings.append)

        def restart():
            self.daemon.kill()
            self.daemon.start()
        self.in_loop(subscribed())
        self.soon(restart)
        with self.assertRaises(FailedStatus) as caught:
            self.engine(plan_stubs.mv(self.x, 14))
        self.assertIsInstance(caught.exception.__cause__, OutcomeUnknown)
        wait_until(lambda: self.observer.status().link == "UP" and "x" in self.observer.status().axes, "the axis")
        self.engine(plan_stubs.mv(self.x, 0.1))
        wait_until(lambda: readings[-1]["x"]["value"] == 0.1, "the last reading")

    def test_lease(self):
        other = self.another()

        async def do(make):
            await make()
        self.in_loop(do(self.x.stage))
        self.assertRaises(LeaseHeld, other["x"].move_to, 0 * mm)
        self.in_loop(do(lambda: self.x.set(0.1)))
        self.assertRaises(RuntimeError, self.in_loop, do(self.x.stage))
        self.in_loop(do(self.x.unstage))
        with other.lease("x"):
            self.assertRaises(LeaseHeld, self.in_loop, do(self.x.stage))

        async def given():
            lease = await self.connection.stage.lease("x").acquire()
            leased = StageAxis(self.connection, "x", "x", lease=lease)
            await leased.connect()
            await leased.stage()
            await leased.set(0)
            await leased.unstage()
            self.assertRaises(LeaseHeld, other["x"].move_to, 0 * mm)
            await lease.release()
        self.in_loop(given())

    def test_reconnects(self):
        async def again():
            before = self.connection.stage
            await asyncio.gather(*(axis.connect(force_reconnect=True) for axis in (self.x, self.y)))
            after = self.connection.stage
            await self.x.connect()
            return before is not after and after is self.connection.stage
        self.assertTrue(self.in_loop(again()))
        self.engine(plan_stubs.mv(self.x, 0.1, self.y, 0.1))

    def test_unknown_axis(self):
        with self.assertRaises(NotConnectedError):
            with init_devices():
                z = StageAxis(self.connection, "nothing")  # noqa: F841


if __name__ == "__main__":
    unittest.main()
