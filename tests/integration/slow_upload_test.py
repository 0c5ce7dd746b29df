#!/usr/bin/env python3
"""A job over a slow way, and over one that stops moving: axisctl and the daemon both wait as long as something comes.

AXISGATE_UPLOAD_BYTES=3400000 sends a job of that size: six minutes at this pace.
"""

import contextlib
import os
import pathlib
import select
import socket
import subprocess
import tempfile
import threading
import time
import unittest

from programs import BIN, Daemon

CONFIG = """
listen = "127.0.0.1:0"
metrics = "127.0.0.1:0"
socket = "{socket}"

[access]
local = "admin"

[[device]]
name = "mill"
kind = "rml1"
profile = "mdx-20"
connection = "simulated"
tools = ["T1"]
"""

BYTES = int(os.environ.get("AXISGATE_UPLOAD_BYTES", "250000"))
BYTES_A_SECOND = 10_000
PIECE = 1000
LINE = "PU4000,0;PU0,0;\n"
ENDS_S = 60  # what does not move has ended by then


class SlowWay:
    """To the daemon, for each connection: so many bytes a second, and after `stops_after` none any more. Back from it
    without a limit."""

    def __init__(self, daemon, stops_after=None):
        self._daemon, self._left = daemon, stops_after
        self._listener = socket.create_server(("127.0.0.1", 0))
        self.address = "127.0.0.1:{}".format(self._listener.getsockname()[1])
        self._end, self._ended = os.pipe()
        self._thread = threading.Thread(target=self._serve)
        self._thread.start()

    def _serve(self):
        while self._end not in select.select([self._listener, self._end], [], [])[0]:
            host, port = self._daemon.rsplit(":", 1)
            with self._listener.accept()[0] as client, socket.create_connection((host, int(port))) as daemon:
                with contextlib.suppress(ConnectionError):
                    self._pass_on(client, daemon)

    def _pass_on(self, client, daemon):
        next_piece = time.monotonic()
        while True:
            until = max(0, next_piece - time.monotonic())
            sources = [daemon, self._end] + ([] if until or self._left == 0 else [client])
            ready = select.select(sources, [], [], until or None)[0]
            if self._end in ready:
                return
            for source in ready:
                piece = source.recv(PIECE)
                if not piece:
                    return
                if source is daemon:
                    client.sendall(piece)
                    continue
                daemon.sendall(piece)
                next_piece = time.monotonic() + len(piece) / BYTES_A_SECOND
                if self._left is not None:
                    self._left = max(0, self._left - len(piece))

    def close(self):
        os.close(self._ended)
        self._thread.join()
        os.close(self._end)
        self._listener.close()


class SlowUpload(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="axisgate-slow-upload-")
        self.addCleanup(folder.cleanup)
        self.job = pathlib.Path(folder.name, "long.rml")
        self.job.write_text("^IN;!MC0;\n" + LINE * (BYTES // len(LINE)) + "H;\n", encoding="ascii")
        self.daemon = Daemon(folder.name, CONFIG)
        self.addCleanup(self.daemon.stop)
        self.token = self.daemon.run("token", "create", "anna").stdout.strip()

    def send(self, stops_after=None):
        way = SlowWay(self.daemon.address(), stops_after)
        self.addCleanup(way.close)
        begun = time.monotonic()
        sent = subprocess.run([BIN / "axisctl", "--target", way.address, "--device", "mill", "mill", "send", self.job],
                              env=dict(os.environ, AXISGATE_TOKEN=self.token), capture_output=True, text=True,
                              timeout=2 * BYTES / BYTES_A_SECOND + ENDS_S, check=False)
        return sent, time.monotonic() - begun

    def jobs(self):
        return self.daemon.run("mill", "queue").stdout.count("long.rml")

    def test_a_slow_way_is_no_error(self):
        sent, took_s = self.send()
        self.assertEqual((sent.returncode, sent.stderr), (0, ""), sent)
        self.assertGreater(took_s, 0.9 * BYTES / BYTES_A_SECOND)
        self.assertEqual(self.jobs(), 1)

    def test_a_way_that_stops_moving_ends_and_leaves_no_job(self):
        sent, _ = self.send(stops_after=BYTES // 2)
        self.assertIn("DEADLINE_EXCEEDED", sent.stderr)
        self.assertEqual(self.jobs(), 0)


if __name__ == "__main__":
    unittest.main(verbosity=2)
