#!/usr/bin/env python3
"""What the daemon keeps of what happened, and finds again when it was killed or restarted."""

import json
import os
import re
import sqlite3
import tempfile
import unittest

from programs import Daemon

CONFIG = """
listen = "127.0.0.1:0"
metrics = "127.0.0.1:0"
socket = "{socket}"

[[device]]
name = "stage"
connection = "simulated"
speed = 100
"""


class History(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="axisgate-history-")
        self.addCleanup(folder.cleanup)
        self.folder = folder.name
        self.journal = os.path.join(self.folder, "state", "journal.sqlite")
        self.start()

    def start(self):
        self.daemon = Daemon(self.folder, CONFIG)
        self.addCleanup(self.daemon.stop)

    def run_well(self, *words):
        done = self.daemon.run(*words)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        return done.stdout

    def history(self, *words):
        return [json.loads(line) for line in self.run_well("--json", "history", *words).splitlines()]

    def test_the_morning_after(self):
        self.run_well("move", "1=+100pulse", "--relative")
        self.run_well("stop")
        self.daemon.kill()
        self.start()
        self.run_well("move", "1=+100pulse", "--relative")
        shown = self.run_well("history")
        self.assertRegex(shown, r"(?m)^\S+ \S+  stage  motion 1 \(move of axis 1\) SUCCEEDED; axis 1 at 100 pulses, by unix ")
        self.assertRegex(shown, r"(?m)^\S+ \S+  stage  stop of axes 1, 2, 3, by unix ")
        self.assertEqual(len(re.findall(r"the daemon started", shown)), 2, shown)
        self.assertNotIn("the daemon ended", shown, "it was killed")
        motions = {entry["motion"] for entry in self.history()} - {""}
        self.assertEqual(motions, {"devices/stage/motions/1", "devices/stage/motions/2"}, "a number is not used twice")
        self.assertEqual([entry["kind"] for entry in self.history("--motion", "1")],
                         ["HISTORY_KIND_MOTION_ENDED", "HISTORY_KIND_MOTION_STARTED", "HISTORY_KIND_MOTION_REQUESTED"])

    def test_filters_and_limits(self):
        self.run_well("move", "1=+100pulse", "--relative")
        self.assertEqual(self.history("--who", "unix nobody-here"), [])
        self.assertEqual(len(self.history("--limit", "2")), 2)
        self.assertGreater(len(self.history("--hours", "1")), 3)
        everything = self.history("--limit", "5000")
        numbers = [int(entry["number"]) for entry in everything]
        self.assertEqual(numbers, list(range(len(numbers), 0, -1)))

    def test_a_changed_entry_is_found_out(self):
        self.run_well("move", "1=+100pulse", "--relative")
        head = re.search(r"(?m)^head (\S+)$", self.run_well("audit", "verify"))[1]
        self.run_well("audit", "verify", "--head", head)
        self.daemon.stop()
        with sqlite3.connect(self.journal) as database:
            database.execute("UPDATE entry SET body = '{}' WHERE number = 2")
        database.close()
        self.start()
        found = self.daemon.run("audit", "verify")
        self.assertEqual(found.returncode, 1, found.stdout)
        self.assertRegex(found.stdout, r"^entry 2: it or its place was changed")

    def test_what_is_no_head_is_refused(self):
        for text in ("x", "a:b:c", "a:1:zz"):
            refused = self.daemon.run("audit", "verify", "--head", text)
            self.assertEqual(refused.returncode, 2, text + refused.stdout)
            self.assertIn("is no head of a journal", refused.stderr)

    def test_a_daemon_without_a_journal_serves_and_says_so(self):
        self.daemon.stop()
        with sqlite3.connect(self.journal) as database:
            database.execute("PRAGMA user_version = 99")
        database.close()
        self.start()
        self.run_well("move", "1=+100pulse", "--relative")
        refused = self.daemon.run("history")
        self.assertEqual(refused.returncode, 4, refused.stdout)
        self.assertIn("JOURNAL_UNAVAILABLE", refused.stderr)
        self.assertRegex(self.daemon.log(), "no journal is kept: .*a newer version of axisgated has written it")


if __name__ == "__main__":
    unittest.main()
