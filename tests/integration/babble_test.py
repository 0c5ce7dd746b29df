#!/usr/bin/env python3
"""A serial server that sends without end: the line is shut, stops go out all the same, and the recording stays small."""

import json
import os
import pathlib
import select
import socket
import tempfile
import threading
import time
import unittest

from cables import Unit
from programs import LIMIT_S, Daemon

NOISE = b"what the firmware says while nobody asks it\r\n" * 1000
CONFIG = """
listen = "127.0.0.1:0"
metrics = "127.0.0.1:0"
socket = "{socket}"

[[device]]
name = "stage"
connection = "tcp"
host = "127.0.0.1"
port = PORT
record = "RECORD"
record_megabytes = 32
"""
SECONDS = 5
BYTES_MAX = 2_000_000  # of a recording of SECONDS: each opening hears some hundred kB at most


class SerialServer:
    """A raw line over TCP to a unit, or while `noisy` to something that only talks."""

    def __init__(self, unit):
        self.noisy = False
        self.told = b""  # while it was noisy
        self._unit = unit
        self._socket = socket.create_server(("127.0.0.1", 0))
        self.port = self._socket.getsockname()[1]
        self._ended = threading.Event()
        self._thread = threading.Thread(target=self._serve)
        self._thread.start()

    def end(self):
        self._ended.set()
        self._thread.join()
        self._socket.close()

    def _serve(self):
        self._socket.settimeout(0.1)
        while not self._ended.is_set():
            try:
                line, _ = self._socket.accept()
            except TimeoutError:
                continue
            with line:
                self._unit.forget_unread()
                try:
                    while not self._ended.is_set() and self._carry(line):
                        pass
                except (ConnectionError, TimeoutError):
                    pass

    def _carry(self, line):
        """False: the caller has hung up."""
        line.settimeout(1)
        noisy = self.noisy
        if noisy:
            line.sendall(NOISE)
        ready, _, _ = select.select([line, self._unit.tty], [], [], 0 if noisy else 0.1)
        if line in ready:
            data = line.recv(4096)
            if not data:
                return False
            if noisy:
                self.told += data
            else:
                self._unit.tell(data)
        if not noisy and self._unit.tty in ready:
            line.sendall(os.read(self._unit.tty, 4096))
        return True


class Babble(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="axisgate-babble-")
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        unit = Unit(str(self.folder / "unit"), "2106001001")
        self.addCleanup(unit.end)
        self.server = SerialServer(unit)
        self.addCleanup(self.server.end)
        self.record = self.folder / "recording"
        config = CONFIG.replace("PORT", str(self.server.port)).replace("RECORD", str(self.record))
        self.daemon = Daemon(folder.name, config)
        self.addCleanup(self.daemon.stop)
        self.link_is("LINK_STATE_UP")

    def link_is(self, wanted):
        limit = time.monotonic() + LIMIT_S
        while (status := json.loads(self.daemon.run("--json", "status").stdout))["link"] != wanted:
            self.assertLess(time.monotonic(), limit, status)
            time.sleep(0.01)  # between two looks; the limit above decides
        return status

    def metric_is(self, wanted):
        limit = time.monotonic() + LIMIT_S
        while f'axisgate_line_babbles{{device="stage"}} {wanted}\n' not in self.daemon.metrics_page():
            self.assertLess(time.monotonic(), limit)
            time.sleep(0.01)  # between two looks; the limit above decides

    def test_it_has_a_name_and_stops_go_out(self):
        self.metric_is(0)
        self.server.noisy = True
        status = self.link_is("LINK_STATE_BABBLING")
        self.assertIn("it sends without end", status["link_problem"])
        self.metric_is(1)
        moved = self.daemon.run("move", "1=1mm")
        self.assertEqual((moved.returncode, moved.stdout), (4, ""))
        self.assertRegex(moved.stderr, r"LINK_DOWN: [^\n]*it sends without end")
        self.server.told = b""
        stopped = self.daemon.run("stop")
        self.assertEqual(stopped.returncode, 1, stopped.stderr)
        self.assertIn("stays open", stopped.stderr)
        # The line may have been opened just before the stop was asked.
        self.assertRegex(self.server.told, rb"\A(\*IDN\?\r\n)?L:(W|E|1,1,1|D)\r\n")
        limit = time.monotonic() + LIMIT_S
        while self.server.told.count(b"L:") < 20:
            self.assertLess(time.monotonic(), limit, self.server.told)
            time.sleep(0.05)  # between two looks; the limit above decides
        self.assertLess(self.daemon.run("history").stdout.count("sent: L:"), 12, "it is repeated all night")
        self.server.noisy = False
        self.link_is("LINK_STATE_UP")
        history = self.daemon.run("history").stdout
        self.assertRegex(history, r"stop 1 of axes 1, 2, 3 confirmed after \d+ ms")
        self.metric_is(0)

    def test_the_recording_stays_small(self):
        self.server.noisy = True
        self.link_is("LINK_STATE_BABBLING")
        before = self.record.stat().st_size
        time.sleep(SECONDS)  # of noise, which is what is measured
        self.assertLess(self.record.stat().st_size - before, BYTES_MAX)


if __name__ == "__main__":
    unittest.main()
