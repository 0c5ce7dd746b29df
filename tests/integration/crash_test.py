#!/usr/bin/env python3
"""The daemon is killed (SIGKILL) in the middle of each kind of motion, and started again on the same controller.

AXISGATE_CRASHES=20 kills so often for each kind; the ordinary run does once."""

import os
import random
import re
import signal
import tempfile
import time
import unittest

from programs import BIN, LIMIT_S, Daemon, Lines
from serial_line import ask

ROUNDS = int(os.environ.get("AXISGATE_CRASHES", "1"))
CONFIG = """
listen = "127.0.0.1:0"
metrics = "127.0.0.1:0"
socket = "{socket}"

[[device]]
name = "stage"
connection = "serial"
path = "TTY"
baud = 38400
at_exit = "POLICY"
"""
# What is asked of axisctl, by kind; each would take seconds. How it ends without a crash is tested elsewhere.
MOTIONS = {
    "move": ["move", "1=+9mm", "--relative"],
    "home": ["home", "1"],
    "path": ["line", "1=+9mm", "2=+3mm"],
    "scan": ["scan", "1", "0mm", "9mm", "--every", "1000"],
    "jog": ["jog", "1=+", "--speed", "1mm/s"],
    "execute": ["exec", "M:1+P900000", "G:1"],
}


class Crash(unittest.TestCase):
    def start(self, policy):
        self.folder = tempfile.TemporaryDirectory(prefix="axisgate-crash-")
        self.addCleanup(self.folder.cleanup)
        self.tty = os.path.join(self.folder.name, "tty")
        self.policy = policy
        simulator = Lines([BIN / "shrc203-sim", "--pty", self.tty, "--baud", "38400"])
        self.addCleanup(simulator.kill)
        simulator.until("simulator on")
        self.start_daemon()

    def start_daemon(self):
        self.daemon = Daemon(self.folder.name, CONFIG.replace("TTY", self.tty).replace("POLICY", self.policy))
        self.addCleanup(self.daemon.stop)

    def crash_during(self, kind):
        """Within a tenth of a second after the first sign of movement: the shortest, home, takes less than a second."""
        motion = self.daemon.start(*MOTIONS[kind])
        self.wait_until(lambda: "busy yes" in self.daemon.run("status").stdout, f"{kind} moves")
        time.sleep(random.uniform(0, 0.1))  # not awaited: any instant will do
        self.daemon.signal(signal.SIGKILL)
        self.daemon.exit_code()
        # A transaction ends for its caller with the replies.
        self.assertNotEqual(motion.end(), 0 if kind != "execute" else 1, "nobody saw the motion end")

    def wait_until(self, condition, what):
        deadline = time.monotonic() + LIMIT_S
        while not condition():
            self.assertLess(time.monotonic(), deadline, what)
            time.sleep(0.02)  # between two looks; the deadline above decides

    def status(self):
        return self.daemon.run("status").stdout

    def position(self):
        """Of axis 1, in µm."""
        return float(re.search(r"^axis 1 +(-?[\d.]+) um", self.status(), re.MULTILINE)[1])

    def test_what_moved_is_stopped_and_moves_no_second_time(self):
        for kind in MOTIONS:
            for _ in range(ROUNDS):
                with self.subTest(kind=kind):
                    self.start("stop")
                    self.crash_during(kind)
                    self.start_daemon()
                    log = self.daemon.log()
                    self.assertRegex(log, r"stage: the daemon ended during motion \d+ \([a-z-]+, asked by unix "
                                          r"\S+\); stopping (axis 1|axes 1 and 2)\n")
                    self.assertRegex(log, r"ended during motion [^\n]* stationary now, outcome unknown")
                    self.assertNotIn("FOREIGN_MOTION", log)
                    self.wait_until(lambda: "OPEN STOP" not in self.status(), "the stop is confirmed")
                    stands_at = self.status()
                    self.assertNotIn("busy yes", stands_at)
                    self.assertEqual(self.status(), stands_at)
                    self.assertEqual(self.daemon.run("move", "1=+1um", "--relative").returncode, 0)

    def test_what_may_finish_finishes(self):
        self.start("finish")
        begin = self.position()
        self.crash_during("move")
        self.start_daemon()
        self.assertRegex(self.daemon.log(), r"ended during motion 1 \(move, asked by unix \S+\); letting axis 1 finish")
        self.assertNotIn("FOREIGN_MOTION", self.daemon.log())
        self.assertEqual(self.position(), begin + 9000)

    def test_a_jog_is_stopped_even_so(self):
        self.start("finish")
        self.crash_during("jog")
        self.start_daemon()
        self.assertRegex(self.daemon.log(), r"ended during motion 1 \(jog, asked by unix \S+\); stopping axis 1")

    def test_where_another_program_used_the_line_it_is_foreign(self):
        self.start("stop")
        begin = self.position()
        self.crash_during("move")
        ask(self.tty, "*IDN?")
        self.start_daemon()
        log = self.daemon.log()
        self.assertRegex(log, r"ended during motion 1 \(move, asked by unix \S+\); another controller answers now, or "
                              r"another program has used the line since")
        self.assertIn("FOREIGN_MOTION: axis 1 moves", log)
        self.assertEqual(self.position(), begin + 9000, "it was not stopped")

    def test_what_had_ended_is_nothing_to_stop(self):
        self.start("stop")
        self.assertEqual(self.daemon.run("move", "1=+100um", "--relative").returncode, 0)
        self.daemon.signal(signal.SIGKILL)
        self.daemon.exit_code()
        self.start_daemon()
        self.assertNotIn("was killed", self.daemon.log())


if __name__ == "__main__":
    unittest.main()
