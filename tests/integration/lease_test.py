#!/usr/bin/env python3
"""Two people at one stage: one on the Unix socket, the other over TCP, whom nobody knows by name."""

import json
import os
import re
import signal
import subprocess
import tempfile
import time
import unittest

from programs import BIN, LIMIT_S, Daemon, Lines

CONFIG = """
listen = "127.0.0.1:0"
metrics = "127.0.0.1:0"
socket = "{socket}"

[[device]]
name = "stage"
connection = "simulated"
"""

STRANGER = r"tcp 127\.0\.0\.1:\d+"


class Leases(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="axisctl-lease-")
        self.addCleanup(folder.cleanup)
        self.daemon = Daemon(folder.name, CONFIG)
        self.addCleanup(lambda: self.daemon.stop())

    def stranger(self, *arguments):
        return [BIN / "axisctl", "--target", self.daemon.address(), *arguments]

    def run_as_stranger(self, *arguments):
        return subprocess.run(self.stranger(*arguments), capture_output=True, text=True, timeout=2 * LIMIT_S,
                              check=False)

    def hold(self, *arguments):
        """The stranger holds a lease, as long as the command sleeps."""
        holder = Lines(self.stranger("lease", "run", *arguments, "--", "sh", "-c", "echo held $AXISGATE_LEASE; exec sleep 60"))
        self.addCleanup(self.let_go, holder)
        holder.token = holder.until("held").split()[1]
        return holder

    def let_go(self, holder):
        holder.process.terminate()  # passed on to its command
        holder.end()

    def command_of(self, holder):
        pid = holder.process.pid
        with open(f"/proc/{pid}/task/{pid}/children", encoding="ascii") as file:
            return int(file.read().split()[0])

    def await_board(self, pattern):
        deadline = time.monotonic() + LIMIT_S
        while True:
            board = self.daemon.run("lease", "list").stdout
            if re.search(pattern, board):
                return board
            self.assertLess(time.monotonic(), deadline, board)
            time.sleep(0.05)  # between two looks; the deadline above decides

    def test_a_refusal_says_who_holds_it_and_since_when(self):
        self.hold("--axes", "1", "--purpose", "scan of sample 12")
        refused = self.daemon.run("move", "1=1mm")
        self.assertEqual(refused.returncode, 3)
        self.assertRegex(refused.stderr, rf"\Aaxisctl: LEASE_HELD: {STRANGER} has held axis 1 for \d+ s "
                                         r"\(\"scan of sample 12\"\) \(to wait, add --wait SECONDS[^\n]*\n\Z")
        self.assertEqual(self.daemon.run("move", "2=1mm").returncode, 0)
        self.assertEqual(self.daemon.run("position").returncode, 0)

    def test_a_shell_and_its_scripts_share_one_lease(self):
        script = f"{BIN}/axisctl --target {self.daemon.address()} move 1=1mm && " \
                 f"{BIN}/axisctl --target {self.daemon.socket} exec 'D:1S100F1000R100'"
        ran = self.run_as_stranger("lease", "run", "--", "sh", "-c", script)
        self.assertEqual((ran.returncode, ran.stderr), (0, ""), ran.stdout)
        self.assertIn("done: axis 1 at 1000 um", ran.stdout)

    def test_the_commands_exit_code(self):
        self.assertEqual(self.run_as_stranger("lease", "run", "--", "sh", "-c", "exit 7").returncode, 7)
        self.assertEqual(self.run_as_stranger("lease", "run", "--", "sh", "-c", "kill -9 $$").returncode, 137)
        missing = self.run_as_stranger("lease", "run", "--", "/nonexistent/command")
        self.assertEqual(missing.returncode, 2)
        self.assertRegex(missing.stderr, r"cannot run /nonexistent/command")
        self.assertEqual(self.daemon.run("lease", "list").stdout, "no leases\n")

    def test_one_who_waits_gets_it_next(self):
        holder = self.hold("--axes", "1")
        waiting = self.daemon.start("move", "1=1mm", "--wait", "60")
        self.await_board(r"unix \S+ waits since [^\n]*  place 1 in the queue")
        holder.process.terminate()  # passed on to its command
        waiting.until("done: axis 1 at 1000 um")
        self.assertEqual(waiting.end(), 0)
        self.assertRegex(waiting.errors, "has held axis 1 .*; waiting")

    def test_a_closed_terminal_ends_command_and_lease(self):
        holder = self.hold("--axes", "1")
        holder.process.send_signal(signal.SIGHUP)
        self.assertEqual(holder.end(), 128 + signal.SIGHUP)
        self.assertEqual(self.daemon.run("lease", "list").stdout, "no leases\n")

    def test_waiting_while_something_moves_that_nobody_holds(self):
        self.assertEqual(self.daemon.run("move", "1=0.5mm", "--no-wait").returncode, 0)
        moved = self.daemon.run("move", "1=0mm", "--wait", "60")
        self.assertEqual(moved.returncode, 0, moved.stderr)
        self.assertIn("; waiting", moved.stderr)

    def test_a_lease_that_is_not_to_wait_names_what_moves(self):
        self.assertEqual(self.daemon.run("move", "1=0.5mm", "--no-wait").returncode, 0)
        refused = self.daemon.run("lease", "run", "--axes", "1", "--", "true")
        self.assertEqual(refused.returncode, 3)
        self.assertRegex(refused.stderr, rf"\Aaxisctl: LEASE_HELD: axis 1 is in motion 1 \(move by "
                                         rf"{re.escape(self.own_name())}(, \d+ s left)?\) \(to wait until it has ended, ")

    def test_ctrl_c_leaves_a_motion_running_also_with_wait(self):
        moving = self.daemon.start("move", "1=1mm", "--wait", "60")
        moving.until("RUNNING")
        moving.process.send_signal(signal.SIGINT)
        self.assertEqual(moving.end(), 130)
        self.assertIn("the motion continues", moving.errors)
        deadline = time.monotonic() + LIMIT_S
        while "axis 1  1000 um\n" not in self.daemon.run("position").stdout:
            self.assertLess(time.monotonic(), deadline, "the motion has not continued")
            time.sleep(0.05)  # between two looks; the deadline above decides

    def test_handing_over(self):
        script = f"echo held; until {BIN}/axisctl --target {self.daemon.socket} lease list | grep -q waits; " \
                 f"do sleep 0.05; done; {BIN}/axisctl --target {self.daemon.address()} lease hand-over \"$0\""
        holder = Lines(self.stranger("lease", "run", "--", "sh", "-c", script, self.own_name()))
        holder.until("held")
        waiting = self.daemon.start("move", "1=1mm", "--wait", "60")
        holder.until("handed over to unix")
        waiting.until("done: axis 1 at 1000 um")
        self.assertEqual(waiting.end(), 0)
        self.assertEqual(holder.end(), 0)

    def own_name(self):
        moved = self.daemon.run("--json", "move", "1=0mm").stdout.splitlines()
        return json.loads(moved[-1])["motion"]["caller"]["name"]

    def test_only_an_administrator_takes_over(self):
        refused = self.run_as_stranger("lease", "run", "--take-over", "--", "true")
        self.assertEqual(refused.returncode, 3)
        self.assertRegex(refused.stderr, r"NOT_ALLOWED: /axisgate\.v1\.ControlService/TakeOverLease asks for the role admin, and a caller "
                                         r"over TCP is operator \(call as")

    def test_a_take_over_stops_what_moves(self):
        holder = self.hold("--axes", "1")
        moving = Lines(["env", f"AXISGATE_LEASE={holder.token}", *self.stranger("move", "1=9mm")])
        moving.until("RUNNING")
        took = self.daemon.run("lease", "run", "--take-over", "--", BIN / "axisctl", "--target", self.daemon.socket,
                               "move", "1=0mm")
        self.assertEqual(took.returncode, 0, took.stderr)
        self.assertIn("done: axis 1 at 0 um", took.stdout)
        moving.end()
        self.assertRegex(moving.errors, "STOPPED: ")

    def test_a_holder_who_is_killed_leaves_nothing_moving(self):
        holder = self.hold("--axes", "1", "--at-loss", "stop-and-release")
        moving = Lines(["env", f"AXISGATE_LEASE={holder.token}", *self.stranger("move", "1=9mm")])
        moving.until("RUNNING")
        command = self.command_of(holder)
        holder.process.kill()
        moving.end()
        os.kill(command, signal.SIGTERM)  # it outlived what had started it
        self.assertRegex(moving.errors, "STOPPED: ")
        self.assertEqual(self.daemon.run("move", "1=0mm").returncode, 0)

    def test_a_scan_loop_stays_stopped_and_its_author_reads_why(self):
        loop = f"for i in 1 2 3 4 5 6; do {BIN}/axisctl --target {self.daemon.address()} move 1=1mm --relative; done"
        scan = Lines(self.stranger("lease", "run", "--axes", "1", "--", "sh", "-c", loop))
        scan.until("done")
        self.assertEqual(self.daemon.run("stop").returncode, 0)
        scan.end()
        self.assertRegex(scan.errors, r"STOPPED_BY: unix \S+ stopped axis 1 \(\d+ s ago\): your motions there are refused "
                                      r"until you rearm")

    def test_rearm(self):
        holder = self.hold("--axes", "1")
        self.daemon.run("stop")
        move = ["env", f"AXISGATE_LEASE={holder.token}", *self.stranger("move", "1=1mm")]
        stopped = subprocess.run(move, capture_output=True, text=True, timeout=LIMIT_S, check=False)
        self.assertEqual(stopped.returncode, 3)
        self.assertRegex(stopped.stderr, "STOPPED_BY: unix .* your motions there are refused until you rearm")
        outside = self.daemon.run("rearm")
        self.assertRegex(outside.stdout, rf"\Ayou have no latch; a lease of {STRANGER} has one on axis 1: to end it, "
                                         r"run `axisctl rearm` as its holder, or inside its `axisctl lease run`\n\Z")
        rearmed = subprocess.run(["env", f"AXISGATE_LEASE={holder.token}", *self.stranger("rearm")],
                                 capture_output=True, text=True, timeout=LIMIT_S, check=False)
        self.assertRegex(rearmed.stdout, r"\Areleased: the stop of axis 1 by unix \S+ at .*\naxis 1 may move again\n\Z")
        self.assertEqual(self.daemon.run("rearm").stdout, "there is no latch\n")
        self.assertEqual(subprocess.run(move, capture_output=True, timeout=LIMIT_S, check=False).returncode, 0)

    def test_a_token_that_is_none(self):
        wrong = subprocess.run(self.stranger("move", "1=1mm"), env=dict(os.environ, AXISGATE_LEASE="mine"),
                               capture_output=True, text=True, timeout=LIMIT_S, check=False)
        self.assertEqual(wrong.returncode, 2)
        self.assertIn("AXISGATE_LEASE is not the token of a lease", wrong.stderr)
        stop = subprocess.run(self.stranger("stop"), env=dict(os.environ, AXISGATE_LEASE="mine"),
                              capture_output=True, text=True, timeout=LIMIT_S, check=False)
        self.assertEqual(stop.returncode, 0, "nothing holds a stop up: " + stop.stderr)
        old = subprocess.run(self.stranger("move", "1=1mm"), env=dict(os.environ, AXISGATE_LEASE="00" * 24),
                             capture_output=True, text=True, timeout=LIMIT_S, check=False)
        self.assertEqual(old.returncode, 3)
        self.assertIn("LEASE_LOST: no lease has this token; those of before the daemon's start have ended", old.stderr)
        guess = subprocess.run(self.stranger("move", "1=1mm"), env=dict(os.environ, AXISGATE_LEASE="ff" * 24),
                               capture_output=True, text=True, timeout=LIMIT_S, check=False)
        self.assertEqual(guess.returncode, 3)
        self.assertIn("LEASE_LOST: no lease has this token", guess.stderr)


if __name__ == "__main__":
    unittest.main(verbosity=2)
