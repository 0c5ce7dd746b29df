#!/usr/bin/env python3
"""Several files as one job: a person changes the tool between them, also over a daemon that is killed. And what a job has
set that nothing gives back is confirmed before the next. The simulated mill is quick, and its work is done in seconds."""

import json
import pathlib
import re
import signal
import tempfile
import time
import unittest

from mill_jobs_test import quick_profile
from programs import LIMIT_S, Daemon

CONFIG = """
listen = "127.0.0.1:0"
metrics = "127.0.0.1:0"
socket = "{socket}"

[[device]]
name = "stage"
connection = "simulated"

[[device]]
name = "mill"
kind = "rml1"
profile = "%s"
connection = "simulated"
tools = ["T1", "T2", "T3"]
"""

SMALL = "^IN;!PZ-50,200;PU100,100;PU;H;\n"
# Moves with the tool up, each a fifth of a second: minutes.
LONG = "^IN;!MC0;!PZ-50,200;" + "PU8000,0;PU0,0;" * 1000 + "H;\n"


class MillParts(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="axisctl-parts-")
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        profile = self.folder / "quick.toml"
        profile.write_text(quick_profile(), encoding="utf-8")
        self.config = CONFIG % profile
        self.begin_daemon()

    def begin_daemon(self):
        self.daemon = Daemon(str(self.folder), self.config)
        self.addCleanup(self.daemon.stop)
        self.await_queue("  line open\n")

    def kill_daemon(self):
        self.daemon.signal(signal.SIGKILL)
        self.daemon.wait(LIMIT_S)
        self.begin_daemon()

    def run_mill(self, *arguments):
        return self.daemon.run("--device", "mill", "mill", *arguments)

    def run_well(self, *arguments):
        answer = self.run_mill(*arguments)
        self.assertEqual((answer.returncode, answer.stderr), (0, ""), answer.stdout)
        return answer.stdout

    def refused(self, pattern, *arguments, code=3):
        answer = self.run_mill(*arguments)
        self.assertEqual(answer.returncode, code, answer.stdout + answer.stderr)
        self.assertRegex(answer.stderr, pattern)

    def await_queue(self, pattern):
        deadline = time.monotonic() + LIMIT_S
        while True:
            answer = self.run_mill("queue")
            if re.search(pattern, answer.stdout):
                return answer.stdout
            self.assertLess(time.monotonic(), deadline, answer.stdout + answer.stderr)
            time.sleep(0.05)  # between two looks; the deadline above decides

    def files(self, *jobs):
        for number, job in enumerate(jobs, 1):
            (self.folder / f"{number}.rml").write_text(job, encoding="ascii")
        return [str(self.folder / f"{number}.rml") for number in range(1, len(jobs) + 1)]

    def send(self, tools, *jobs):
        sent = self.run_well("send", *self.files(*jobs), "--tool", tools, "--title", "frame")
        return re.fullmatch(r"job (\d+) \(frame\) QUEUED; takes .+\n", sent)[1]

    def run_part(self):
        self.run_well("confirm", "--yes")
        return self.run_well("start", "--follow")

    def test_from_the_files_to_the_workpiece(self):
        number, other = self.send("T1,T3", SMALL, SMALL), self.send("T1", SMALL)
        self.assertRegex(self.await_queue("QUEUED"), rf"(?m)^{number} +frame +\S+ \S+ +QUEUED +part 1 of 2, T1 ")
        self.assertRegex(self.run_part(), rf"\njob {number} \(frame\) TOOL_CHANGE: part 1 of 2 was sent, .*; put in the "
                                          rf"tool T3, set Z0, then `axisctl mill confirm {number} --start`\n\Z")
        self.assertRegex(self.await_queue("TOOL_CHANGE"), rf"no job runs\n.*\n{number} .* TOOL_CHANGE +part 2 of 2, T3 ")
        self.refused(rf"WRONG_JOB_STATE: job {number} .* its next tool is T3", "confirm", other, "--yes")
        self.refused("NOT_CONFIRMED", "start")
        confirmed = self.run_well("confirm", "--yes")
        self.assertRegex(confirmed, r"\n  part      2 of 2\n  tool      T3\n")
        self.assertRegex(self.run_well("start", "--follow"), rf"\njob {number} \(frame\) FED: ")
        self.run_well("done", number)
        history = self.daemon.run("--device", "mill", "history")
        self.assertEqual(len(re.findall(rf"  mill  job {number} is TOOL_CHANGE", history.stdout)), 1, history.stdout)
        self.assertEqual(len(re.findall(rf"  mill  job {number} is RUNNING", history.stdout)), 2, history.stdout)

    def test_a_tool_change_is_cancelled(self):
        number, other = self.send("T1,T3", SMALL, SMALL), self.send("T1", SMALL)
        self.run_part()
        self.run_well("abort")
        self.await_queue(rf"(?m)^{number} .* TOOL_CHANGE ")
        self.run_well("cancel", number)
        self.run_well("confirm", other, "--yes")

    def test_a_killed_daemon_knows_the_part(self):
        number = self.send("T1,T3", SMALL, LONG)
        self.run_part()
        self.kill_daemon()
        self.assertRegex(self.await_queue(f"(?m)^{number} "), rf"(?m)^{number} .* TOOL_CHANGE +part 2 of 2, T3 ")
        self.run_well("confirm", "--yes")
        self.kill_daemon()  # the confirmation is void
        self.assertRegex(self.await_queue(f"(?m)^{number} "), rf"(?m)^{number} .* TOOL_CHANGE +part 2 of 2, T3 ")
        self.run_well("confirm", "--yes", "--start")
        self.await_queue(rf"\njob {number} \(frame\) SENDING ")
        self.kill_daemon()
        self.assertRegex(self.await_queue(f"(?m)^{number} "), rf"(?m)^{number} .* PAUSED_UNKNOWN +part 2 of 2, T3 ")
        queue = json.loads(self.daemon.run("--json", "--device", "mill", "mill", "queue").stdout)
        least, most = (int(queue["jobs"][0][end]) for end in ("sent_least", "sent_most"))
        self.assertEqual(least, len(SMALL))  # the first part
        self.assertLess(most, len(SMALL) + len(LONG))
        self.refused("WRONG_JOB_STATE", "confirm", number, "--yes")
        self.run_well("cancel", number)

    def test_what_is_not_sent_into_the_queue(self):
        self.refused(r"INVALID_REQUEST: file 2: line 2, column 1: ", "send", *self.files(SMALL, "^IN;\nQ;\n"), "--tool",
                     "T1,T2")
        self.refused("INVALID_REQUEST: mill has no tool \"T9\"", "send", *self.files(SMALL, SMALL), "--tool", "T1,T9")
        self.refused("INVALID_REQUEST: a part of the job has no bytes", "send", *self.files(SMALL, ""), "--tool", "T1,T2")
        self.refused("INVALID_REQUEST: the job has 17 parts", "send", *self.files(*[SMALL] * 17), "--tool",
                     ",".join(["T1"] * 17))
        self.refused("--tool has 1 names for a job of 2 files", "send", *self.files(SMALL, SMALL), "--tool", "T1", code=2)
        self.assertRegex(self.run_well("queue"), r"\nno jobs\n\Z")

    def test_what_a_job_leaves_is_confirmed_before_the_next(self):
        number, second = self.send("T1", SMALL.replace("PU;", "!ZO0;PU;")), self.send("T1", SMALL)
        self.assertNotIn("before", self.run_well("confirm", "--yes"))
        self.run_well("start", "--follow")
        self.run_well("done", number)
        self.kill_daemon()
        before = rf"\n  before    job {number} \(frame\) sets Z0\n"
        self.assertRegex(self.run_well("confirm", "--yes"), before)
        self.run_well("start", "--follow")
        self.run_well("done", second)
        self.send("T1", SMALL)
        self.assertNotIn("before", self.run_well("confirm", "--yes"))


if __name__ == "__main__":
    unittest.main()
