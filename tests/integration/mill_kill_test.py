#!/usr/bin/env python3
"""The daemon is killed in the middle of a job, and the line of a mill is unplugged: what the mill was sent lies within
what is said of it, nothing is resumed, and no command is sent twice. AXISGATE_MILL_KILLS=50 does each so often; the
ordinary run does it 4 times. AXISGATE_KILL_SEED chooses when."""

import json
import os
import pathlib
import random
import re
import signal
import tempfile
import time
import unittest

from mill_jobs_test import quick_profile
from mill_pty import send_accepting
from programs import BIN, LIMIT_S, Daemon, Lines

KILLS = int(os.environ.get("AXISGATE_MILL_KILLS", "4"))
SEED = int(os.environ.get("AXISGATE_KILL_SEED", random.randrange(1_000_000)))
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
profile = "PROFILE"
connection = "serial"
path = "TTY"
baud = 9600
window = 64
converter = 0
"""
BEGINNING = "!MC0;PA;"
COMMANDS = 4000
BUFFER = 1024  # of the mill, beside what it executes


def job(run):
    """Each command has a number that no other has."""
    return BEGINNING + "".join(f"PU{number},{run};" for number in range(1, COMMANDS + 1))


def end_of(number, run):
    """How many bytes of the job there are up to that command's end."""
    return len(job(run).partition(f"PU{number + 1},{run};")[0])


