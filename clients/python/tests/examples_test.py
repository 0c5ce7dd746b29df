"""The examples, run as programs against the real daemon; their numbers are compared with what the stage did."""

import csv
import importlib.util
import os
import pathlib
import re
import subprocess
import sys
import unittest
from decimal import Decimal

from axisgate import Stage, mm
from axisgate.v1.motion_pb2 import MOTION_STATE_SUCCEEDED
from daemon import LIMIT_S, DaemonTest, Relay, wait_until

HERE = pathlib.Path(__file__).resolve().parent
SECOND_STAGE = """
[[device]]
name = "fine"
connection = "simulated"
[[device.axis]]
number = 1
name = "x"
unit = "mm"
"""


class ExampleTest(DaemonTest):
    def begin(self, name, target=None):
        environment = dict(os.environ, AXISGATE_TARGET=target or self.daemon.socket,
                           PYTHONPATH=str(HERE.parent / "src"))
        process = subprocess.Popen([sys.executable, str(HERE.parent / "examples" / name)], cwd=self.folder,
                                   env=environment, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        self.addCleanup(process.__exit__, None, None, None)
        self.addCleanup(process.kill)
        return process

    def end(self, process):
        output, errors = process.communicate(timeout=4 * LIMIT_S)
        self.assertEqual((process.returncode, errors), (0, ""))
        return output

    def rows(self, name):
        with open(os.path.join(self.folder, name), newline="", encoding="utf-8") as file:
            return list(csv.reader(file))

    def done_motions(self):
        """The positions at the ends of the motions that succeeded, in order, as the daemon recorded them."""
        return [tuple(one.position for one in motion.results) for motion in self.succeeded()]

    def succeeded(self):
        """The API's messages of the motions that succeeded, in order."""
        return [motion._message for motion in reversed(self.open().motions()) if motion.state == "SUCCEEDED"]

    def every_success(self):
        """The API's messages of the motions that succeeded, in order, also in earlier runs of the daemon."""
        stage = self.open()
        last = stage.start(relative=True, x=0.001 * mm)
        last.wait()
        found = []
        for event in stage.events(since=0):
            if event.kind == "motion" and event.fact.name == last.name and event.fact.HasField("end_time"):
                return found
            if event.kind == "motion" and event.fact.state == MOTION_STATE_SUCCEEDED:
                found.append(event.fact)


class OneStage(ExampleTest):
    def test_move_and_wait(self):
        output = self.end(self.begin("move_and_wait.py"))
        self.assertRegex(output, r"\d+%  x [\d.]+ mm\n(.*\n)*arrived: x 2 mm in [\d.]+ s")
        self.assertEqual(self.done_motions(), [("2",)])
        self.assertEqual(self.daemon.at_stage("position 1"), "ok 200000")

    def test_raster(self):
        self.assertIn("48/48", self.end(self.begin("raster.py")))
        rows = self.rows("raster.csv")[1:]
        self.assertEqual([(x, y) for x, y, _ in rows], self.done_motions())
        expected = [(Decimal(column * 5) / 100, Decimal(row * 5) / 100) for row in range(6)
                    for column in (range(8) if row % 2 == 0 else reversed(range(8)))]
        self.assertEqual([(Decimal(x), Decimal(y)) for x, y, _ in rows], expected)
        if importlib.util.find_spec("matplotlib") is None:
            with open(os.path.join(self.folder, "raster.pgm"), encoding="ascii") as file:
                lines = file.read().splitlines()
            self.assertEqual((lines[0], len(lines), len(lines[1].split())), ("P2 8 6 255", 7, 8))
            self.assertEqual(lines[6].split()[0], str(round(255 * float(rows[0][2]))))

    def test_line_scan(self):
        output = self.end(self.begin("line_scan.py"))
        rows = self.rows("line.csv")[1:]
        given = int(re.search(r"\d+", self.daemon.at_stage("triggers"))[0])
        self.assertEqual(len(rows), given)
        self.assertIn(f"{given} pulses, 101 of them", output)
        inside = [Decimal(position) for _, position in rows if 0 <= Decimal(position) <= 1]
        self.assertEqual(inside, [Decimal(number) / 100 for number in range(101)])

    def test_circle(self):
        output = self.end(self.begin("circle.py"))
        self.assertIn("back at x 0.5 mm, y 0 mm", output)
        count, error = re.search(r"(\d+) positions, at most ([\d.]+) um", output).groups()
        self.assertGreater(int(count), 5)
        self.assertLess(float(error), 1)
        rows = [row[1:3] for row in self.rows("circle.csv")[1:]]
        for quadrant in ((1, 1), (-1, 1), (-1, -1), (1, -1)):
            self.assertTrue(any(float(x) * quadrant[0] > 0 and float(y) * quadrant[1] > 0 for x, y in rows), quadrant)
        self.assertEqual(self.succeeded()[-1].segments_done, 2)

    def test_overnight(self):
        relay = Relay(self.folder, self.daemon.socket)
        self.addCleanup(relay.end)
        path = os.path.join(self.folder, "overnight.csv")

        def until(count):
            try:
                wait_until(lambda: os.path.exists(path) and len(self.rows("overnight.csv")) >= count, f"{count} points")
            except AssertionError as error:
                process.kill()
                raise AssertionError(f"{error}: {process.communicate()}") from error

        process = self.begin("overnight.py", relay.socket)
        until(4)
        relay.cut_answers(stream=1, times=2)  # a broken connection
        until(8)
        self.daemon.kill()
        self.daemon.start()
        until(12)
        process.kill()  # its own restart
        process.communicate()
        output = self.end(self.begin("overnight.py", relay.socket))
        self.assertIn("all 30 points are done", output)
        expected = [(Decimal(column) / 10, Decimal(row) / 10) for row in range(5) for column in range(6)]
        rows = self.rows("overnight.csv")
        self.assertEqual([(Decimal(x), Decimal(y)) for x, y, _ in rows], expected)
        self.assertGreaterEqual(relay.cuts, 1)
        reached = [tuple(Decimal(one.position) for one in motion.results) for motion in self.every_success()]
        once = [at for number, at in enumerate(reached) if reached[number - 1:number] != [at]]
        self.assertEqual(once, expected)  # only the move that the kill interrupted may be repeated
        self.assertLessEqual(len(reached), len(once) + 1)


class TwoStages(ExampleTest):
    more = SECOND_STAGE

    def test_two_stages(self):
        output = self.end(self.begin("two_stages.py"))
        self.assertEqual(output.splitlines(), ["stages: stage, fine", "stage: x 0.5 mm | fine: x -0.5 mm",
                                               "stage: x 1 mm | fine: x -1 mm"])
        for name, pulses in (("stage", 100000), ("fine", -100000)):
            stage = self.open(device=name)
            self.assertEqual((stage["x"].pulses, len(stage.motions())), (pulses, 2))
        self.assertEqual(Stage.find(self.daemon.socket), ["stage", "fine"])


if __name__ == "__main__":
    unittest.main()
