#!/usr/bin/env python3
"""The daemon is killed (SIGKILL) while three callers repeat relative moves until they know what became of them.

No move runs twice, and none is reported done that did not run: axisgate-repeater compares each with the place of its
axis. Every second kill comes at a system call of the daemon, by strace: as the journal is written or synced, or as bytes
go out on the line. AXISGATE_KILLS=500 kills so often; the ordinary run does 16 times. AXISGATE_KILL_SEED chooses when.
"""

import os
import random
import re
import signal
import subprocess
import tempfile
import time
import unittest

from programs import BIN, LIMIT_S, Daemon, Lines, can_trace

KILLS = int(os.environ.get("AXISGATE_KILLS", "16"))
SEED = int(os.environ.get("AXISGATE_KILL_SEED", random.randrange(1_000_000)))
CONFIG = """
listen = "127.0.0.1:0"
metrics = "127.0.0.1:0"
socket = "{socket}"

[[device]]
name = "stage"
connection = "serial"
path = "TTY"
baud = 38400
at_exit = "finish"
busy_scope = "axis"
"""
# How often each is called before the daemon dies at it. A start alone syncs some ten times.
FAULTS = {"fdatasync": (8, 40), "pwrite64": (20, 150), "write": (150, 900)}


class Kill(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="axisgate-kill-")
        self.addCleanup(folder.cleanup)
        self.folder = folder.name
        self.tty = os.path.join(self.folder, "tty")
        self.random = random.Random(SEED)
        simulator = Lines([BIN / "shrc203-sim", "--pty", self.tty, "--baud", "38400", "--option", "busy_scope=axis"])
        self.addCleanup(simulator.kill)
        simulator.until("simulator on")

    def daemon(self, program="axisgated"):
        return Daemon(self.folder, CONFIG.replace("TTY", self.tty), program=program)

    def dying_daemon(self):
        """Dies at a system call. strace is its grandchild, so that signals reach the daemon."""
        call = self.random.choice(sorted(FAULTS))
        when = self.random.randint(*FAULTS[call])
        script = os.path.join(self.folder, "dying")
        with open(script, "w", encoding="utf-8") as file:
            file.write(f"#!/bin/sh\nexec strace -D -f -qq -o /dev/null -e trace={call} -e inject={call}:signal=KILL:when={when}"
                       f" {BIN / 'axisgated'} \"$@\"\n")
        os.chmod(script, 0o755)
        return self.daemon(script)

    def test_no_move_runs_twice(self):
        daemon = self.daemon()
        self.addCleanup(lambda: daemon.stop())
        repeater = subprocess.Popen([BIN / "axisgate-repeater", "--socket", daemon.socket, "--seed", str(SEED)],
                                    stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)
        self.addCleanup(repeater.kill)
        in_motion = 0
        for kill in range(KILLS):
            if kill % 2 == 0:
                time.sleep(self.random.uniform(0.05, 0.8))  # any instant will do
                daemon.signal(signal.SIGKILL)
            self.gone(daemon)
            in_motion += self.killed_in_motion(daemon)
            try:
                daemon = self.dying_daemon() if kill % 2 == 0 and can_trace() else self.daemon()
            except AssertionError:  # it died as it started
                daemon = self.daemon()
        daemon.signal(signal.SIGKILL)
        self.gone(daemon)
        daemon = self.daemon()
        said, _ = repeater.communicate("", timeout=10 * LIMIT_S)
        daemon.stop()
        figures = f"seed {SEED}, {KILLS} kills, {in_motion} of them in motion: {said}"
        print(figures)
        self.assertEqual(repeater.returncode, 0, figures)
        self.assertGreater(int(re.search(r"succeeded (\d+)", said)[1]), KILLS, figures)
        self.assertIn("entries are as they were written", self.verdict())

    def gone(self, daemon):
        """Where it does not die by itself in time, the call has not come so often: it is killed."""
        try:
            daemon.wait(3)
        except subprocess.TimeoutExpired:
            daemon.signal(signal.SIGKILL)
            daemon.wait(LIMIT_S)

    def killed_in_motion(self, daemon):
        """By the record of what moved, which the next run reads."""
        with open(os.path.join(self.folder, "state", "motions-stage"), "rb") as file:
            content = file.read()
        half = (len(content) - 1) // 2
        text = content[1 + half:] if content[:1] == b"1" else content[1:1 + half]
        moving = re.search(rb"\nmoving (\d+)\n", text)
        return 1 if moving and int(moving[1]) else 0

    def verdict(self):
        daemon = self.daemon()
        self.addCleanup(daemon.stop)
        return daemon.run("audit", "verify").stdout


if __name__ == "__main__":
    unittest.main()
