#!/usr/bin/env python3
"""The wall clock is set while the daemon runs: what each caller receives. server/README.md has the answers as a table.

clock/shifted_clock.cc shifts the daemon's wall clock. Its callers on the same machine have that clock, those on another
machine have their own.
"""

import json
import os
import struct
import subprocess
import tempfile
import unittest

from programs import BIN, LIMIT_S, Daemon, Lines

CONFIG = """
listen = "127.0.0.1:0"
metrics = "127.0.0.1:0"
socket = "{socket}"

[[device]]
name = "stage"
connection = "simulated"
speed = 10
"""
HOUR_S = 3600
JUMPS = (25 * HOUR_S, -365 * 24 * HOUR_S)  # each from the true time
MOVE = ["move", "1=+100pulse", "--relative"]
SLOW_MOVE = ["move", "1=15mm", "--speed", "0.5mm/s"]  # takes some seconds here


class ClockSet(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="axisgate-clock-")
        self.addCleanup(folder.cleanup)
        self.folder = folder.name
        self.shift = os.path.join(self.folder, "shift")
        with open(self.shift, "wb") as file:
            file.write(struct.pack("q", 0))
        self.same_machine = dict(os.environ, LD_PRELOAD=str(BIN / "axisgate-shifted-clock.so"),
                                 AXISGATE_CLOCK_SHIFT=self.shift,
                                 PATH=f"{BIN}{os.pathsep}{os.environ['PATH']}")
        self.daemon = Daemon(self.folder, CONFIG,
                             env=dict(self.same_machine, STATE_DIRECTORY=os.path.join(self.folder, "state")))
        self.addCleanup(self.daemon.stop)
        self.same_machine["AXISGATE_TARGET"] = self.daemon.socket
        self.another_machine = dict(os.environ)

    def set_clock(self, seconds):
        with open(self.shift, "r+b") as file:
            file.write(struct.pack("q", seconds))

    def ask(self, *words, env=None):
        return subprocess.run(self.daemon.command(*words), env=env or self.same_machine, capture_output=True, text=True,
                              timeout=2 * LIMIT_S, check=False)

    def ask_well(self, *words, env=None):
        done = self.ask(*words, env=env)
        self.assertEqual(done.returncode, 0, f"{words}: {done.stdout}{done.stderr}")
        return done.stdout

    def start(self, *words):
        """On the daemon's machine."""
        shown = [f"{name}={self.same_machine[name]}" for name in ("LD_PRELOAD", "AXISGATE_CLOCK_SHIFT", "PATH",
                                                                  "AXISGATE_TARGET")]
        started = Lines(["env", *shown, *self.daemon.command(*words)])
        self.addCleanup(started.process.kill)
        return started

    def each_caller_after_each_jump(self):
        for jump in JUMPS:
            self.set_clock(jump)
            yield self.same_machine
            yield self.another_machine

    def history(self, *words):
        return [json.loads(line) for line in self.ask_well("--json", "history", *words).splitlines()]

    def test_a_request_that_comes_again_is_the_same_motion(self):
        repeated = ["--request-id", "night-17", *MOVE]
        self.assertIn("done: axis 1 at 1 um", self.ask_well(*repeated))
        for env in self.each_caller_after_each_jump():
            self.assertIn("done: axis 1 at 1 um", self.ask_well(*repeated, env=env))
        self.assertEqual(len(self.history("--outcome", "succeeded")), 1)
        self.assertIn("axis 1  1 um", self.ask_well("position"))

    def test_new_requests_are_done(self):
        moved = 0
        for env in self.each_caller_after_each_jump():
            moved += 1
            self.assertIn(f"done: axis 1 at {moved} um", self.ask_well(*MOVE, env=env))
            self.assertEqual(self.ask_well("exec", "?:P1", env=env), "10\n")
            self.assertIn("axis 1: replied OK", self.ask_well("stop", env=env))

    def test_who_waits_is_answered(self):
        watch = self.start("watch")
        for number, jump in zip((1, 3), JUMPS):
            move = self.start(*SLOW_MOVE)
            move.until("RUNNING")
            self.set_clock(jump)
            self.assertEqual(move.end(), 0, move.errors)
            watch.until(rf"motion {number} .*SUCCEEDED")
            self.ask_well("move", "1=0mm")
            watch.until("SUCCEEDED")

    def test_what_moves_is_stopped(self):
        for env in self.each_caller_after_each_jump():
            move = self.start("move", "1=+90mm", "--relative", "--speed", "1mm/s")
            move.until("RUNNING")
            self.assertIn("axis 1: replied OK", self.ask_well("stop", env=env))
            self.assertEqual(move.end(), 1)
            self.assertIn("STOPPED", move.errors)

    def test_a_lease_is_held_and_expires_as_before(self):
        for jump in JUMPS:
            end = os.path.join(self.folder, f"end{jump}")
            lease = self.start("lease", "run", "--axes", "1", "--", "sh", "-c", f"""
                axisctl move 1=1mm
                while [ ! -e '{end}' ]; do sleep 0.05; done
                axisctl move 1=2mm""")
            lease.until("done: axis 1")
            self.set_clock(jump)
            self.assertIn("axis 1  held by unix", self.ask_well("lease", "list"))
            self.assertIn("LEASE_HELD", self.ask("move", "1=0mm").stderr)
            with open(end, "w", encoding="ascii"):
                pass
            lease.until("done: axis 1 at 2000 um")
            self.assertEqual(lease.end(), 0, lease.errors)
        lost = self.start("lease", "run", "--axes", "1", "--", "sh", "-c", """
            axisctl move 1=1mm
            exec sleep 60 > /dev/null 2>&1""")
        lost.until("done: axis 1")
        self.set_clock(JUMPS[0])
        self.set_clock(JUMPS[1])
        lost.kill()
        self.assertIn("done: axis 1 at 0 um", self.ask_well("move", "1=0mm", "--wait", "25"), "it has expired")

    def test_the_history_is_in_the_order_of_its_numbers(self):
        for jump in (0, *JUMPS):
            self.set_clock(jump)
            self.ask_well(*MOVE)
        entries = self.history()
        numbers = [int(entry["number"]) for entry in entries]
        self.assertEqual(numbers, list(range(len(numbers), 0, -1)))
        years = [entry["time"][:4] for entry in entries if entry["kind"] == "HISTORY_KIND_MOTION_ENDED"]
        self.assertEqual(int(years[2]) - int(years[0]), 1, "the clock was set, and the newest entry is first")
        self.assertEqual(len(self.history("--hours", "1")), len(entries), "those of before are later than an hour ago")
        self.assertRegex(self.ask_well("audit", "verify"), r"\A\d+ entries are as they were written\n")

    def test_a_token_is_valid_by_the_calendar(self):
        token = self.ask_well("token", "create", "night-scan", "--days", "1").strip()
        by_token = dict(self.same_machine, AXISGATE_TOKEN=token)
        self.set_clock(JUMPS[0])
        refused = self.ask("whoami", env=by_token)
        self.assertEqual(refused.returncode, 3, refused.stdout)
        self.assertIn('UNAUTHENTICATED: the token "night-scan" has expired', refused.stderr)
        self.set_clock(JUMPS[1])
        self.assertEqual(self.ask_well("whoami", env=by_token), "token night-scan, operator\n")


if __name__ == "__main__":
    unittest.main(verbosity=2)
