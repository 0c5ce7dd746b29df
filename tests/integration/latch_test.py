#!/usr/bin/env python3
"""Whom a stop holds back: each pair of callers over the Unix socket, loopback and TLS, with a name and without."""

import itertools
import os
import re
import subprocess
import tempfile
import unittest

from programs import BIN, LIMIT_S, Daemon

CONFIG = """
listen = "127.0.0.1:0"
metrics = "127.0.0.1:0"
socket = "{socket}"

[network]
listen = "127.0.0.1:0"
certificate = "FOLDER/gateway.crt"
key = "FOLDER/gateway.key"
client_ca = "FOLDER/lab.crt"
"""
# One for each pair: a stop also holds back all who moved the axis in the last 10 s.
DEVICES = [f"stage{number}" for number in range(25)]
ANONYMOUS = "anonymous over loopback"
REFUSED = 3


class Latches(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="axisgate-latch-")
        self.addCleanup(folder.cleanup)
        subprocess.run([BIN / "axisgate-certificates", folder.name, "lab", "gateway", "anna"], check=True,
                       timeout=LIMIT_S)
        self.daemon = Daemon(folder.name, CONFIG.replace("FOLDER", folder.name) + "".join(
            f'[[device]]\nname = "{name}"\nconnection = "simulated"\n' for name in DEVICES))
        self.addCleanup(self.daemon.stop)
        network = re.search(r"gRPC with TLS on (\S+)", self.daemon.log())[1]
        tls = ["--target", network, "--ca", f"{folder.name}/lab.crt"]
        certificate = ["--certificate", f"{folder.name}/anna.crt", "--key", f"{folder.name}/anna.key"]
        loopback = ["--target", self.daemon.address()]
        self.callers = {
            "unix": (["--target", f"unix:{self.daemon.socket}"], None),
            ANONYMOUS: (loopback, None),
            "a token over loopback": (loopback, self.token("scan")),
            "a certificate over TLS": (tls + certificate, None),
            "a token over TLS": (tls, self.token("far")),
        }

    def token(self, name):
        return self.daemon.run("token", "create", name).stdout.strip()

    def run_as(self, caller, *words):
        arguments, token = self.callers[caller]
        environment = {name: value for name, value in os.environ.items() if not name.startswith("AXISGATE_")}
        if token:
            environment["AXISGATE_TOKEN"] = token
        return subprocess.run([BIN / "axisctl", *arguments, *words], env=environment, capture_output=True, text=True,
                              timeout=LIMIT_S, check=False)

    def moves(self, caller, device):
        moved = self.run_as(caller, "--device", device, "move", "1=+1um", "--relative")
        if moved.returncode == REFUSED:
            self.assertIn("STOPPED_BY: ", moved.stderr)
            return False
        self.assertEqual(moved.returncode, 0, moved.stderr)
        return True

    def held_back(self, stopper, mover, device):
        """Who of the mover, the anonymous and a third may not move any more; rearms them all."""
        self.assertTrue(self.moves(mover, device), f"{mover} is held back already")
        self.assertEqual(self.run_as(stopper, "--device", device, "stop", "1").returncode, 0)
        third = next(caller for caller in self.callers if caller not in (stopper, mover, ANONYMOUS))
        refused = {caller for caller in (mover, ANONYMOUS, third) if not self.moves(caller, device)}
        for caller in sorted(refused, key=lambda one: one != ANONYMOUS):  # who is named rearms for the anonymous, too
            rearmed = self.run_as(caller, "--device", device, "rearm")
            self.assertRegex(rearmed.stdout, r"\Areleased: the stop of axis 1 by .*\naxis 1 may move again\n\Z")
        return refused

    def test_each_pair(self):
        pairs = itertools.product(self.callers, repeat=2)
        for device, (stopper, mover) in zip(DEVICES, pairs):
            with self.subTest(stopped=stopper, moved=mover):
                own = stopper == mover and mover != ANONYMOUS
                self.assertEqual(self.held_back(stopper, mover, device), set() if own else {mover, ANONYMOUS})


if __name__ == "__main__":
    unittest.main(verbosity=2)