class MillKill(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="axisgate-mill-kill-")
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        self.profile = self.folder / "quick.toml"
        self.profile.write_text(quick_profile(), encoding="utf-8")
        self.random = random.Random(SEED)
        self.simulators = 0
        self.plug_in()
        config = CONFIG.replace("PROFILE", str(self.profile)).replace("TTY", str(self.folder / "tty"))
        self.config = config
        self.daemon = Daemon(folder.name, config)
        self.addCleanup(lambda: self.daemon.stop())

    def plug_in(self):
        """A new mill at the same place, with a record of its own."""
        self.simulators += 1
        self.record = self.folder / f"record-{self.simulators}.json"
        self.mill = Lines([BIN / "rml1-sim", "--pty", self.folder / "tty", "--profile", self.profile, "--baud", "9600",
                           "--record", self.record])
        self.addCleanup(self.mill.kill)
        self.mill.until("simulator on")

    def entries(self):
        lines = self.record.read_text(encoding="ascii").splitlines(keepends=True)
        return [json.loads(line) for line in lines if line.endswith("\n")]

    def numbers(self, run):
        """Those of the job's commands that the mill has begun, in their order."""
        begun = [entry["numbers"] for entry in self.entries() if entry.get("command") == "PU" and entry.get("numbers")]
        return [int(first) for first, *rest in begun if [int(number) for number in rest] == [run]]

    def axisctl(self, *words, stdin=""):
        answer = self.daemon.run("--device", "mill", *words, stdin=stdin)
        self.assertEqual(answer.returncode, 0, f"{words}: {answer.stdout}{answer.stderr}")
        return answer.stdout

    def send(self, *words, stdin=""):
        send_accepting(lambda *each, **more: self.daemon.run("--device", "mill", *each, **more), *words, stdin=stdin)

    def jobs(self):
        return json.loads(self.axisctl("--json", "mill", "queue")).get("jobs", [])

    def await_true(self, condition, what):
        deadline = time.monotonic() + LIMIT_S
        while not condition():
            self.assertLess(time.monotonic(), deadline, f"seed {SEED}: {what}")
            time.sleep(0.02)  # between two looks; the deadline above decides

    def begin(self, run):
        self.await_true(lambda: "line open" in self.axisctl("mill", "queue"), "the line does not open")
        self.send("-", "--title", "numbers", stdin=job(run))
        self.axisctl("mill", "confirm", "--yes", "--start")
        least = self.random.randint(3, 150)
        self.await_true(lambda: len(self.numbers(run)) >= least, "the job does not run")

    def check(self, run, numbers):
        """What the mill was sent, and what is said of it."""
        self.await_true(lambda: [one["state"] for one in self.jobs()] == ["JOB_STATE_PAUSED_UNKNOWN"], "no outcome")
        self.assertEqual(numbers, list(range(1, len(numbers) + 1)), f"seed {SEED}")
        left = self.jobs()[0]
        most = int(left["sent_most"])
        self.assertLessEqual(end_of(len(numbers), run), most, f"seed {SEED}: more than it is said to have")
        least = int(left.get("sent_least", 0))
        self.assertLessEqual(least, min(most, end_of(len(numbers), run) + BUFFER), f"seed {SEED}: more than the mill has")
        self.axisctl("mill", "cancel", left["name"].rpartition("/")[2])

    def aborted(self):
        """The abort of the daemon has come: the tool is raised by !ZM."""
        return any(entry.get("command") == "!ZM" for entry in self.entries())

    def test_killed_daemons(self):
        for run in range(1, KILLS + 1):
            with self.subTest(run=run, seed=SEED):
                self.begin(run)
                aborts = sum(entry.get("command") == "!ZM" for entry in self.entries())
                self.daemon.signal(signal.SIGKILL)
                self.daemon.wait(LIMIT_S)
                self.daemon = Daemon(str(self.folder), self.config)
                self.await_true(
                    lambda: sum(entry.get("command") == "!ZM" for entry in self.entries()) > aborts, "no abort")
                numbers = self.numbers(run)
                self.check(run, numbers)
                self.assertEqual(self.numbers(run), numbers, "something was sent after the restart")

    def await_state(self, state):
        self.await_true(lambda: [one["state"] for one in self.jobs()] == [f"JOB_STATE_{state}"], f"it is not {state}")

    def open_line(self):
        self.await_true(lambda: "line open" in self.axisctl("mill", "queue"), "the line does not open")

    def restart(self):
        self.daemon.signal(signal.SIGKILL)
        self.daemon.wait(LIMIT_S)
        self.daemon = Daemon(str(self.folder), self.config)
        self.open_line()

    def begin_lines(self):
        """Each command is in a line of its own behind the first; returns when some have been begun. However late that
        is seen, the job runs still: it has as many commands as job()."""
        self.open_line()
        text = BEGINNING + "\n" + "".join(f"PU{number},1;\n" for number in range(1, COMMANDS + 1))
        self.send("-", "--title", "lines", stdin=text)
        self.axisctl("mill", "confirm", "--yes", "--start")
        least = self.random.randint(1, 30)
        self.await_true(lambda: len(self.numbers(1)) >= least, "the job does not run")

    def goes_on(self, before):
        """The job that has been started again leaves out nothing after `before`, and repeats nothing."""
        begun = before + before[-1:]  # the approach travels to where the last one led
        self.await_true(lambda: len(self.numbers(1)) >= len(begun) + 30, "the job does not go on")
        numbers = self.numbers(1)
        self.assertEqual(numbers[:len(begun)], begun, f"seed {SEED}")
        rest = numbers[len(begun):]
        self.assertEqual(rest, list(range(before[-1] + 1, before[-1] + 1 + len(rest))), f"seed {SEED}")

    def test_a_job_that_was_lost_goes_on_at_the_line_that_somebody_names(self):
        self.begin_lines()
        self.restart()
        self.await_state("PAUSED_UNKNOWN")
        self.await_true(self.aborted, "no abort")  # only then has the mill begun all that it will
        before = self.numbers(1)
        refused = self.daemon.run("--device", "mill", "mill", "resume", "1")
        self.assertEqual(refused.returncode, 3, refused.stderr)
        sent = re.search(r"ends at line (\d+), column \d+(?:, or later, up to line (\d+), )?", refused.stderr)
        self.assertIsNotNone(sent, refused.stderr)
        # Command n is in line n + 1.
        self.assertLessEqual(int(sent[1]) - 2, len(before), f"seed {SEED}: {refused.stderr}")
        self.assertGreaterEqual(int(sent[2] or sent[1]) - 1, len(before), f"seed {SEED}: {refused.stderr}")
        self.assertIn(f"PAUSED: it continues at line {len(before) + 2}, column 1",
                      self.axisctl("mill", "resume", "1", "--from", str(len(before) + 2)))
        self.assertEqual(self.numbers(1), before, "nothing is sent before somebody confirms it")
        self.restart()
        again = self.daemon.run("--device", "mill", "mill", "resume", "1")
        self.assertEqual(again.stderr, refused.stderr, "what was sent ends there still, wherever it continues")
        self.axisctl("mill", "confirm", "1", "--yes", "--start")
        self.goes_on(before)

    def test_a_raised_job_outlives_the_daemon_and_goes_on(self):
        self.begin_lines()
        self.axisctl("mill", "pause", "--raise")
        self.await_state("PAUSED")
        self.await_true(self.aborted, "the tool is not up")  # only then has the mill begun all that it will
        before = self.numbers(1)
        # A daemon that dies before its place is on the disk does not know it: the job would be PAUSED_UNKNOWN.
        kept = self.folder / "state" / "spool" / "mill" / "1.json"
        self.await_true(lambda: "from" in json.loads(json.loads(kept.read_text())["facts"]), "its place is not kept")
        self.restart()
        self.await_state("PAUSED")
        self.assertEqual(self.numbers(1), before)
        self.axisctl("mill", "confirm", "1", "--yes", "--start")
        self.goes_on(before)

    def test_a_daemon_that_is_killed_between_two_parts(self):
        files = []
        for first in (1, 21):
            files.append(self.folder / f"{first}.rml")
            moves = "".join(f"PU{number},1;" for number in range(first, first + 20))
            files[-1].write_text(BEGINNING + moves, encoding="ascii")
        self.await_true(lambda: "line open" in self.axisctl("mill", "queue"), "the line does not open")
        self.send(*map(str, files), "--tool", "T1,T1")
        self.axisctl("mill", "confirm", "--yes", "--start")
        self.await_state("TOOL_CHANGE")
        self.daemon.signal(signal.SIGKILL)
        self.daemon.wait(LIMIT_S)
        self.daemon = Daemon(str(self.folder), self.config)
        self.await_state("TOOL_CHANGE")
        self.await_true(lambda: "line open" in self.axisctl("mill", "queue"), "the line does not open")
        self.axisctl("mill", "confirm", "--yes", "--start")
        self.await_state("FED")
        raised = lambda: [entry["command"] for entry in self.entries() if entry.get("command") == "!ZM"]
        self.await_true(lambda: len(raised()) >= 2, "the mill has not executed what it was fed")
        self.assertEqual(len(raised()), 2, "by the two epilogues, and by no abort")
        self.assertEqual(self.numbers(1), list(range(1, 41)))

    def end_daemon(self):
        self.daemon.signal(signal.SIGTERM)
        self.daemon.wait(LIMIT_S)
        self.assertEqual(self.daemon.exit_code(), 0)

    def test_an_ended_daemon_aborts_first(self):
        self.begin(1)
        self.end_daemon()
        self.await_true(self.aborted, "no abort")
        self.assertRegex(self.daemon.log(), r"mill: job 1 .* is ABORTED, by the daemon, which ends")

    def test_a_paused_job_does_not_keep_the_daemon(self):
        self.daemon.stop()
        self.daemon = Daemon(str(self.folder), self.config + 'at_exit = "finish"\n')
        self.begin(1)
        self.axisctl("mill", "pause")
        self.end_daemon()
        self.await_true(self.aborted, "no abort")

    def test_an_idle_mill_is_sent_nothing_at_the_end(self):
        self.await_true(lambda: "line open" in self.axisctl("mill", "queue"), "the line does not open")
        self.end_daemon()
        self.assertEqual(self.entries(), [])

    def test_a_closed_line_is_said(self):
        self.begin(1)
        self.mill.kill()
        self.await_true(lambda: [one["state"] for one in self.jobs()] == ["JOB_STATE_PAUSED_UNKNOWN"], "no outcome")
        for words in (("--device", "mill", "mill", "abort"), ("--device", "mill", "stop")):
            answer = self.daemon.run(*words)
            self.assertNotEqual(answer.returncode, 0, words)
            self.assertIn("LINK_DOWN", answer.stderr)

    def test_an_abort_that_waits_for_the_line_outlives_the_daemon(self):
        self.open_line()
        self.mill.kill()
        self.await_true(lambda: "line open" not in self.axisctl("mill", "queue"), "the line does not close")
        self.assertIn("LINK_DOWN", self.daemon.run("--device", "mill", "mill", "abort").stderr)
        self.daemon.signal(signal.SIGKILL)
        self.daemon.wait(LIMIT_S)
        self.plug_in()
        self.daemon = Daemon(str(self.folder), self.config)
        self.await_true(self.aborted, "no abort")

    def test_unplugged_lines(self):
        for run in range(1, KILLS + 1):
            with self.subTest(run=run, seed=SEED):
                self.begin(run)
                self.mill.kill()
                numbers = self.numbers(run)
                self.await_true(lambda: [one["state"] for one in self.jobs()] == ["JOB_STATE_PAUSED_UNKNOWN"], "no outcome")
                self.plug_in()
                self.await_true(self.aborted, "no abort")
                self.check(run, numbers)
                self.assertEqual(self.numbers(run), [], "something of the job was sent again")


if __name__ == "__main__":
    unittest.main()
