#!/usr/bin/env python3
"""What deploy/quickstart.sh shows of the mill, with its own configuration; real_tty_test.py has that of the stage."""

import re
import subprocess
import tempfile
import time
import unittest

from programs import BIN, LIMIT_S, ROOT, Daemon

DEMO = ROOT / "deploy" / "demo"
ENDPOINTS = 'listen = "127.0.0.1:0"\nmetrics = "127.0.0.1:0"\nsocket = "{socket}"\n'


class Demonstration(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="axisgate-demo-")
        self.addCleanup(folder.cleanup)
        self.daemon = Daemon(folder.name, ENDPOINTS + (DEMO / "axisgate.toml").read_text(encoding="utf-8"))
        self.addCleanup(lambda: self.daemon.stop())
        deadline = time.monotonic() + LIMIT_S
        while "  line open\n" not in self.daemon.run("mill", "queue").stdout:
            self.assertLess(time.monotonic(), deadline, "the line to the mill does not open")
            time.sleep(0.05)  # between two looks; the deadline above decides

    def show(self):
        return subprocess.run([DEMO / "mill.sh", BIN / "axisctl", "--target", self.daemon.socket], capture_output=True,
                              text=True, timeout=4 * LIMIT_S, check=False)

    def test_of_the_mill(self):
        shown = self.show()
        self.assertEqual((shown.returncode, shown.stderr), (0, ""), shown.stdout)
        self.assertRegex(shown.stdout, r"(?s)QUEUED.* is confirmed by .* FED: all was sent.*\njob 1 is DONE\n")
        for state in ("QUEUED", "CONFIRMED", "RUNNING", "FED", "DONE"):
            self.assertRegex(shown.stdout, rf"  mill  job 1 is {state}\b")

    def test_the_first_step_that_fails_ends_it(self):
        self.daemon.run("mill", "send", "-", stdin="^IN;PU0,0;H;")
        self.daemon.run("mill", "confirm", "--yes")
        self.daemon.run("mill", "start")
        shown = self.show()  # nothing can be confirmed while a job runs
        self.assertEqual(shown.returncode, 3, shown.stdout)
        self.assertRegex(shown.stderr, r'demonstration: the step "axisctl mill confirm --yes" failed with exit code 3\n\Z')
        self.assertIsNone(re.search("is DONE", shown.stdout))


if __name__ == "__main__":
    unittest.main(verbosity=2)
