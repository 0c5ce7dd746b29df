"""Leases, jogs, events, paths and other calls, with the real daemon."""

import contextlib
import os
import threading
import time
import unittest
from unittest import mock

from axisgate import (Arc, LeaseHeld, LeaseLost, NotAllowed, OutsideTravel, Refused, Stopped, mm, s, um)
from daemon import DaemonTest, wait_until


class SharingTest(DaemonTest):
    def setUp(self):
        super().setUp()
        self.stage = self.open()
        with mock.patch("axisgate._target.SESSION", "another-program"):
            self.other = self.open(self.daemon.address())


class Leases(SharingTest):
    def test_calls_inside_carry_the_lease(self):
        with self.stage.lease("x", purpose="a test") as lease:
            self.assertEqual(lease.axes, (1,))
            self.stage["x"].move_to(0.1 * mm)
            self.other["y"].move_to(0.1 * mm)
            with self.assertRaises(LeaseHeld) as caught:
                self.other["x"].move_to(0 * mm)
            self.assertIn("a test", caught.exception.message)
        self.other["x"].move_to(0 * mm)

    def test_lease_is_kept_alive(self):
        with self.stage.lease("x", ttl=1):
            time.sleep(3)
            self.stage["x"].move_to(0.1 * mm)

    def test_lost_lease(self):
        lost = threading.Event()
        with self.stage.lease("x", ttl=1) as lease:
            lease.on_lost(lambda _: lost.set())
            self.daemon.kill()
            self.daemon.start()
            self.assertTrue(lost.wait(10))
            self.assertTrue(lease.lost)
            self.assertRaises(LeaseLost, self.stage["x"].move_to, 1 * mm)

    def test_hand_over(self):
        lease = self.stage.lease("x")
        held = []
        waiting = threading.Thread(target=lambda: held.append(self.other.lease("x", wait=20)))
        waiting.start()
        wait_until(lambda: self._hands_over(lease), "a caller who waits")
        waiting.join()
        self.addCleanup(held[0].release)
        self.assertRaises(LeaseHeld, self.stage["x"].move_to, 0 * mm)

    def _hands_over(self, lease):
        try:
            lease.hand_over(self.other.whoami()[0])
        except Refused:
            return False
        return True

    def test_inherits_the_lease_of_axisctl(self):
        lease = self.stage.lease("x")
        self.addCleanup(lease.release)
        with mock.patch.dict(os.environ, AXISGATE_LEASE=lease.token.hex()):
            self.open()["x"].move_to(0.1 * mm)


class Jogs(SharingTest):
    def test_jog_ends_with_its_block(self):
        with self.stage.jog(x=-200 * um / s) as jog:
            time.sleep(1)
        self.assertLess(jog.result.positions["x"].value, 0)
        self.assertEqual(jog.motion.state, "SUCCEEDED")

    def test_stop_by_another_caller(self):
        with self.assertRaises(Stopped):
            with self.stage.jog(x=200 * um / s):
                self.other.stop()
                time.sleep(0.5)

    def test_refused_jog(self):
        with self.assertRaises(Refused) as caught:
            with self.stage.jog(x=1000 * mm / s):
                self.fail("the block of a refused jog runs")
        self.assertEqual(caught.exception.reason, "OUT_OF_RANGE")

    def test_exception_in_the_block(self):
        with self.assertRaises(ZeroDivisionError), self.stage.jog(x=200 * um / s) as jog:
            raise ZeroDivisionError
        self.assertTrue(jog.motion.done)


class Paths(SharingTest):
    def test_path_of_an_iterator(self):
        points = ((0.1 * i * mm, 0.05 * i * mm) for i in range(1, 11))
        result = self.stage.path(points, "xy", speed=0.5 * mm / s).wait()
        self.assertEqual(str(result), "x 1 mm, y 0.5 mm")

    def test_arcs(self):
        self.stage.move_to(x=1 * mm, y=0 * mm)
        circle = [Arc((0 * mm, 1 * mm), (-1 * mm, 0 * mm)), Arc((0 * mm, -1 * mm), (1 * mm, 0 * mm))]
        self.assertEqual(str(self.stage.path(circle, "xy", speed=1 * mm / s).wait()), "x 1 mm, y 0 mm")

    def test_points_with_too_many_axes(self):
        self.assertRaises(ValueError, list, self.stage.visit([(1 * mm, 1 * mm, 1 * mm)], "xy"))
        self.assertRaises(ValueError, self.stage.path, [(1 * mm, 1 * mm, 1 * mm)], "xy")
        self.assertEqual(self.stage.motions(), [])

    def test_iterator_that_raises(self):
        def points():
            yield 0.1 * mm, 0.1 * mm
            raise ZeroDivisionError
        self.assertRaises(ZeroDivisionError, self.stage.path, points(), "xy")
        self.assertEqual(self.stage.motions(), [])

    def test_refused_path(self):
        with self.assertRaises(OutsideTravel) as caught:
            self.stage.path([(1 * mm, 1 * mm), (20 * mm, 1 * mm)], "xy", speed=0.5 * mm / s)
        self.assertIn("segment 2", caught.exception.message)

    def test_visit_in_numpy_arrays(self):
        try:
            import numpy
        except ImportError:
            self.skipTest("NumPy is not installed")
        grid = numpy.array([[10.0, 20.0], [30.0, 40.0]]) * um
        seen = [(result.positions["x"].value, result.positions["y"].pulses) for result in self.stage.visit(grid, "xy")]
        self.assertEqual(seen, [(mm("0.01").value, 2000), (mm("0.03").value, 4000)])
        line = numpy.array([1, 2]) * um
        self.assertEqual([str(result) for result in self.stage.visit(line, "x")], ["x 0.001 mm", "x 0.002 mm"])


