#!/usr/bin/env python3
"""The daemon's connections: who is at the other end, and what happens when there are no descriptors for more."""

import contextlib
import json
import os
import re
import resource
import shutil
import socket
import subprocess
import tempfile
import time
import unittest

from programs import LIMIT_S, Daemon

CONFIG = """
listen = "127.0.0.1:0"
metrics = "127.0.0.1:0"
socket = "{socket}"

[[device]]
name = "stage"
connection = "simulated"
"""

# So few that connections exhaust them before as many are open as the daemon allows.
DESCRIPTORS = 72

# What every HTTP/2 client begins with, and an empty SETTINGS frame.
HTTP2_BEGIN = b"PRI * HTTP/2.0\r\n\r\nSM\r\n\r\n" + bytes([0, 0, 0, 4, 0, 0, 0, 0, 0])


def literal(name, value):
    """A header that is not compressed (RFC 7541, 6.2.2)."""
    return bytes([0, len(name)]) + name + bytes([len(value)]) + value


def open_call(path):
    """A call whose request is still to come, so that its connection has a way to gRPC."""
    block = b"".join(literal(name, value) for name, value in (
        (b":method", b"POST"), (b":scheme", b"http"), (b":path", path), (b":authority", b"x"),
        (b"te", b"trailers"), (b"content-type", b"application/grpc")))
    return len(block).to_bytes(3, "big") + bytes([1, 4, 0, 0, 0, 1]) + block


class WithDaemon(unittest.TestCase):
    def start(self, **process):
        folder = tempfile.TemporaryDirectory(prefix="axisgate-connections-")
        self.addCleanup(folder.cleanup)
        os.chmod(folder.name, 0o755)  # other users may come in
        self.folder = folder.name
        self.daemon = Daemon(folder.name, CONFIG, **process)
        self.addCleanup(self.daemon.stop)

    def wait_until(self, condition, what):
        deadline = time.monotonic() + LIMIT_S
        while not condition():
            if time.monotonic() > deadline:
                self.fail(f"not within {LIMIT_S} s: {what}; the daemon has {self.descriptors()} descriptors")
            time.sleep(0.05)  # between two looks; the deadline above decides

    def idle_descriptors(self):
        self.wait_until(lambda: self.open_connections() == 0, "the connections of past calls are closed")
        return self.descriptors()

    def open_connections(self):
        """On the socket, at the daemon's end."""
        with open("/proc/net/unix", encoding="ascii") as file:
            sockets = [line.split() for line in file]
        return sum(1 for fields in sockets if fields[-1] == self.daemon.socket and fields[5] == "03")

    def descriptors(self):
        return len(os.listdir(f"/proc/{self.daemon.pid}/fd"))

    def metric(self, series):
        return float(re.search(rf"(?m)^{re.escape(series)} (\S+)$", self.daemon.metrics_page())[1])

    def log(self):
        with open(os.path.join(self.folder, "axisgated.log"), encoding="utf-8") as file:
            return file.read()

    def is_served(self):
        return self.daemon.run("status").returncode == 0

    def assert_refused(self):
        # A call of gRPC's. The front answers `status` itself, for which one descriptor is enough.
        answer = self.daemon.run("whoami")
        self.assertEqual(answer.returncode, 3, answer.stdout + answer.stderr)
        self.assertRegex(answer.stderr, r"\Aaxisctl: QUEUE_FULL: .*serves nothing but a stop.*limit of open files")

    def assert_stop_gets_through(self, move):
        """Ends the running `move`, too."""
        answer = self.daemon.run("stop")
        self.assertEqual((answer.returncode, answer.stderr), (0, ""))
        self.assertRegex(answer.stdout, r"(?m)^axis 1: replied OK, stationary at ")
        self.assertEqual(move.end(), 1)
        self.assertRegex(move.errors, r"\Aaxisctl: STOPPED: ")

    def start_move(self):
        # Of more than a minute.
        move = self.daemon.start("move", "1=9mm", "--speed", "0.1mm/s")
        self.addCleanup(lambda: move.process.poll() is None and move.kill())
        move.until("RUNNING")
        return move

    @contextlib.contextmanager
    def connections(self, count, more=b""):
        with contextlib.ExitStack() as stack:
            for _ in range(count):
                client = stack.enter_context(socket.socket(socket.AF_UNIX))
                client.settimeout(LIMIT_S)
                client.connect(self.daemon.socket)
                client.sendall(HTTP2_BEGIN + more)
            yield


