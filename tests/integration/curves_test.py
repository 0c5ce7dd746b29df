#!/usr/bin/env python3
"""Arcs, rests, waits for inputs, approaches and scans, by axisctl, on a simulated stage."""

import json
import re
import tempfile
import time
import unittest

from programs import Daemon

CONFIG = """
listen = "127.0.0.1:0"
metrics = "127.0.0.1:0"
socket = "{socket}"

[[device]]
name = "stage"
connection = "simulated"
EXTRA

[[device.axis]]
number = 1
name = "x"
unit = "mm"
travel_minimum = "-0.3mm"
travel_maximum = "0.3mm"

[[device.axis]]
number = 2
name = "y"
unit = "um"
"""


class OnAStage(unittest.TestCase):
    """Every test gets a daemon of its own, whose simulator has just been switched on: all axes at 0."""

    extra = ""

    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="axisctl-curves-")
        self.addCleanup(folder.cleanup)
        self.daemon = Daemon(folder.name, CONFIG.replace("EXTRA", self.extra))
        self.addCleanup(lambda: self.daemon.stop())

    def ok(self, *arguments, stdin=""):
        answer = self.daemon.run(*arguments, stdin=stdin)
        self.assertEqual((answer.returncode, answer.stderr), (0, ""), arguments)
        return answer.stdout

    def done(self, where, *arguments, stdin=""):
        self.assertEqual(self.ok(*arguments, stdin=stdin).splitlines()[-1], f"done: {where}", arguments)

    def refused(self, code, reason, *arguments, stdin=""):
        answer = self.daemon.run(*arguments, stdin=stdin)
        self.assertRegex(answer.stderr, rf"\Aaxisctl: {reason}: [^\n]+\n\Z", arguments)
        self.assertEqual(answer.returncode, code, answer.stderr)
        return answer.stderr

    def written(self):
        """The lines that went to the controller, in their order."""
        return re.findall(r'> "([^"]*?)\\r\\n"', self.ok("record", "--no-follow"))


class Curves(OnAStage):
    def test_a_line_and_arcs(self):
        self.done("axis x at 0.1 mm, axis y at -50 um", "line", "1=0.1mm", "2=-50um", "--speed", "1mm/s")
        self.done("axis x at 0.15 mm, axis y at 0 um", "arc", "around", "1=0", "2=50um", "ccw", "90deg", "--speed", "1mm/s")
        self.done("axis x at 0.2 mm, axis y at 20 um", "arc", "through", "x=20um", "y=30", "to", "x=0.05", "y=20", "speed=1mm/s")
        self.done("axis x at 0.15 mm, axis y at 0 um", "arc", "through", "1=0.18mm", "2=30um", "to", "1=0.15mm", "2=0", "--absolute",
                  "--speed", "1mm/s")
        self.assertTrue(any(line.startswith("EP:1A1") for line in self.written()), self.written())

    def test_a_helix(self):
        self.done("axis x at 0 mm, axis y at 0 um, axis 3 at -20 um", "arc", "around", "1=0", "2=50um", "cw", "2turns", "rise", "3=-10um",
                  "--speed", "1mm/s")

    def test_a_path_of_both_with_a_rest(self):
        path = "1=0.1mm 2=0\naround 1=0 2=50um ccw 180deg   # to the other side\nrest=0.5s 1=-0.1mm 2=0\n"
        begin = time.monotonic()
        self.done("axis x at 0 mm, axis y at 100 um", "path", "-", "--speed", "1mm/s", stdin=path)
        self.assertGreaterEqual(time.monotonic() - begin, 0.5)

    def test_the_whole_curve_stays_within_the_travel(self):
        self.refused(3, "OUTSIDE_TRAVEL", "arc", "around", "1=0.2mm", "2=0", "cw", "1turn")
        self.assertEqual(self.ok("position"), "axis x  0 mm\naxis y  0 um\naxis 3  0 um\n")

    def test_three_points_on_one_line_are_no_arc(self):
        self.assertIn("lie on one line", self.refused(3, "INVALID_REQUEST", "arc", "through", "1=1um", "2=1um", "to",
                                                      "1=2um", "2=2um"))