class Watching(SharingTest):
    def test_events_resume_over_a_restart(self):
        with self.stage.events() as events:
            first = self.stage.start(x=0.1 * mm)
            first.wait()
            seen = [self._next_end(events)]
            self.daemon.kill()
            self.daemon.start()
            second = self.stage.start(x=0.2 * mm)
            second.wait()
            kinds = []
            while len(seen) < 2:
                event = next(events)
                kinds.append(event.kind)
                if event.kind == "motion" and event.fact.name == second.name and event.fact.HasField("end_time"):
                    seen.append(event)
        self.assertIn("daemon_started", kinds)
        self.assertGreater(seen[1].revision, seen[0].revision)
        with self.stage.events(since=seen[0]) as again:
            self.assertGreater(next(again).revision, seen[0].revision)

    def test_events_resume_before_the_first_event(self):
        with self.stage.events() as events:
            self.daemon.kill()
            threading.Timer(1.5, self.daemon.start).start()
            try:
                self.assertEqual(next(events).kind, "daemon_started")
            finally:
                wait_until(lambda: "is UP" in self.daemon.log(), "the daemon")

    def _next_end(self, events):
        return next(event for event in events if event.kind == "motion" and event.fact.HasField("end_time"))

    def test_watch(self):
        states = self.stage.watch()
        self.assertEqual(next(states).link, "UP")
        self.assertIn("<td>x</td><td>0 mm</td><td>stationary</td>", self.stage.status()._repr_html_())
        motion = self.stage.start(x=1 * mm)
        self.assertTrue(next(state for state in states if state.axes["x"].moving))
        fractions = [progress.fraction for progress in motion.progress()]
        self.assertEqual(fractions, sorted(fractions))
        motion.wait()
        states.close()


    def test_samples(self):
        with self.stage.sample() as samples:
            self.stage["x"].move_to(1 * mm)
        self.assertEqual(samples.axes, ("x", "y", "3"))
        self.assertGreater(len(samples), 3)
        self.assertEqual(samples.times, sorted(samples.times))
        path = os.path.join(self.folder, "samples.csv")
        samples.to_csv(path)
        with open(path, encoding="utf-8") as file:
            self.assertEqual(len(file.readlines()), 1 + len(samples))


class Others(SharingTest):
    def test_execute(self):
        executed = self.stage.execute("M:1+P1000", "G:1")
        self.assertEqual(executed.answers, ["OK", "OK"])
        executed.motion.wait()
        self.assertIsNone(self.stage.execute("?:N").motion)
        self.assertEqual(self.stage["x"].pulses, 1000)
        with self.assertRaises(Refused) as caught:
            self.stage.execute("NO:1")
        self.assertEqual(caught.exception.reason, "UNKNOWN_COMMAND")

    def test_places(self):
        self.stage["x"].move_to(0.5 * mm)
        self.stage.places.save("sample")
        self.stage["x"].move_to(0 * mm)
        self.assertEqual(self.stage.places.move_to("sample").positions["x"].pulses, 50000)
        self.assertEqual(list(self.stage.places), ["sample"])
        self.stage.places.delete("sample")
        self.assertEqual(self.stage.places.read(), {})

    def test_settings(self):
        self.stage.settings.change("x", maximum_speed=100 * um / s, motor_on=False)
        settings = self.stage.settings.read().axes[0]
        self.assertEqual((settings.excited, settings.speeds.maximum.pulses_per_s), (False, 10000))
        with self.assertRaises(Refused) as caught:
            self.stage["x"].move_to(1 * mm)
        self.assertIn("stage.settings.change", caught.exception.hint)

    def test_tokens(self):
        self.assertEqual(self.stage.whoami()[1], "admin")
        self.assertEqual(self.other.whoami()[1], "operator")
        with self.assertRaises(NotAllowed) as caught:
            self.open(token="axisgate.wrong.00").status()
        self.assertEqual(caught.exception.reason, "UNAUTHENTICATED")

    def test_after_fork(self):
        child = os.fork()
        if child == 0:
            with contextlib.suppress(BaseException):
                try:
                    self.stage.status()
                except RuntimeError:
                    os._exit(0)
            os._exit(1)
        self.assertEqual(os.waitpid(child, 0)[1], 0)

    def test_closed(self):
        self.stage.close()
        self.assertRaises(RuntimeError, self.stage.status)


if __name__ == "__main__":
    unittest.main()