class Hazard55DescriptorsRunOutAndComeBack(WithDaemon):
    def test_connections_take_all_descriptors(self):
        self.start(preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_NOFILE, (DESCRIPTORS, DESCRIPTORS)))
        before = self.idle_descriptors()
        for round_ in range(3):
            with self.subTest(round=round_):
                move = self.start_move()
                exhausted = self.metric("axisgate_descriptors_exhausted_total")
                with self.connections(2 * DESCRIPTORS, open_call(b"/axisgate.v1.AccessService/GetCaller")):
                    self.wait_until(lambda: self.metric("axisgate_descriptors_exhausted_total") > exhausted,
                                    "every descriptor taken")
                    self.assert_refused()
                    self.assert_stop_gets_through(move)
                self.wait_until(self.is_served, "served again")
                self.wait_until(lambda: self.descriptors() == before, f"{before} descriptors again")
        self.assertIn("no descriptors are free (Too many open files)", self.log())
        self.assertGreater(self.metric("axisgate_connections_refused_total"), 0)

    def test_something_else_takes_all_descriptors(self):
        self.start()
        before = self.idle_descriptors()
        self.assertTrue(self.is_served())
        move = self.start_move()
        limits = resource.prlimit(self.daemon.pid, resource.RLIMIT_NOFILE)
        resource.prlimit(self.daemon.pid, resource.RLIMIT_NOFILE, (self.lowest_free(), limits[1]))
        self.assert_refused()
        self.assert_stop_gets_through(move)
        resource.prlimit(self.daemon.pid, resource.RLIMIT_NOFILE, limits)
        self.wait_until(self.is_served, "served again")
        self.wait_until(lambda: self.descriptors() == before, f"{before} descriptors again")

    def lowest_free(self):
        taken = {int(number) for number in os.listdir(f"/proc/{self.daemon.pid}/fd")}
        return next(number for number in range(len(taken) + 1) if number not in taken)

    def test_connections_reach_what_the_limit_allows(self):
        self.start(preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_NOFILE, (400, 400)))
        before = self.idle_descriptors()
        move = self.start_move()
        with self.connections(400 // 2 // 3):
            self.wait_until(lambda: "as many connections are open as are allowed: 66" in self.log(), "the limit")
            self.assertEqual(self.metric('axisgate_connections{kind="open"}'), 66)
            self.assert_refused()
            self.assert_stop_gets_through(move)
        self.wait_until(self.is_served, "served again")
        self.wait_until(lambda: self.descriptors() == before, f"{before} descriptors again")
        self.assertNotIn("no descriptors", self.log())


class Callers(WithDaemon):
    def who(self, *prefix, target=None):
        command = self.daemon.command("--json", "move", "1=1um")
        if target:
            command[command.index("--target") + 1] = target
        answer = subprocess.run([*prefix, *command], capture_output=True, text=True, timeout=2 * LIMIT_S, check=False)
        self.assertEqual((answer.returncode, answer.stderr), (0, ""))
        return json.loads(answer.stdout.splitlines()[-1])["motion"]["caller"]["name"]

    def tcp_target(self):
        return next(line.split()[5] for line in self.log().splitlines() if "gRPC on" in line)

    def test_a_tcp_caller_is_its_address(self):
        self.start()
        self.assertRegex(self.who(target=self.tcp_target()), r"\Atcp 127\.0\.0\.1:\d+\Z")

    @unittest.skipUnless(os.geteuid() == 0 and shutil.which("setpriv"), "only root can be two users")
    def test_users_of_the_socket_are_told_apart(self):
        self.start()
        self.assertEqual(self.who(), "unix root")
        self.assertEqual(self.who("setpriv", "--reuid", "nobody", "--clear-groups"), "unix nobody")
        self.assertEqual(self.who("setpriv", "--reuid", "4000000000", "--clear-groups"), "unix uid 4000000000")
        self.assertEqual(self.who(), "unix root")


if __name__ == "__main__":
    unittest.main(verbosity=2)
