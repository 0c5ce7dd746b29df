#!/usr/bin/env python3
"""Places with names: saved, listed, gone to and forgotten by axisctl, on a real daemon and a simulated stage."""

import json
import os
import re
import subprocess
import tempfile
import time
import unittest

from programs import BIN, LIMIT_S, Daemon

CONFIG = """
listen = "127.0.0.1:0"
metrics = "127.0.0.1:0"
socket = "{socket}"

[[device]]
name = "stage"
connection = "simulated"
speed = 20

[[device.axis]]
number = 1
name = "x"
unit = "mm"
travel_maximum = "5mm"
"""


class Positions(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="axisctl-positions-")
        self.addCleanup(folder.cleanup)
        self.folder = folder.name
        self.daemon = Daemon(self.folder, CONFIG)
        self.addCleanup(lambda: self.daemon.stop())

    def ok(self, *arguments):
        answer = self.daemon.run(*arguments)
        self.assertEqual((answer.returncode, answer.stderr), (0, ""), arguments)
        return answer.stdout

    def refused(self, code, reason, *arguments):
        answer = self.daemon.run(*arguments)
        self.assertRegex(answer.stderr, rf"\Aaxisctl: {reason}: [^\n]+\n\Z", arguments)
        self.assertEqual(answer.returncode, code, answer.stderr)
        return answer.stderr

    def controller(self, line):
        return self.ok("exec", line).strip()

    def reset(self):
        epoch = self.epoch()
        self.assertEqual(self.ok("reset"), "OK\n")
        deadline = time.monotonic() + LIMIT_S
        while self.epoch() == epoch or "  UP" not in self.ok("devices"):
            self.assertLess(time.monotonic(), deadline, "the device does not come back")
            time.sleep(0.05)  # between two looks; the deadline above decides

    def epoch(self):
        return json.loads(self.ok("--json", "devices"))["device_epoch"]

    def at(self):
        return self.ok("position").splitlines()[0]

    def test_there_and_back(self):
        self.assertEqual(self.ok("positions"), "no saved positions\n")
        self.assertEqual(self.ok("--json", "positions"), "")
        self.ok("move", "x=1.5", "2=200um")
        self.assertEqual(self.ok("save", "sample"), "sample: axis x at 1.5 mm, axis 2 at 200 um, axis 3 at 0 um\n")
        self.ok("move", "x=0", "2=0")
        self.assertRegex(self.ok("positions"),
                         r"\Asample  place 1  axis x at 1\.5 mm, axis 2 at 200 um, axis 3 at 0 um  saved "
                         r"\d{4}-\d\d-\d\d \d\d:\d\d:\d\d[+-]\d\d:\d\d by "
                         r"\w+ \S+\n\Z")
        shown = self.ok("go", "sample")
        self.assertEqual(shown.splitlines()[-1], "done: axis x at 1.5 mm, axis 2 at 200 um, axis 3 at 0 um")
        self.assertRegex(shown, r"axis 1 completed")
        self.assertEqual(self.at(), "axis x  1.5 mm")
        self.assertEqual(self.ok("forget", "sample"), "OK\n")
        self.refused(3, "NOT_FOUND", "go", "sample")
        self.refused(3, "NOT_FOUND", "forget", "sample")
        answer = self.daemon.run("exec", "PIT:GET,1")
        self.assertEqual(answer.stdout, "NG\n")

    def test_not_waited_for(self):
        self.ok("save", "sample", "--wait", "5")
        self.ok("move", "x=1")
        self.assertRegex(self.ok("go", "sample", "--no-wait"), r"\Astarted: motion \d+\n\Z")

    def test_as_json(self):
        self.ok("move", "x=1")
        saved = json.loads(self.ok("--json", "save", "sample", "--coordinates"))
        self.assertEqual((saved["name"], saved["kind"], saved["number"], saved["emptied"]),
                         ("devices/stage/positions/sample", "POSITION_KIND_COORDINATES", 1, False))
        self.assertEqual(saved["coordinates"][0], {"axis": 1, "pulses": "100000", "name": "x", "unit": "UNIT_MILLIMETERS",
                                                    "position": "1"})
        self.assertEqual(json.loads(self.ok("--json", "positions")), saved)
        last = json.loads(self.ok("--json", "go", "sample").splitlines()[-1])
        self.assertEqual(last["motion"]["state"], "MOTION_STATE_SUCCEEDED")
        self.assertEqual(json.loads(self.ok("--json", "forget", "sample")), {})

    def test_a_name_that_is_there(self):
        self.ok("save", "sample")
        self.ok("move", "x=1")
        self.assertIn("named \"sample\" already", self.refused(3, "INVALID_REQUEST", "save", "sample", "--keep"))
        self.ok("save", "other", "--keep")
        self.ok("save", "sample")
        self.ok("move", "x=0")
        self.ok("go", "sample")
        self.assertEqual(self.at(), "axis x  1 mm")
        self.refused(3, "INVALID_REQUEST", "save", "a.b")
        self.refused(2, "INVALID_REQUEST", "save")

    def test_places_and_coordinates(self):
        self.ok("move", "x=1")
        self.ok("save", "place")
        self.ok("save", "numbers", "--coordinates")
        self.ok("move", "x=3")
        self.ok("zero", "x")
        self.ok("go", "place")
        self.assertEqual(self.at(), "axis x  -2 mm")
        self.ok("go", "numbers")
        self.assertEqual(self.at(), "axis x  1 mm")

    def test_travel_limits_hold(self):
        self.ok("preset", "x=6mm")
        self.ok("save", "far")
        self.assertIn("5mm", self.refused(3, "OUTSIDE_TRAVEL", "go", "far"))

    def test_a_reset_empties_places_and_says_so(self):
        self.ok("move", "x=1")
        self.ok("save", "place")
        self.ok("save", "numbers", "--coordinates")
        self.reset()
        listed = self.ok("positions").splitlines()
        self.assertNotIn("may have forgotten", listed[0])
        self.assertIn("the controller may have lost it", listed[1])
        told = self.refused(3, "EPOCH_PASSED", "go", "place")
        self.assertRegex(told, r'"place" is no longer there: .*PIT:.* came back \d+ s ago.*restarted.*'
                               r'axisctl save`\)')
        self.assertEqual(self.at(), "axis x  0 mm")
        self.ok("go", "numbers")
        self.assertEqual(self.at(), "axis x  1 mm")
        self.ok("save", "place")
        self.ok("go", "place")
        self.reset()
        self.assertEqual(self.ok("forget", "place"), "OK\n")

    def test_a_number_that_somebody_else_uses(self):
        self.ok("save", "sample")
        self.ok("move", "x=1")
        self.controller("PIT:SET,1")
        self.assertIn("100000,0,0", self.refused(3, "EPOCH_PASSED", "go", "sample"))
        self.ok("save", "sample")
        self.ok("go", "sample")

    def restart_daemon(self):
        self.daemon.stop()
        self.daemon = Daemon(self.folder, CONFIG)

    def test_names_outlive_the_daemon(self):
        """With the daemon its simulator starts anew, which has forgotten the place."""
        self.ok("move", "x=1")
        self.ok("save", "place")
        before = self.ok("positions")
        self.restart_daemon()
        self.assertEqual(self.ok("positions"), before.rstrip("\n") + "  the controller may have lost it\n")
        self.refused(3, "EPOCH_PASSED", "go", "place")

    def test_a_file_that_is_none_is_not_taken_for_an_empty_one(self):
        self.ok("save", "sample")
        path = os.path.join(self.folder, "state", "positions")
        self.daemon.stop()
        with open(path, "a", encoding="utf-8") as file:
            file.write("stage half\n")
        environment = dict(os.environ, STATE_DIRECTORY=os.path.join(self.folder, "state"))
        failed = subprocess.run([BIN / "axisgated", "--config", os.path.join(self.folder, "axisgate.toml")],
                                env=environment, capture_output=True, text=True, timeout=LIMIT_S, check=False)
        self.assertEqual(failed.returncode, 1)
        self.assertRegex(failed.stderr, re.escape(path) + r":3: is no saved position")


if __name__ == "__main__":
    unittest.main(verbosity=2)