class Typed(OnAStage):
    def test_what_a_segment_must_have_is_said_with_file_and_line(self):
        for segment, what in (("around 1=0 2=1mm", "the arc has no direction"),
                              ("around 1=0 2=1mm 90deg", "is not the direction of an arc"),
                              ("around 1=0 2=1mm ccw", "the arc has no angle"),
                              ("around 1=0 2=1mm ccw 90", "is not the angle of an arc"),
                              ("around 1=0 2=1mm ccw 0.5turns", "is not the angle of an arc"),
                              ("around 1=0 ccw 90deg", "the center of an arc has two coordinates, not 1"),
                              ("through 1=1mm 2=1mm 1=2mm 2=0", "the point of an arc has two coordinates, not 4"),
                              ("through 1=1mm 2=1mm", "the arc has no end point"),
                              ("through 1=1mm 2=1mm to 1=2mm", "the end of an arc has two coordinates, not 1"),
                              ("around 1=0 2=1mm cw 1turn rise", "a rise has one axis"),
                              ("around 1=0 2=1mm cw 1turn 3=1um", '"3=1um" is not expected here'),
                              ("around 1=0 2=1mm cw 1turn rise 3=1um twice", '"twice" is not expected here'),
                              ("arround 1=0 2=1mm cw 1turn", '"arround" does not begin a segment'),
                              ("1=1mm 2", '"2" is not expected here'),
                              ("1=1mm rest=0.5", "is not a waiting time"),
                              ("1=1mm rest=255.001s", "is not a waiting time"),
                              ("1=1mm inputs=64", "the inputs"),
                              ("rest=1s", "no axis is named")):
            with self.subTest(segment):
                told = self.refused(2, "INVALID_REQUEST", "path", "-", stdin=f"# one\n{segment}\n")
                self.assertIn("standard input:2: ", told)
                self.assertIn(what, told)

    def test_each_verb_runs_its_own(self):
        self.assertIn("axisctl arc", self.refused(2, "INVALID_REQUEST", "line", "around", "1=0", "2=1", "cw", "1turn"))
        self.assertIn("axisctl line", self.refused(2, "INVALID_REQUEST", "arc", "1=1um", "2=1um"))
        for arguments in (("scan", "1", "0"), ("scan", "1", "0", "1um"), ("scan", "1", "0", "1um", "--every", "1"),
                          ("scan", "1", "0", "1um", "--every", "30001"), ("line",), ("arc",)):
            self.refused(2, "INVALID_REQUEST", *arguments)

    def test_what_the_daemon_refuses_names_the_segment(self):
        around = ("arc", "around", "1=0", "2=10um", "cw")
        for arguments, reason, what in (((*around, "2turns"), "OUT_OF_RANGE", "segment 1: a circle of 2 turns"),
                                        ((*around, "1turn", "rise", "2=1um"), "INVALID_REQUEST", "along axis 3"),
                                        (("arc", "around", "1=0", "1=10um", "cw", "90deg"), "INVALID_REQUEST", "twice")):
            self.assertIn(what, self.refused(3, reason, *arguments))

    def test_inputs_start_nothing(self):
        told = self.refused(3, "NOT_ALLOWED", "path", "-", stdin="1=1um\n1=1um inputs=5\n")
        self.assertIn("segment 2", told)
        self.assertIn("wait_for_inputs", told)
        self.assertEqual(self.ok("position").splitlines()[0], "axis x  0 mm")


