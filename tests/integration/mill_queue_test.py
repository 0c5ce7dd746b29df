#!/usr/bin/env python3
"""A queue among people: an administrator moves any job to the front, an operator only their own before other ones of
theirs. The order outlives a daemon that ends and one that is killed. Bert is an administrator, anna an operator."""

import json
import os
import pathlib
import re
import signal
import subprocess
import tempfile
import time
import unittest

from programs import BIN, LIMIT_S, Daemon

CONFIG = """
listen = "127.0.0.1:0"
metrics = "127.0.0.1:0"
socket = "{socket}"

[access]
local = "admin"

[[device]]
name = "mill"
kind = "rml1"
profile = "mdx-20"
connection = "simulated"
tools = ["T1"]
"""

# 25,000 mm of travel: some minutes.
JOB = "^IN;!MC0;!PZ-50,200;" + "PU4000,0;PU0,0;" * 125 + "H;\n"


class AQueueAmongPeople(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="axisgate-mill-queue-")
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        self.daemon = Daemon(folder.name, CONFIG)
        self.addCleanup(lambda: self.daemon.stop())
        self.token = self.daemon.run("token", "create", "anna").stdout.strip()
        self.await_true(lambda: "line open" in self.well("bert", "mill", "queue"), "the line does not open")

    def await_true(self, condition, what):
        deadline = time.monotonic() + LIMIT_S
        while not condition():
            self.assertLess(time.monotonic(), deadline, what)
            time.sleep(0.02)  # between two looks; the deadline above decides

    def run_as(self, who, *words, stdin=""):
        if who == "bert":
            return self.daemon.run(*words, stdin=stdin)
        return subprocess.run([BIN / "axisctl", "--target", self.daemon.address(), *words], input=stdin,
                              env=dict(os.environ, AXISGATE_TOKEN=self.token), capture_output=True, text=True,
                              timeout=LIMIT_S, check=False)

    def well(self, who, *words, stdin=""):
        answer = self.run_as(who, *words, stdin=stdin)
        self.assertEqual((answer.returncode, answer.stderr), (0, ""), f"{words}: {answer.stdout}")
        return answer.stdout

    def refused(self, who, pattern, *words):
        answer = self.run_as(who, *words)
        self.assertEqual(answer.returncode, 3, answer.stdout + answer.stderr)
        self.assertRegex(answer.stderr, pattern)

    def send(self, *people):
        for who in people:
            self.well(who, "mill", "send", "-", "--title", f"for {who}", stdin=JOB)

    def restart(self, end):
        self.daemon.signal(end)
        self.daemon.wait(LIMIT_S)
        self.daemon.stop()
        self.daemon = Daemon(str(self.folder), CONFIG)

    def order(self):
        jobs = json.loads(self.well("bert", "--json", "mill", "queue")).get("jobs", [])
        return [int(job["name"].rpartition("/")[2]) for job in jobs]

    def kept_order(self):
        """As the files of the spool have it."""
        jobs = [json.loads(file.read_text(encoding="utf-8")) for file in self.folder.glob("state/spool/mill/*.json")]
        return [number for _, number in sorted((json.loads(job["facts"])["rank"], job["id"]) for job in jobs)]

    def test_who_may_move_which_job(self):
        self.send("anna", "bert", "anna", "bert")
        self.refused("anna", r"NOT_ALLOWED: job 4 \(for bert, by unix \S+\) is not yours \(its owner or an administrator can "
                             r"move it\)", "mill", "first", "4")
        self.assertEqual(self.well("anna", "mill", "first", "3"), "job 3 (for anna) is as far forward as you may move it; "
                                                                 "`axisctl mill queue` shows the order\n")
        self.assertEqual(self.order(), [3, 2, 1, 4], "job 2 has kept its place")
        self.well("bert", "mill", "first", "4")
        self.assertEqual(self.order(), [4, 3, 2, 1])
        self.well("bert", "mill", "confirm", "4", "--yes")
        self.well("bert", "mill", "first", "1")
        self.assertEqual(self.order(), [4, 1, 3, 2], "what is confirmed is not overtaken")
        self.refused("bert", "WRONG_MODE: job 4 .* is CONFIRMED .only a job that is QUEUED", "mill", "first", "4")
        self.refused("bert", "NOT_FOUND: there is no job 9", "mill", "first", "9")
        history = self.well("bert", "history")
        self.assertRegex(history, "job 3 is QUEUED: moved before the other jobs of its owner, by token anna")
        self.assertRegex(history, "job 4 is QUEUED: moved to the front of the queue, by unix ")

    def test_when_a_job_begins(self):
        self.send("anna", "bert", "anna")
        queue = self.well("bert", "mill", "queue")
        takes = re.search(r"  (\d+ min \d+ s to \d+ min \d+ s)  now  ", queue)
        self.assertTrue(takes, queue)
        self.assertRegex(queue, rf"(?m)^2 .*  in {takes[1]} +-$")
        self.well("bert", "mill", "confirm", "--yes", "--start")
        self.assertRegex(self.well("bert", "mill", "queue"), r"(?m)^2 .*  in \d+ min \d+ s to \d+ min \d+ s +-$")

    def test_the_order_outlives_the_daemon(self):
        self.send("anna", "bert", "anna", "bert", "anna")
        self.well("bert", "mill", "first", "4")
        self.well("bert", "mill", "confirm", "4", "--yes")
        self.well("anna", "mill", "first", "5")
        for end in (signal.SIGTERM, signal.SIGKILL):
            with self.subTest(end):
                self.assertEqual(self.order(), [4, 5, 2, 1, 3])
                self.await_true(lambda: self.kept_order() == [4, 5, 2, 1, 3], "the order is not kept")
                self.restart(end)
        self.assertEqual(self.order(), [4, 5, 2, 1, 3])
        self.send("anna")
        self.assertEqual(self.order(), [4, 5, 2, 1, 3, 6])

    def test_an_ended_daemon_has_kept_the_last_move(self):
        self.send("anna", "bert", "anna")
        for number in ("3", "2", "3"):
            self.well("bert", "mill", "first", number)
        self.restart(signal.SIGTERM)
        self.assertEqual(self.order(), [3, 2, 1])


if __name__ == "__main__":
    unittest.main()
