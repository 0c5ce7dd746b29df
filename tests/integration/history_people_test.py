#!/usr/bin/env python3
"""Who reads whose entries of the history, and how a name is erased from it."""

import json
import os
import pathlib
import subprocess
import tempfile
import unittest

from programs import LIMIT_S, Daemon

CONFIG = """
listen = "127.0.0.1:0"
metrics = "127.0.0.1:0"
socket = "{socket}"

[journal]
others_seen_by = "operator"

[[device]]
name = "stage"
connection = "simulated"
speed = 100
"""
NOTE = "axisctl: only your own entries: your role may not read those of other callers\n"


class HistoryOfPeople(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="axisgate-people-")
        self.addCleanup(folder.cleanup)
        self.state = pathlib.Path(folder.name) / "state"
        self.daemon = Daemon(folder.name, CONFIG)
        self.addCleanup(self.daemon.stop)
        self.guest = self.run_well("token", "create", "guest", "--role", "observer").strip()
        self.run_well("move", "1=+100pulse", "--relative")
        self.run_well("stop")
        self.as_guest("stop")

    def run_well(self, *words):
        done = self.daemon.run(*words)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        return done.stdout

    def as_guest(self, *words):
        return subprocess.run(self.daemon.command(*words), env=dict(os.environ, AXISGATE_TOKEN=self.guest),
                              capture_output=True, text=True, timeout=LIMIT_S, check=False)

    def callers(self, shown):
        return {json.loads(line).get("caller", {}).get("name", "") for line in shown.splitlines()}

    def bytes_of_journal(self):
        return b"".join(file.read_bytes() for file in self.state.glob("journal.sqlite*"))

    def test_an_observer_reads_only_their_own_entries(self):
        shown = self.as_guest("--json", "history")
        self.assertEqual((shown.returncode, shown.stderr), (0, NOTE))
        self.assertEqual(self.callers(shown.stdout), {"", "token guest"})
        self.assertGreater(len(self.callers(self.run_well("--json", "history"))), 2)
        night = self.as_guest("history", "--night")
        self.assertEqual(night.stderr, NOTE)
        self.assertIn("stop of stage by token guest", night.stdout)
        self.assertNotIn("by unix", night.stdout)
        refused = self.as_guest("history", "--who", "unix anna")
        self.assertEqual(refused.returncode, 3, refused.stdout)
        self.assertRegex(refused.stderr, r"NOT_ALLOWED: reading what other callers did needs the role operator, and "
                                         r"token guest is observer \(.*`others_seen_by` in \[journal\]")
        self.assertEqual(self.as_guest("audit", "verify").returncode, 0)

    def test_a_name_is_erased(self):
        head = self.run_well("audit", "verify").split("head ")[1].strip()
        self.assertIn(b"token guest", self.bytes_of_journal())
        self.assertEqual(self.run_well("audit", "erase", "token guest", "--yes"),
                         'token guest is now "erased 2"; entries: 3\n'  # the stop, its line and its end
                         "other files may have the name: `axisctl help audit` lists them\n")
        self.assertNotIn(b"token guest", self.bytes_of_journal())
        self.assertRegex(self.run_well("history"), r"(?m)^\S+ \S+  the name of caller 2 was erased, by unix \S+$")
        self.assertRegex(self.run_well("history"), r"stop of axes 1, 2, 3, by erased 2\n")
        self.assertIn("entries are as they were written", self.run_well("audit", "verify", "--head", head))
        again = self.daemon.run("audit", "erase", "token guest", "--yes")
        self.assertEqual(again.returncode, 3, again.stdout)
        self.assertIn('NOT_FOUND: the journal has no caller "token guest"', again.stderr)

    def test_requests_that_are_remembered_have_the_name(self):
        who = self.run_well("whoami").split(",")[0]
        self.assertIn("remembered requests that have the name until they are forgotten: 1\n",
                      self.run_well("audit", "erase", who, "--yes"))

    def test_it_is_not_erased_by_mistake_nor_by_others(self):
        refused = self.daemon.run("audit", "erase", "token guest")
        self.assertEqual(refused.returncode, 2, refused.stdout)
        self.assertIn("add --yes", refused.stderr)
        refused = self.as_guest("audit", "erase", "token guest", "--yes")
        self.assertEqual(refused.returncode, 3, refused.stdout)
        self.assertIn("NOT_ALLOWED", refused.stderr)
        self.assertIn("by token guest", self.run_well("history"))


if __name__ == "__main__":
    unittest.main(verbosity=2)
