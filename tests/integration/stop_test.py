#!/usr/bin/env python3
"""axisctl stop and estop: one call, several devices, and an outcome that is learnt although streams are refused."""

import os
import subprocess
import tempfile
import time
import unittest

from message_relay import MessageRelay
from programs import BIN, LIMIT_S, Daemon, Lines

HEAD = """
listen = "127.0.0.1:0"
metrics = "127.0.0.1:0"
socket = "{socket}"
"""
STAGE = '[[device]]\nname = "{}"\nconnection = "simulated"\n'
# Nothing listens there.
DEAD = '[[device]]\nname = "dead"\nconnection = "tcp"\nhost = "127.0.0.1"\nport = 1\n'
# So slow that the handshake takes a while.
SLOW = '[[device]]\nname = "slow"\nconnection = "serial"\npath = "TTY"\nbaud = 9600\n'
STOPPED = r"replied OK, stationary at \S+ um\n"


class Stops(unittest.TestCase):
    def with_daemon(self, config):
        folder = tempfile.TemporaryDirectory(prefix="axisgate-stop-")
        self.addCleanup(folder.cleanup)
        self.folder = folder.name
        self.daemon = Daemon(folder.name, HEAD + config)
        self.addCleanup(self.daemon.stop)

    def calls_of(self, *arguments):
        """How many calls that takes, which succeeds."""
        relay = MessageRelay(os.path.join(self.folder, "relay.sock"), self.daemon.socket)
        try:
            answer = subprocess.run([BIN / "axisctl", "--target", f"unix:{relay.path}", *arguments],
                                    capture_output=True, text=True, timeout=LIMIT_S, check=False)
        finally:
            relay.stop()
            os.unlink(relay.path)
        self.assertEqual((answer.returncode, answer.stderr), (0, ""), arguments)
        return relay.streams()

    def test_one_call(self):
        self.with_daemon(STAGE.format("stage") + '[[device.axis]]\nnumber = 1\nname = "x"\n')
        for arguments in (["stop"], ["stop", "1"], ["stop", "1", "3"], ["--device", "stage", "stop"], ["estop"]):
            with self.subTest(arguments):
                self.assertEqual(self.calls_of(*arguments), 1)
        # Only what a name means is asked first.
        self.assertEqual(self.calls_of("stop", "x"), 2)

    def test_all_devices(self):
        self.with_daemon(STAGE.format("left") + STAGE.format("right"))
        for device in ("left", "right"):
            moved = self.daemon.run("--device", device, "move", "1=90mm", "--speed", "1mm/s", "--no-wait")
            self.assertEqual(moved.returncode, 0, moved.stderr)
        answer = self.daemon.run("stop")
        self.assertEqual((answer.returncode, answer.stderr), (0, ""))
        lines = "".join(f"{device}: axis {axis}: {STOPPED}" for device in ("left", "right") for axis in (1, 2, 3))
        self.assertRegex(answer.stdout, rf"\A{lines}\Z")
        answer = self.daemon.run("stop", "1")
        self.assertEqual((answer.returncode, answer.stdout), (2, ""))
        self.assertRegex(answer.stderr, r"\Aaxisctl: INVALID_REQUEST: .*left, right[^\n]*\n\Z")
        self.assertRegex(self.daemon.run("--device", "right", "stop", "1").stdout, rf"\Aaxis 1: {STOPPED}\Z")

    def test_while_the_daemon_connects(self):
        folder = tempfile.TemporaryDirectory(prefix="axisgate-stop-tty-")
        self.addCleanup(folder.cleanup)
        tty = os.path.join(folder.name, "tty")
        simulator = Lines([BIN / "shrc203-sim", "--pty", tty, "--baud", "9600"])
        self.addCleanup(simulator.kill)
        simulator.until("simulator on")
        self.with_daemon(STAGE.format("ready") + SLOW.replace("TTY", tty))
        answers = []
        deadline = time.monotonic() + LIMIT_S
        while "slow: link is UP" not in self.daemon.log():
            self.assertLess(time.monotonic(), deadline)
            answers.append(self.daemon.run("--device", "slow", "stop"))
        self.assertTrue(answers)
        for answer in answers:
            if answer.returncode == 0:
                self.assertRegex(answer.stdout, rf"\A(axis \d: {STOPPED})+\Z")
            else:
                self.assertRegex(answer.stderr, r"\Aaxisctl: [A-Z_]+: \w[^\n]+\n")

    def test_one_that_cannot_be_stopped_hides_no_other(self):
        self.with_daemon(DEAD + STAGE.format("stage"))
        answer = self.daemon.run("stop")
        self.assertEqual(answer.returncode, 1, answer.stderr)
        self.assertRegex(answer.stderr, r"\Aaxisctl: OUTCOME_UNKNOWN: dead: the stop was not written yet and stays open: [^\n]*\n\Z")
        self.assertRegex(answer.stdout, rf"(?m)^stage: axis 1: {STOPPED}")
        self.assertRegex(answer.stdout, r"(?m)^dead: axis 1: no stop sent yet, state unknown, position unknown$")

    # The display of the motion takes the only stream.
    def test_an_emergency_stop_outlives_the_daemon_and_half_a_clear(self):
        self.with_daemon(STAGE.format("stage"))
        self.assertEqual(self.daemon.run("estop").returncode, 0)
        self.daemon.kill()
        self.daemon = Daemon(self.folder, HEAD + STAGE.format("stage"))
        self.addCleanup(self.daemon.stop)
        refused = self.daemon.run("move", "1=1mm")
        self.assertRegex(refused.stderr, r"EMERGENCY_STOPPED: unix \S+ requested an emergency stop [^\n]*`axisctl clear`")
        remains = "the emergency stop of unix \\S+ remains, and nothing moves: `axisctl clear` ends it\n"
        self.assertRegex(self.daemon.run("rearm").stdout, remains)
        half = self.daemon.run("clear", "1")
        self.assertEqual(half.returncode, 0, half.stderr)
        self.assertIn("the emergency stop remains, and nothing moves: `axisctl clear` without axes ends it\n", half.stdout)
        self.assertNotIn("remains", self.daemon.run("clear").stdout)
        self.assertNotIn("1970", self.daemon.run("history").stdout)

    def test_an_outcome_without_a_stream(self):
        self.with_daemon(STAGE.format("stage") + "[limits]\nstreams = 1\n")
        answer = self.daemon.run("move", "1=1um")
        self.assertEqual((answer.returncode, answer.stderr), (0, ""))
        self.assertRegex(answer.stdout, r"(?m)^done: axis 1 at 1 um$")


if __name__ == "__main__":
    unittest.main(verbosity=2)
