#!/usr/bin/env python3
"""The daemon on the network: TLS 1.3 only, callers by certificate or token, certificates replaced while it runs."""

import os
import re
import socket
import ssl
import subprocess
import tempfile
import time
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

[[device]]
name = "stage"
connection = "simulated"
"""


class Network(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="axisgate-network-")
        self.addCleanup(folder.cleanup)
        self.folder = folder.name
        self.issue("lab", "gateway", "anna")
        self.daemon = Daemon(self.folder, CONFIG.replace("FOLDER", self.folder))
        self.addCleanup(self.daemon.stop)
        self.address = re.search(r"gRPC with TLS on (\S+)", self.daemon.log())[1]

    def issue(self, authority, *names):
        subprocess.run([BIN / "axisgate-certificates", self.folder, authority, *names], check=True, timeout=LIMIT_S)

    def path(self, name):
        return os.path.join(self.folder, name)

    def arguments(self, *words, caller=None, ca="lab"):
        known = ["--certificate", self.path(caller + ".crt"), "--key", self.path(caller + ".key")] if caller else []
        return [BIN / "axisctl", "--target", self.address, "--ca", self.path(ca + ".crt"), *known, *words]

    def run_axisctl(self, *words, token=None, **way):
        environment = {name: value for name, value in os.environ.items() if not name.startswith("AXISGATE_")}
        if token:
            environment["AXISGATE_TOKEN"] = token
        return subprocess.run(self.arguments(*words, **way), env=environment, capture_output=True, text=True,
                              timeout=LIMIT_S, check=False)

    def served(self, version=None):
        """The certificate that a new connection sees, whichever authority signed it."""
        context = ssl.SSLContext(ssl.PROTOCOL_TLS_CLIENT)
        context.check_hostname = False
        context.verify_mode = ssl.CERT_NONE
        if version:
            context.maximum_version = version
        host, port = self.address.split(":")
        with socket.create_connection((host, int(port)), timeout=LIMIT_S) as raw:
            with context.wrap_socket(raw) as connection:
                self.assertEqual(connection.version(), "TLSv1.3")
                return connection.getpeercert(binary_form=True)

    def test_callers_by_certificate_and_by_token(self):
        self.assertEqual(self.run_axisctl("whoami", caller="anna").stdout, "cert anna, operator\n")
        self.assertEqual(self.run_axisctl("home", caller="anna").returncode, 0)
        token = self.daemon.run("token", "create", "night-scan").stdout.strip()
        self.assertEqual(self.run_axisctl("whoami", token=token).stdout, "token night-scan, operator\n")
        self.assertEqual(self.run_axisctl("whoami", token=token, caller="anna").stdout, "token night-scan, operator\n")
        nobody = self.run_axisctl("stop")
        self.assertEqual(nobody.returncode, 3, nobody.stdout)
        self.assertRegex(nobody.stderr, "UNAUTHENTICATED: a caller over the network without a certificate needs a token")

    def test_another_authority_is_trusted_on_neither_side(self):
        self.issue("elsewhere", "mallory")
        for way in ({"caller": "mallory"}, {"caller": "anna", "ca": "elsewhere"}):
            refused = self.run_axisctl("whoami", **way)
            self.assertEqual(refused.returncode, 4, refused.stdout)
            self.assertIn("no daemon answers at " + self.address, refused.stderr)

    def test_tls_1_2_is_not_spoken(self):
        self.served()
        with self.assertRaises(OSError):  # what it says differs between versions of Python
            self.served(ssl.TLSVersion.TLSv1_2)

    def test_certificates_are_replaced_without_a_restart(self):
        held = subprocess.Popen(self.arguments("--json", "watch", "--from", "1", caller="anna"), stdout=subprocess.PIPE,
                                text=True)
        self.addCleanup(held.stdout.close)
        self.addCleanup(held.wait)
        self.addCleanup(held.terminate)
        self.assertIn("revision", held.stdout.readline())
        before = self.served()
        self.issue("newlab", "gateway", "bert")
        os.replace(self.path("newlab.crt"), self.path("lab.crt.new"))
        os.replace(self.path("lab.crt.new"), self.path("lab.crt"))
        deadline = time.monotonic() + LIMIT_S
        while self.served() == before or self.run_axisctl("whoami", caller="bert").returncode != 0:
            self.assertLess(time.monotonic(), deadline, "the new certificate is not served")
            time.sleep(0.1)  # between two looks; the deadline above decides
        self.assertEqual(self.run_axisctl("whoami", caller="bert").stdout, "cert bert, operator\n")
        self.assertEqual(self.run_axisctl("whoami", caller="anna").returncode, 4)  # of the authority before
        # The old connection lives on, and tells of what happens now.
        moved = self.run_axisctl("move", "1=1mm", caller="bert")
        self.assertEqual(moved.returncode, 0, moved.stderr)
        while "cert bert" not in held.stdout.readline():
            self.assertIsNone(held.poll())

    def test_the_log_says_at_the_start_that_the_certificate_expires(self):
        self.assertNotIn("expires at", self.daemon.log(), "that of the gateway is good for 90 days")
        self.daemon.stop()
        soon = CONFIG.replace("FOLDER/gateway", "FOLDER/lab").replace("FOLDER", self.folder)  # good for a day
        self.daemon = Daemon(self.folder, soon)
        self.addCleanup(self.daemon.stop)
        said = re.findall(rf"the certificate {re.escape(self.path('lab.crt'))} expires at .* UTC; ", self.daemon.log())
        self.assertEqual(len(said), 1, self.daemon.log())

    def test_a_daemon_open_to_the_network_without_tls_does_not_start(self):
        path = self.path("open.toml")
        with open(path, "w", encoding="utf-8") as file:
            file.write('listen = "0.0.0.0:0"\n\n[[device]]\nname = "stage"\nconnection = "simulated"\n')
        refused = subprocess.run([BIN / "axisgated", "--config", path], capture_output=True, text=True, timeout=LIMIT_S,
                                 check=False)
        self.assertEqual(refused.returncode, 2)
        self.assertRegex(refused.stderr, r"open\.toml:1: listen: \"0\.0\.0\.0:0\" would offer gRPC to the network.* "
                                         r"table \[network\], with TLS and callers who are known")


if __name__ == "__main__":
    unittest.main()
