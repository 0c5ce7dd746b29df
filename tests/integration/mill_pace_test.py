#!/usr/bin/env python3
"""The pace of a mill behind a pseudo-terminal, measured by a job that the daemon sends as fast as XOFF lets it, and what a
paced job gains by it.

The mill runs 20 times as fast as its profile says, less 20 %. A busy machine makes it slower than that, so only the range's
high end is compared with it.
"""

import json
import pathlib
import re
import tempfile
import unittest

from mill_pty import CONFIG, Gateway, PtyMill, profile_text
from programs import Daemon

SPEED, SLOWER_PERCENT = 20, 20
TRUTH = (1 + SLOWER_PERCENT / 100) / SPEED
IN_TERMINAL = 20_480
SETTINGS = f"""baud = 1000000
buffer = 512
converter = {IN_TERMINAL}
slack = "measured"
"""


class MillPace(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="axisctl-pace-")
        self.addCleanup(folder.cleanup)
        path = pathlib.Path(folder.name)
        mill = PtyMill(path, "mill", profile_text(), "xon", "--buffer", 512, "--baud", 1_000_000, "--speed", SPEED, "--slower",
                       SLOWER_PERCENT, "--option", "acceleration=worst", settings=SETTINGS)
        self.addCleanup(mill.end)
        self.daemon = Daemon(folder.name, CONFIG + mill.table)
        self.addCleanup(lambda: self.daemon.stop())
        self.gateway = Gateway(self.daemon, mill)
        self.daemon.wait_for_log("mill: the line is open")

    def pace(self):
        page = self.daemon.metrics_page()
        return [float(re.search(rf'(?m)^axisgate_mill_pace_ratio{{bound="{bound}",device="mill"}} (\S+)$', page)[1])
                for bound in ("least", "most")]

    def feed(self, job, *options):
        """Until the daemon says that it is executed; what ran on is in seconds, as it was said before the start."""
        number = self.gateway.start(job, *options)
        run_on = json.loads(self.gateway.axisctl("--json", "mill", "queue")).get("running", {}).get("run_on", {})
        self.daemon.wait_for_log(rf"job {number} .* is FED")
        self.gateway.axisctl("mill", "done", number)
        return float(run_on.get("longest_time", "0s").rstrip("s"))

    def run_on_of_a_paced_job(self):
        return self.feed("^PA;!MC0;" + "PU2000,1000;PU1000,1000;" * 4, "--streaming", "paced")

    def test_a_long_job_shows_it(self):
        self.assertEqual(self.pace(), [0, 0])
        self.assertNotIn("measured", self.gateway.axisctl("mill", "queue"))
        # A step each, 12 bytes: 24 times what terminal and mill hold.
        job = "^PA;!MC0;" + "PU1001,1000;PU1000,1000;" * 21_000
        before = self.run_on_of_a_paced_job()
        self.feed(job, "--streaming", "full")
        least, most = self.pace()
        self.assertGreaterEqual(most, TRUTH)
        self.assertLessEqual(most, least * 1.2)
        self.assertIn(f"measured: the mill takes {least:.2f} to {most:.2f} times as long as the slowest of its profile\n",
                      self.gateway.axisctl("mill", "queue"))
        # The mill is quicker than its profile, so the slack falls from 1.5 to 1.
        self.assertLess(self.run_on_of_a_paced_job(), 0.8 * before)


if __name__ == "__main__":
    unittest.main()
