#!/usr/bin/env python3
"""A path of 60 ms segments over a pty paced as at 38400 baud, while sixteen clients ask for the status without a pause and
sixteen more ask a question of their own each. $AXISGATE_SEGMENTS says how long the path is; 10,000 take ten minutes."""

import os
import re
import subprocess
import tempfile
import unittest

from programs import BIN, LIMIT_S, Daemon, Lines

SEGMENTS = int(os.environ.get("AXISGATE_SEGMENTS", "300"))
# None where it is to be proved. Among other tests the host itself may stand still for a segment's time, now and then.
UNDERRUNS_MAX = 0 if "AXISGATE_SEGMENTS" in os.environ else SEGMENTS // 100
CONTRAST_SEGMENTS_MAX = 100  # each underrun takes nearly half a second
SEGMENT_S = 0.06
CONFIG = """
listen = "127.0.0.1:0"
metrics = "127.0.0.1:0"
socket = "{socket}"

[[device]]
name = "stage"
connection = "serial"
path = "TTY"
baud = 38400
"""
RESULT = re.compile(r"path: MOTION_STATE_(\w+), segments (\d+), chained (\d+), underruns (\d+), took \d+ s, "
                    r"due at (-?\d+) (-?\d+)$", re.MULTILINE)


class PacedPath(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        # A controller does not wait for its turn, and how a busy machine shares its time is not what is shown here.
        # What is started from here inherits it.
        try:
            os.sched_setscheduler(0, os.SCHED_FIFO, os.sched_param(1))
        except PermissionError:
            return
        cls.addClassCleanup(os.sched_setscheduler, 0, os.SCHED_OTHER, os.sched_param(0))

    def start(self, program):
        folder = tempfile.TemporaryDirectory(prefix="axisgate-paced-")
        self.addCleanup(folder.cleanup)
        tty = os.path.join(folder.name, "tty")
        simulator = Lines([BIN / "shrc203-sim", "--pty", tty, "--baud", "38400"])
        self.addCleanup(simulator.kill)
        simulator.until("simulator on")
        self.daemon = Daemon(folder.name, CONFIG.replace("TTY", tty), program=program)
        self.addCleanup(self.daemon.stop)

    def load(self, segments, milliseconds=60):
        return subprocess.run(
            [BIN / "axisgate-paced-load", "--target", "unix:" + self.daemon.socket, "--segments", str(segments),
             "--milliseconds", str(milliseconds)],
            capture_output=True, text=True, check=False, timeout=2 * LIMIT_S + 5 * segments * SEGMENT_S)

    def run_path(self, segments):
        shown = self.load(segments).stdout
        print("\n" + shown, end="", flush=True)
        result = RESULT.search(shown)
        self.assertIsNotNone(result, shown)
        state, done, chained, underruns, *due = result.groups()
        self.assertEqual((state, int(done)), ("SUCCEEDED", segments), shown)
        # The counter as the controller tells it, not as the daemon remembers it.
        counter = self.daemon.run("exec", "Q:SPC").stdout
        self.assertTrue(counter.startswith("P{:+d},P{:+d},".format(*map(int, due))), counter + shown)
        for kind in ("status", "questions"):
            self.assertRegex(shown, rf"(?m)^{kind}: answered [1-9]\d*, failed 0, ", shown)
        return int(chained), int(underruns), shown

    def test_no_underrun_while_all_ask(self):
        self.start("axisgated")
        chained, underruns, shown = self.run_path(SEGMENTS)
        self.assertLessEqual(underruns, UNDERRUNS_MAX, shown)
        self.assertEqual(chained, SEGMENTS - 1 - underruns, shown)

    def test_for_contrast_refills_that_do_not_go_first(self):
        self.start("axisgated-contrast")
        segments = min(SEGMENTS, CONTRAST_SEGMENTS_MAX)
        _, underruns, shown = self.run_path(segments)
        self.assertGreater(underruns, segments // 10, shown)

    def test_what_the_line_cannot_feed_is_refused(self):
        self.start("axisgated")
        refused = self.load(50, milliseconds=10)
        self.assertEqual(refused.returncode, 1)
        self.assertRegex(refused.stdout, r"path: segment 1 takes 10\.0 ms, [^\n]*: the shortest feasible segment time is "
                                         r"1\d(\.\d)? ms")


if __name__ == "__main__":
    unittest.main()
