#!/usr/bin/env python3
"""The daemon on a real tty: shrc203-sim at the other end of a pseudo-terminal, paced as at 38400 baud."""

import os
import re
import subprocess
import tempfile
import unittest

from programs import BIN, LIMIT_S, ROOT, Daemon, Lines

CONFIG = """
listen = "127.0.0.1:0"
metrics = "127.0.0.1:0"
socket = "{socket}"

[[device]]
name = "stage"
connection = "serial"
path = "TTY"
baud = 38400
"""


class RealTty(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="axisgate-tty-")
        self.addCleanup(folder.cleanup)
        self.folder = folder.name
        self.tty = os.path.join(self.folder, "tty")
        self.start_simulator()
        self.addCleanup(lambda: self.simulator.kill())
        self.daemon = Daemon(self.folder, CONFIG.replace("TTY", self.tty))
        self.addCleanup(lambda: self.daemon.stop())

    def start_simulator(self):
        self.simulator = Lines([BIN / "shrc203-sim", "--pty", self.tty, "--baud", "38400"])
        self.simulator.until("simulator on")

    def test_demonstration(self):
        shown = subprocess.run([ROOT / "deploy" / "demo" / "run.sh", BIN / "axisctl", "--target", self.daemon.socket],
                               capture_output=True, text=True, timeout=4 * LIMIT_S, check=False)
        self.assertEqual(shown.returncode, 0, shown.stdout + shown.stderr)
        # On a busy machine a segment may come too late: then it is said.
        self.assertEqual(len(re.findall(r"segment \d+ (?:sent: OK_D|came too late)", shown.stdout)), 19, shown.stdout)

    def test_a_line_lost_in_mid_move_leaves_the_outcome_unknown(self):
        move = self.daemon.start("move", "1=+9mm", "--relative")
        move.until("RUNNING")
        self.simulator.kill()
        self.start_simulator()
        self.assertEqual(move.end(), 1)
        self.assertRegex(move.errors, r"\Aaxisctl: OUTCOME_UNKNOWN: [^\n]+\n\Z")
        watch = self.daemon.start("watch", "--from", "1")
        self.addCleanup(watch.kill)
        watch.until("UNKNOWN")
        watch.until("UP")
        self.assertEqual(self.daemon.run("exec", "?:N").stdout, "SHRC-203\n")

    def test_a_stable_path_that_leads_elsewhere_after_an_unplug(self):
        stable = os.path.join(self.folder, "by-id")
        os.symlink(self.tty, stable)
        second = tempfile.TemporaryDirectory(prefix="axisgate-tty-")
        self.addCleanup(second.cleanup)
        self.daemon.stop()
        daemon = Daemon(second.name, CONFIG.replace("TTY", stable))
        self.addCleanup(daemon.stop)
        unplugged, before = self.simulator, os.path.realpath(stable)
        self.tty = os.path.join(self.folder, "tty-plugged-in-again")
        self.start_simulator()  # while the first is there, or it might get the same name
        unplugged.kill()
        daemon.wait_for_log("link is DOWN")
        os.symlink(self.tty, stable + ".new")
        os.replace(stable + ".new", stable)
        daemon.wait_for_log("link is UP(.|\n)*link is UP")
        self.assertEqual(daemon.run("exec", "?:N").stdout, "SHRC-203\n")
        self.assertNotEqual(os.path.realpath(stable), before)

    def test_another_process_holds_the_tty(self):
        second = tempfile.TemporaryDirectory(prefix="axisgate-tty-")
        self.addCleanup(second.cleanup)
        config = CONFIG.replace("TTY", self.tty) + '\n[[device]]\nname = "spare"\nconnection = "simulated"\n'
        other = Daemon(second.name, config)
        self.addCleanup(other.stop)
        status = other.run("--device", "stage", "status").stdout
        self.assertIn("held by another process", status)
        self.assertEqual(self.daemon.run("exec", "?:N").stdout, "SHRC-203\n")


if __name__ == "__main__":
    unittest.main()
