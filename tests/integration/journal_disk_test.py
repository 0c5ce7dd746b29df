#!/usr/bin/env python3
"""The journal's disk is full, read-only or hangs: what moves is refused, a stop works, and all recovers by itself.

strace makes the daemon's own calls fail or hang; only SQLite uses pwrite64 and fdatasync here.
"""

import os
import re
import tempfile
import time
import unittest

from programs import BIN, LIMIT_S, Daemon, can_trace

CONFIG = """
listen = "127.0.0.1:0"
metrics = "127.0.0.1:0"
socket = "{socket}"

[journal]
unavailable = "UNAVAILABLE"

[[device]]
name = "stage"
connection = "simulated"
"""
MOVE = ["move", "1=+100pulse", "--relative"]


@unittest.skipUnless(can_trace(), "strace is not permitted here")
class JournalDisk(unittest.TestCase):
    def start(self, calls, fault, unavailable="refuse"):
        folder = tempfile.TemporaryDirectory(prefix="axisgate-disk-")
        self.addCleanup(folder.cleanup)
        config = CONFIG.replace("UNAVAILABLE", unavailable)
        Daemon(folder.name, config).stop()  # the file is there before the disk is bad
        script = os.path.join(folder.name, "on-a-bad-disk")
        with open(script, "w", encoding="utf-8") as file:
            file.write(f"#!/bin/sh\nexec strace -D -f -qq -o /dev/null -e trace={calls} -e inject={calls}:{fault}"
                       f" {BIN / 'axisgated'} \"$@\"\n")
        os.chmod(script, 0o755)
        self.daemon = Daemon(folder.name, config, program=script)
        self.addCleanup(self.daemon.stop)

    def metric(self, name):
        return float(re.search(rf"^{name} (\S+)$", self.daemon.metrics_page(), re.MULTILINE)[1])

    def until(self, condition, what):
        deadline = time.monotonic() + LIMIT_S
        while not condition():
            self.assertLess(time.monotonic(), deadline, what)
            time.sleep(0.05)  # between two looks; the deadline above decides

    def refused(self):
        done = self.daemon.run(*MOVE)
        return done.returncode == 4 and "JOURNAL_UNAVAILABLE" in done.stderr

    def moved(self):
        return self.daemon.run(*MOVE).returncode == 0

    def check_refusal_and_recovery(self):
        self.until(self.refused, "a move is refused")
        self.assertEqual(self.metric("axisgate_journal_available"), 0)
        asked = time.monotonic()
        stop = self.daemon.run("stop")
        self.assertEqual(stop.returncode, 0, stop.stderr)
        self.assertLess(time.monotonic() - asked, 1)
        self.assertEqual(self.daemon.run("exec", "Q:").returncode, 0, "questions are answered")
        self.until(self.moved, "a move is made again, without a restart")
        self.until(lambda: self.metric("axisgate_journal_available") == 1, "the metric has recovered")
        self.daemon.wait_for_log("it is written again")
        self.assertIn("the disk refused the journal", self.daemon.run("history").stdout)
        self.assertEqual(self.daemon.run("audit", "verify").returncode, 0)

    def test_a_full_disk(self):
        self.start("pwrite64", "error=ENOSPC:when=40..44")
        self.check_refusal_and_recovery()

    def test_a_disk_that_is_read_only(self):
        self.start("pwrite64", "error=EROFS:when=40..44")
        self.check_refusal_and_recovery()

    def test_a_disk_that_hangs_for_ten_seconds(self):
        self.start("fdatasync", "delay_enter=10000000:when=12")
        hung = []
        self.until(lambda: hung.append(self.daemon.run(*MOVE)) or hung[-1].returncode != 0, "the disk hangs")
        self.assertIn("JOURNAL_UNAVAILABLE", hung[-1].stderr)
        self.assertEqual(self.metric("axisgate_journal_available"), 0)
        asked = time.monotonic()
        self.assertEqual(self.daemon.run("stop").returncode, 0)
        self.assertLess(time.monotonic() - asked, 1)
        self.until(self.moved, "a move is made again")
        places = self.daemon.run("position").stdout
        moves = len(hung)  # the refused one did not move, and the last one did
        self.assertRegex(places, rf"axis 1 +{moves} um", "each move once: what was refused was not sent later")

    def test_where_the_configuration_says_so_all_is_done(self):
        self.start("pwrite64", "error=ENOSPC:when=40..44", unavailable="act")
        for _ in range(12):
            self.assertTrue(self.moved())
        self.daemon.wait_for_log("failed: ")


if __name__ == "__main__":
    unittest.main()