class WithInputs(OnAStage):
    extra = "wait_for_inputs = true"

    def test_a_path_goes_on_when_they_show_it(self):
        self.assertEqual(self.ok("sim", "inputs", "1"), "OK\n")
        with tempfile.NamedTemporaryFile("w", encoding="utf-8") as file:
            file.write("1=0.1mm 2=0\n1=0.2mm 2=0 inputs=5\n")
            file.flush()
            path = self.daemon.start("path", file.name, "--speed", "1mm/s")
            self.addCleanup(path.kill)
            path.until("segment 1 done")
        self.assertEqual(self.ok("position").splitlines()[0], "axis x  0.1 mm")
        self.assertEqual(self.ok("sim", "inputs", "5"), "OK\n")
        self.assertEqual(path.until("done: "), "done: axis x at 0.3 mm, axis y at 0 um")
        self.assertEqual(path.end(), 0)


class Approach(OnAStage):
    def test_the_target_is_reached_from_one_side(self):
        self.done("axis x at 0.1 mm, axis y at -50 um", "move", "1=0.1mm", "2=-50um", "--approach=-10um", "--speed", "1mm/s")
        # Beyond the targets first, by 1000 pulses of 10 nm.
        self.assertTrue(any(re.match(r"[AM]P?:A\+P11000-P4000", line) for line in self.written()), self.written())
        self.done("axis x at 0.05 mm", "move", "1=0.05mm", "--approach", "0.01", "--speed", "1mm/s")

    def test_it_stays_within_the_travel_and_is_not_0(self):
        self.refused(3, "OUTSIDE_TRAVEL", "move", "1=0.295mm", "--approach=-10um")
        self.refused(3, "INVALID_REQUEST", "move", "1=0.1mm", "--approach", "0um")
        self.refused(2, "UNKNOWN_UNIT", "move", "1=0.1mm", "--approach", "1inch")


class Scans(OnAStage):
    def test_what_a_scan_came_to_and_the_trigger_afterwards(self):
        self.ok("trigger", "every", "500", "--axis", "2")
        told = self.ok("scan", "x", "0mm", "0.1005mm", "--every", "1000").splitlines()[-1]
        ran = re.fullmatch(r"done: axis x at (\S+) mm; axis x ran from (\S+) mm to (\S+) mm; "
                           r"11 trigger pulses expected in the range, (\d+) in all; "
                           r"(\d+) computed from the observed displacement", told)
        self.assertTrue(ran, told)
        self.assertEqual(ran[1], ran[3])
        self.assertLess(float(ran[2]), 0)
        self.assertGreater(float(ran[3]), 0.1005)
        self.assertEqual(ran[4], ran[5])
        self.assertIn("T:P1P1000", self.written())
        self.assertEqual(self.ok("exec", "?:T"), "0,2,500\n")

    def test_backwards_by_the_scale_and_for_programs(self):
        shown = self.ok("--json", "scan", "2", "-10um", "-60.5um", "--every", "500", "--scale", "--speed", "100um/s")
        motion = json.loads(shown.splitlines()[-1])["motion"]
        self.assertEqual(motion["kind"], "MOTION_KIND_SCAN")
        self.assertEqual(motion["state"], "MOTION_STATE_SUCCEEDED")
        self.assertGreater(int(motion["scan"]["run_from_pulses"]), -1000)
        self.assertLess(int(motion["scan"]["run_to_pulses"]), -6050)
        self.assertIn("T:E2P-500", self.written())

    def test_what_cannot_be_is_refused_and_nothing_moves(self):
        self.refused(3, "TOO_FAST", "scan", "x", "0mm", "0.1mm", "--every", "100", "--speed", "56001pulse/s")
        self.refused(3, "OUTSIDE_TRAVEL", "scan", "x", "0mm", "0.31mm", "--every", "100")
        self.refused(3, "OUTSIDE_TRAVEL", "scan", "x", "0mm", "0.3mm", "--every", "100")  # it slows down behind it
        self.refused(3, "UNKNOWN_UNIT", "scan", "x", "0deg", "1deg", "--every", "100")
        self.refused(2, "UNKNOWN_AXIS", "scan", "w", "0mm", "1mm", "--every", "100")
        self.assertEqual(self.ok("position"), "axis x  0 mm\naxis y  0 um\naxis 3  0 um\n")


if __name__ == "__main__":
    unittest.main(verbosity=2)
