#!/usr/bin/env python3
"""How the daemon ends: SIGTERM in mid-move, with shrc203-sim at the other end of a pseudo-terminal."""

import os
import signal
import tempfile
import unittest

from programs import BIN, Daemon, Lines
from serial_line import ask

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


class End(unittest.TestCase):
    def start(self, policy):
        folder = tempfile.TemporaryDirectory(prefix="axisgate-end-")
        self.addCleanup(folder.cleanup)
        self.tty = os.path.join(folder.name, "tty")
        self.simulator = Lines([BIN / "shrc203-sim", "--pty", self.tty, "--baud", "38400"])
        self.addCleanup(lambda: self.simulator.kill())
        self.simulator.until("simulator on")
        self.daemon = Daemon(folder.name, CONFIG.replace("TTY", self.tty).replace("POLICY", policy))
        self.addCleanup(self.daemon.stop)

    def start_move(self, target):
        move = self.daemon.start("move", target, "--relative")
        move.until("RUNNING")
        return move

    def position(self):
        """Of axis 1 in pulses, and whether it moves."""
        fields = ask(self.tty, "Q:SP").split(",")
        return int(fields[0].replace("P", "")), fields[-3] == "B"

    def test_what_moves_is_stopped_and_its_caller_told(self):
        self.start("stop")
        move = self.start_move("1=+9mm")
        self.daemon.signal(signal.SIGTERM)
        self.assertEqual(self.daemon.exit_code(), 0)
        self.assertEqual(move.end(), 1)
        self.assertRegex(move.errors, r"\Aaxisctl: STOPPED: [^\n]+\n\Z")
        position, moves = self.position()
        self.assertFalse(moves)
        self.assertLess(0, position)
        self.assertLess(position, 900_000)
        log = self.daemon.log()
        self.assertIn("ending: SIGTERM", log)
        self.assertRegex(log, r"motion 1 .* is STOPPED")
        self.assertIn("the line is closed; motions that were running: 1 STOPPED", log)

    def test_streams_are_told_that_the_daemon_ends(self):
        self.start("stop")
        recorder = self.daemon.start("record")
        watcher = self.daemon.start("watch", "--from", "1")
        recorder.next()
        watcher.until("daemon started")
        self.daemon.signal(signal.SIGTERM)
        self.assertEqual(self.daemon.exit_code(), 0)
        self.assertEqual(recorder.end(), 4)
        self.assertEqual(recorder.errors,
                         "axisctl: DAEMON_ENDING: the daemon is ending (connect again when it runs again)\n")
        watcher.until_error(r"DAEMON_ENDING: the daemon is ending \(trying again from revision \d+\)")
        watcher.kill()  # it waits for the next daemon

    def test_finish_waits_for_what_moves_and_takes_nothing_new(self):
        self.start("finish")
        move = self.start_move("1=+1mm")
        self.daemon.signal(signal.SIGTERM)
        self.daemon.wait_for_log("ending: SIGTERM")
        late = self.daemon.run("move", "2=+1mm", "--relative")
        self.assertNotEqual(late.returncode, 0)
        self.assertIn("NOT_SENT: the gateway is ending", late.stderr)
        self.assertEqual(self.daemon.exit_code(), 0)
        self.assertEqual(move.end(), 0, move.errors)
        self.assertEqual(self.position(), (100_000, False))
        self.assertIn("the line is closed; motions that were running: 1 SUCCEEDED", self.daemon.log())

    def test_a_second_signal_ends_at_once(self):
        self.start("finish")
        move = self.start_move("1=+9mm")
        self.daemon.signal(signal.SIGTERM)
        self.daemon.wait_for_log("ending: SIGTERM")
        self.daemon.signal(signal.SIGINT)
        self.assertEqual(self.daemon.exit_code(), 0)
        self.assertIn("ending at once", self.daemon.log())
        self.assertTrue(self.position()[1], "it had been told to finish")
        self.assertNotEqual(move.end(), 0)

    def test_a_dead_line_does_not_hold_the_end_up(self):
        self.start("stop")
        move = self.start_move("1=+9mm")
        self.simulator.kill()
        self.daemon.signal(signal.SIGTERM)
        self.assertEqual(self.daemon.exit_code(), 0)
        self.assertEqual(move.end(), 1)
        self.assertIn("OUTCOME_UNKNOWN", move.errors)
        self.assertIn("the line is closed", self.daemon.log())


if __name__ == "__main__":
    unittest.main()
