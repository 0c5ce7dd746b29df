#!/usr/bin/env python3
"""A queue among people: an administrator moves any job to the front, an operator only their own before other ones of
theirs. The order outlives a daemon that ends and one that is killed. Nobody fills the queue, an administrator clears the
jobs of a caller, and what nobody confirms expires. Bert is an administrator, the others are operators."""

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


class Queue(unittest.TestCase):
    config = CONFIG

    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="axisgate-mill-queue-")
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        self.daemon = Daemon(folder.name, self.config)
        self.addCleanup(lambda: self.daemon.stop())
        self.tokens = {who: self.daemon.run("token", "create", who).stdout.strip() for who in ("anna", "carl", "dora")}
        self.await_true(lambda: "line open" in self.well("bert", "mill", "queue"), "the line does not open")

    def await_true(self, condition, what):
        deadline = time.monotonic() + LIMIT_S
        while not condition():
            self.assertLess(time.monotonic(), deadline, what)
            time.sleep(0.02)  # between two looks; the deadline above decides

    def run_as(self, who, *words, stdin=""):
        """"nobody" has no name: over loopback, without a token."""
        if who == "bert":
            return self.daemon.run(*words, stdin=stdin)
        return subprocess.run([BIN / "axisctl", "--target", self.daemon.address(), *words], input=stdin,
                              env=dict(os.environ, AXISGATE_TOKEN=self.tokens.get(who, "")), capture_output=True,
                              text=True, timeout=LIMIT_S, check=False)

    def well(self, who, *words, stdin=""):
        answer = self.run_as(who, *words, stdin=stdin)
        self.assertEqual((answer.returncode, answer.stderr), (0, ""), f"{words}: {answer.stdout}")
        return answer.stdout

    def refused(self, who, pattern, *words, stdin=""):
        answer = self.run_as(who, *words, stdin=stdin)
        self.assertEqual(answer.returncode, 3, answer.stdout + answer.stderr)
        self.assertRegex(answer.stderr, pattern)

    def send(self, *people):
        for who in people:
            self.well(who, "mill", "send", "-", "--title", f"for {who}", stdin=JOB)

    def restart(self, end):
        self.daemon.signal(end)
        self.daemon.wait(LIMIT_S)
        self.daemon.stop()
        self.daemon = Daemon(str(self.folder), self.config)

    def order(self):
        jobs = json.loads(self.well("bert", "--json", "mill", "queue")).get("jobs", [])
        return [int(job["name"].rpartition("/")[2]) for job in jobs]

    def kept_order(self):
        """As the files of the spool have it."""
        jobs = [json.loads(file.read_text(encoding="utf-8")) for file in self.folder.glob("state/spool/mill/*.json")]
        return [number for _, number in sorted((json.loads(job["facts"])["rank"], job["id"]) for job in jobs)]


class AQueueAmongPeople(Queue):
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
        self.refused("bert", "WRONG_JOB_STATE: job 4 .* is CONFIRMED .only a job that is QUEUED", "mill", "first", "4")
        self.refused("bert", "NOT_FOUND: there is no job 9", "mill", "first", "9")
        history = self.well("bert", "history")
        self.assertRegex(history, "job 3 is QUEUED: moved before the other jobs of its owner, by token anna")
        self.assertRegex(history, "job 4 is QUEUED: moved to the front of the queue, by unix ")

    def test_when_a_job_begins(self):
        self.send("anna", "bert", "anna")
        queue = self.well("bert", "mill", "queue")
        takes = re.search(r"  (\d+ h \d+ min(?: to \d+ h \d+ min)?), paced  now  ", queue)
        self.assertTrue(takes, queue)
        self.assertRegex(queue, rf"(?m)^2 .*  in {takes[1]} +-$")
        self.well("bert", "mill", "confirm", "--yes", "--start")
        self.assertRegex(self.well("bert", "mill", "queue"), r"(?m)^2 .*  in \d+ .* min +-$")

    def test_the_order_outlives_the_daemon(self):
        self.send("anna", "bert", "anna", "bert", "anna")
        self.well("bert", "mill", "first", "4")
        self.well("bert", "mill", "confirm", "4", "--yes")
        self.well("anna", "mill", "first", "5")
        for end in (signal.SIGTERM, signal.SIGKILL):
            with self.subTest(end):
                self.assertEqual(self.order(), [4, 5, 2, 1, 3])
                self.assertEqual(self.kept_order(), [4, 5, 2, 1, 3], "it is kept before it is answered")
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

    def test_an_administrator_clears_the_jobs_of_a_caller(self):
        self.send("anna", "anna", "bert", "anna")
        self.well("bert", "mill", "confirm", "1", "--yes", "--start")
        self.refused("anna", "NOT_ALLOWED: ", "mill", "clear", "token anna")
        self.assertEqual(self.well("bert", "mill", "clear", "token anna"), "jobs 2, 4 of token anna are CANCELLED\n")
        self.assertEqual(self.order(), [1, 3], "job 1 runs")
        self.refused("bert", "NOT_FOUND: no job of token anna waits for mill", "mill", "clear", "token anna")
        self.assertRegex(self.well("bert", "history"), r"job 4 is CANCELLED, by unix \S+")

    def test_a_job_that_nobody_confirms_expires(self):
        self.send("anna", "bert")
        self.daemon.signal(signal.SIGTERM)
        self.daemon.wait(LIMIT_S)
        record = self.folder / "state/spool/mill/1.json"
        job = json.loads(record.read_text(encoding="utf-8"))
        record.write_text(json.dumps(dict(job, created=job["created"] - 15 * 86400)), encoding="utf-8")
        self.daemon.stop()
        self.daemon = Daemon(str(self.folder), self.config)
        self.await_true(lambda: self.order() == [2], "it does not expire")
        self.assertRegex(self.well("bert", "history"), r"job 1 is EXPIRED: nobody confirmed it within 14 days")


class AQueueOfEightPlaces(Queue):
    config = CONFIG.replace("[access]", "[jobs]\ncount = 8\n\n[access]")

    def refused_to_send(self, who, pattern):
        self.refused(who, "QUEUE_FULL: " + pattern, "mill", "send", "-", stdin=JOB)

    def test_nobody_is_shut_out(self):
        for who, name in (("nobody", "callers without a name"), ("anna", "token anna")):
            self.send(who, who)
            self.refused_to_send(who, rf"2 jobs of {name} are in the queue, the most for one caller .*mill cancel`")
        self.send("bert", "carl")
        self.well("bert", "mill", "clear", "token anna")
        self.send("bert", "anna")
        for who in ("anna", "carl"):
            self.refused_to_send(who, f"6 of the 8 places of the queue are taken, 1 of them by jobs of token {who}; "
                                      "the last 2 are for callers without a job in it ")
        self.send("dora")
        self.assertEqual(len(self.order()), 7)


if __name__ == "__main__":
    unittest.main()
