#!/usr/bin/env python3
"""The daemon on a serial server's raw port: a small server on loopback, and shrc203-sim on the tty behind it."""

import os
import socket
import tempfile
import unittest

from programs import BIN, Daemon, Lines
from serial_line import SerialServer

CONFIG = """
listen = "127.0.0.1:0"
metrics = "127.0.0.1:0"
socket = "{socket}"

[[device]]
name = "stage"
connection = "tcp"
host = "localhost"
port = PORT
baud = 38400
"""


class OnASerialServer(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="axisgate-tcp-")
        self.addCleanup(folder.cleanup)
        self.folder = folder.name
        path = os.path.join(self.folder, "tty")
        simulator = Lines([BIN / "shrc203-sim", "--pty", path, "--baud", "38400"])
        self.addCleanup(simulator.kill)
        simulator.until("simulator on")
        self.server = SerialServer(path)
        self.addCleanup(self.server.stop)

    def start_daemon(self, port):
        daemon = Daemon(self.folder, CONFIG.replace("PORT", str(port)))
        self.addCleanup(daemon.stop)
        return daemon

    def test_a_move_and_a_connection_that_comes_back(self):
        daemon = self.start_daemon(self.server.port)
        moved = daemon.run("move", "1=1mm")
        self.assertEqual(moved.returncode, 0, moved.stderr)
        self.server.drop_connection()
        daemon.wait_for_log("link is DOWN: the line was closed at its other end(.|\n)*link is UP")
        self.assertEqual(daemon.run("exec", "Q:SP").stdout.split(",")[0], "P+100000")

    def test_a_port_that_nobody_serves_says_what_to_do(self):
        with socket.create_server(("127.0.0.1", 0)) as free:
            port = free.getsockname()[1]
        spare = '\n[[device]]\nname = "spare"\nconnection = "simulated"\n'
        daemon = Daemon(self.folder, CONFIG.replace("PORT", str(port)) + spare)
        self.addCleanup(daemon.stop)
        status = daemon.run("--device", "stage", "status").stdout
        self.assertIn(f"connection refused by localhost:{port}", status)
        self.assertIn("one connection", status)
        self.assertEqual(daemon.run("--device", "spare", "exec", "?:N").stdout, "SHRC-203\n")


if __name__ == "__main__":
    unittest.main()
