#!/usr/bin/env python3
"""What is refused is on record: in the log with who, from where, what and why, and on the metrics page by reason."""

import os
import pathlib
import re
import socket
import ssl
import subprocess
import sys
import tempfile
import time
import unittest

import hpack

from programs import BIN, LIMIT_S, Daemon

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "attack"))
import http2  # noqa: E402, of the folder above

CONFIG = """
listen = "127.0.0.1:0"
metrics = "127.0.0.1:0"
socket = "{socket}"

[access]
admin_commands = ["BEC:"]

[limits]
streams = STREAMS

[network]
listen = "127.0.0.1:0"
certificate = "FOLDER/gateway.crt"
key = "FOLDER/gateway.key"
client_ca = "FOLDER/lab.crt"

[[device]]
name = "stage"
connection = "simulated"
"""

STREAMS = 4
FLOOD = 20
LINES = 5  # of a source in 10 s


class Refusals(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="axisgate-refusals-")
        self.addCleanup(folder.cleanup)
        self.folder = folder.name
        subprocess.run([BIN / "axisgate-certificates", self.folder, "lab", "gateway"], check=True, timeout=LIMIT_S)
        self.daemon = Daemon(self.folder, CONFIG.replace("FOLDER", self.folder).replace("STREAMS", str(STREAMS)))
        self.addCleanup(self.daemon.stop)
        self.uid = f"uid {os.geteuid()}"

    def run_axisctl(self, *words, token=None, target=None):
        environment = {name: value for name, value in os.environ.items() if not name.startswith("AXISGATE_")}
        if token:
            environment["AXISGATE_TOKEN"] = token
        command = self.daemon.command(*words)
        if target:
            command[command.index("--target") + 1] = target
        return subprocess.run(command, env=environment, capture_output=True, text=True, timeout=LIMIT_S, check=False)

    def count(self, family, **label):
        ((name, value),) = label.items()
        return float(re.search(rf'(?m)^{family}{{{name}="{value}"}} (\S+)$', self.daemon.metrics_page())[1])

    def assert_counted(self, number, family, **label):
        """The page is up to 100 ms old."""
        deadline = time.monotonic() + LIMIT_S
        while self.count(family, **label) != number and time.monotonic() < deadline:
            time.sleep(0.05)  # between two looks; the deadline above decides
        self.assertEqual(self.count(family, **label), number)

    def assert_refusals(self, number, reason):
        self.assert_counted(number, "axisgate_refusals_total", reason=reason)

    def assert_closed(self, number, why):
        self.assert_counted(number, "axisgate_connections_closed_total", why=why)

    def refused_lines(self):
        return re.findall(r"(?m)^\S+ \S+ warning (refused .*)$", self.daemon.log())

    def make(self, name, *options):
        made = self.daemon.run("token", "create", name, *options)
        self.assertEqual(made.returncode, 0, made.stderr)
        return made.stdout.strip()

    def test_wrong_and_revoked_tokens(self):
        self.assert_refusals(0, "UNAUTHENTICATED")
        token = self.make("night-scan")
        wrong = token[:-4] + "0" * 4
        self.assertEqual(self.run_axisctl("status", token=wrong).returncode, 3)
        self.daemon.run("token", "revoke", "night-scan")
        self.assertEqual(self.run_axisctl("move", "1=1um", token=token, target=self.daemon.address()).returncode, 3)
        by_socket, by_tcp = self.refused_lines()
        self.assertRegex(by_socket, rf"\Arefused /axisgate\.v1\.\S+ of unix \S+ \({self.uid}\): UNAUTHENTICATED: that "
                                    r"token is not one of this daemon's\Z")
        self.assertRegex(by_tcp, r"\Arefused /axisgate\.v1\.\S+ of tcp 127\.0\.0\.1:\d+ \(uid \d+ over TCP\): "
                                 r'UNAUTHENTICATED: the token "night-scan" was revoked\Z')
        self.assert_refusals(2, "UNAUTHENTICATED")
        for secret in (token, wrong, token.rsplit(".", 1)[1][:16]):
            self.assertNotIn(secret, self.daemon.log())

    def test_a_role_that_may_not(self):
        token = self.make("reads", "--role", "observer")
        self.assertEqual(self.run_axisctl("move", "1=1um", token=token).returncode, 3)
        operator = self.make("works")
        self.assertEqual(self.run_axisctl("exec", "BEC:1", token=operator).returncode, 3)
        at_the_front, at_the_command = self.refused_lines()
        self.assertRegex(at_the_front, rf"\Arefused /axisgate\.v1\.StageService/Move of token reads \({self.uid}\): "
                                       r"NOT_ALLOWED: .* asks for the role operator, and token reads is observer\Z")
        self.assertRegex(at_the_command, rf"CommandService/Execute of token works \({self.uid}\): NOT_ALLOWED: only an")
        self.assert_refusals(2, "NOT_ALLOWED")
        self.assertNotIn(token.rsplit(".", 1)[1], self.daemon.log())

    def let_go(self, holder):
        holder.process.terminate()  # passed on to its command
        holder.end()

    def test_leases(self):
        holder = self.daemon.start("lease", "run", "--", "sh", "-c", "echo held $AXISGATE_LEASE; exec sleep 60")
        self.addCleanup(self.let_go, holder)
        secret = holder.until("held").split()[1]
        self.assertNotEqual(self.run_axisctl("move", "1=1um", token=self.make("works")).returncode, 0)
        guess = "42" * 24
        environment = dict(os.environ, AXISGATE_LEASE=guess)
        guessed = subprocess.run(self.daemon.command("move", "1=1um"), env=environment, capture_output=True, text=True,
                                 timeout=LIMIT_S, check=False)
        self.assertIn("LEASE_LOST", guessed.stderr)
        held, lost = self.refused_lines()
        self.assertRegex(held, rf"StageService/Move of token works \({self.uid}\): LEASE_HELD: ")
        self.assertRegex(lost, rf"StageService/Move of unix \S+ \({self.uid}\): LEASE_LOST: ")
        self.assert_refusals(1, "LEASE_HELD")
        self.assert_refusals(1, "LEASE_LOST")
        for token in (guess, secret):
            self.assertNotIn(token, self.daemon.log())

    def test_too_many_streams(self):
        for _ in range(STREAMS):
            watching = self.daemon.start("--json", "watch", "--from", "1")
            self.addCleanup(watching.kill)
            watching.next()
        self.assertNotEqual(self.daemon.run("--json", "watch", "--from", "1").returncode, 0)
        self.assertRegex(self.refused_lines()[0], rf"EventService/Watch of unix \S+ \({self.uid}\): QUEUE_FULL: ")
        self.assert_refusals(len(self.refused_lines()), "QUEUE_FULL")

    def test_a_flood_is_counted_and_not_written(self):
        with_token = self.make("reads", "--role", "observer")
        link = http2.Door("unix", self.daemon.socket).link()
        self.addCleanup(link.close)
        path = "/axisgate.v1.StageService/Move"
        data = http2.PREFACE + http2.frame(http2.SETTINGS, 0, 0)
        for number in range(FLOOD):
            headers = http2.request_headers(path, token=with_token)
            data += http2.frame(http2.HEADERS, http2.END_HEADERS | http2.END_STREAM, 2 * number + 1, headers)
        self.assertTrue(link.send(data, link.opened + LIMIT_S))
        self.daemon.wait_for_log(r"left out \d+ more refusals")
        self.assert_refusals(FLOOD, "NOT_ALLOWED")
        self.assertEqual(len(self.refused_lines()), LINES)
        self.assertIn(f"left out {FLOOD - LINES} more refusals of {self.uid} in the last 10 s\n", self.daemon.log())

    def test_what_a_client_writes_is_escaped_and_cut(self):
        token = self.make("works")
        link = http2.Door("unix", self.daemon.socket).link()
        self.addCleanup(link.close)
        calls = b"".join(
            http2.frame(http2.HEADERS, http2.END_HEADERS | http2.END_STREAM, stream,
                        http2.request_headers(path, token=token))
            for stream, path in ((1, "/\x1b]0;x\x07"), (3, "/%1b[31m" + 500 * "y")))
        until = link.opened + LIMIT_S
        link.send(http2.PREFACE + http2.frame(http2.SETTINGS, 0, 0) + calls, until)
        answers = {}
        while answers.keys() != {1, 3}:
            frames = link.next(until)
            self.assertTrue(frames, answers)
            answers |= {stream: (kind, payload) for kind, _, stream, payload in frames if stream and stream not in answers}
        self.assertEqual(answers[1][0], http2.RST_STREAM, "HTTP/2 allows no such path")
        headers = dict(hpack.Decoder().decode(answers[3][1]))
        self.assertEqual(headers["grpc-status"], "12")
        self.assertRegex(headers["grpc-message"], r"\A/%251b\[31my{80,100}\.\.\. is no method of this daemon")
        self.assertTrue(self.daemon.log().replace("\n", "").isprintable())

    def test_connections_closed_for_a_cause(self):
        with socket.create_connection(self.daemon.address().rsplit(":", 1), timeout=LIMIT_S) as raw:
            raw.sendall(b"GET / HTTP/1.1\r\n\r\n")
            while raw.recv(4096):
                pass
        self.daemon.wait_for_log(r"warning closed a connection of tcp 127\.0\.0\.1:\d+ \(uid \d+ over TCP\): this is not HTTP/2")
        self.assert_closed(1, "protocol_error")
        network = re.search(r"gRPC with TLS on (\S+)", self.daemon.log())[1]
        context = ssl.SSLContext(ssl.PROTOCOL_TLS_CLIENT)
        context.check_hostname = False
        context.verify_mode = ssl.CERT_NONE
        context.maximum_version = ssl.TLSVersion.TLSv1_2
        with socket.create_connection(network.rsplit(":", 1), timeout=LIMIT_S) as raw:
            with self.assertRaises(OSError):
                context.wrap_socket(raw)
        self.daemon.wait_for_log(r"warning closed a connection of a caller over the network without a certificate "
                                 r"\(uid \d+ over TCP\): the TLS handshake failed: ")
        self.assert_closed(1, "handshake_failed")
        for why in ("no_call", "frame_unfinished", "over_budget"):
            self.assert_closed(0, why)

    def test_a_certificate_of_another_authority(self):
        subprocess.run([BIN / "axisgate-certificates", self.folder, "elsewhere", "mallory"], check=True, timeout=LIMIT_S)
        network = re.search(r"gRPC with TLS on (\S+)", self.daemon.log())[1]
        path = os.path.join(self.folder, "%s")
        subprocess.run([BIN / "axisctl", "--target", network, "--ca", path % "lab.crt", "--certificate",
                        path % "mallory.crt", "--key", path % "mallory.key", "whoami"], capture_output=True,
                       timeout=LIMIT_S, check=False)
        self.daemon.wait_for_log(r"the TLS handshake failed: certificate verify failed")


if __name__ == "__main__":
    unittest.main(verbosity=2)
