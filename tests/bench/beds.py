"""What is measured: simulators, daemons, the smallest gateway, and the program that makes one measurement."""

import collections
import contextlib
import dataclasses
import functools
import json
import pathlib
import re
import shutil
import socket
import subprocess
import sys
import tempfile
import threading
import time

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent / "integration"))

import machine  # noqa: E402
from programs import BIN, LIMIT_S, Daemon, Lines  # noqa: E402

MEASUREMENT_LIMIT_S = 300
CONFIG = """
listen = "127.0.0.1:0"
metrics = "127.0.0.1:0"
socket = "{socket}"
NETWORK
[[device]]
name = "stage"
connection = "serial"
path = "TTY"
baud = BAUD
SETTINGS
"""
NETWORK = """
[network]
listen = "127.0.0.1:0"
certificate = "FOLDER/gateway.crt"
key = "FOLDER/gateway.key"
client_ca = "FOLDER/lab.crt"
"""
# The text of the page is made again when the last is as old (server/metrics/page_limits.h), and a little.
PAGE_AGE_S = 0.2
# The daemon computes times from it. The simulator then does not pace the line at all.
UNPACED_BAUD = 4_000_000
SER2NET = """%YAML 1.1
---
connection: &bench
  accepter: tcp,127.0.0.1,PORT
  connector: serialdev(nouucplock=true),TTY,115200n81,local
  options:
    max-connections: 8
"""


class NotMeasured(Exception):
    """Why a figure cannot be had here."""


@dataclasses.dataclass(frozen=True)
class Build:
    name: str
    folder: pathlib.Path  # with axisgated


@dataclasses.dataclass
class Served:
    """A server: its process, and how clients reach it."""

    name: str
    pid: int
    targets: dict  # what axisgate-bench is told, by transport
    daemon: Daemon | None = None

    def sample(self):
        return machine.sample(self.pid)

    def metric(self, name, label):
        """The values of a metric, added up by one of its labels."""
        values = collections.Counter()
        found = re.findall(rf'^{name}\{{.*\b{label}="([^"]*)".*\}} (\S+)$', self.daemon.metrics_page(), re.MULTILINE)
        for value_of_label, value in found:
            values[value_of_label] += float(value)
        return values

    def exchanges(self):
        """The time, and how many exchanges there were so far, by command."""
        return time.monotonic(), self.metric("axisgate_exchanges_total", "command")

    def exchanges_by_now(self):
        """Likewise, to the last one."""
        time.sleep(PAGE_AGE_S)
        return self.exchanges()[1]


@dataclasses.dataclass
class Bed:
    direct: str  # a tty for a client without a gateway
    minimal: Served | None
    gateways: list


@dataclasses.dataclass
class Measured:
    figures: dict
    before: object  # what `look` returned when it began,
    after: object  # and when it ended

    @functools.cached_property
    def cost(self):
        """Where `look` samples a process."""
        return machine.cost(self.before, self.after)


@contextlib.contextmanager
def bed(builds, baud=0, settings="", minimal=False, certificates=False, events_per_second=50):
    """Each of those that are compared has a simulator of its own."""
    with contextlib.ExitStack() as stack:
        folder = pathlib.Path(stack.enter_context(tempfile.TemporaryDirectory(prefix="axisgate-bench-")))
        if certificates:
            subprocess.run([BIN / "axisgate-certificates", folder, "lab", "gateway", "anna"], check=True)
        made = Bed(simulator(stack, folder / "direct.tty", baud), None, [])
        if minimal:
            made.minimal = _minimal(stack, folder, certificates, events_per_second)
        for build in builds:
            made.gateways.append(_gateway(stack, build, folder, baud, settings, certificates))
        yield made


def simulator(stack, tty, baud=0):
    program = Lines([BIN / "shrc203-sim", "--pty", tty, "--baud", str(baud)])
    stack.callback(program.kill)
    program.until("simulator on")
    return str(tty)


def _minimal(stack, folder, certificates, events_per_second):
    tty, path = simulator(stack, folder / "minimal.tty"), folder / "minimal.sock"
    program = Lines([BIN / "axisgate-bench-server", "--socket", path, "--tty", tty, "--events-per-second",
                     str(events_per_second), *(["--certificates", folder] if certificates else [])])
    stack.callback(program.kill)
    tcp, tls = re.search(r"tcp (\S+) tls (\S+)", program.until("serves")).groups()
    return Served("minimal", program.process.pid, _targets(folder, path, tcp, tls))


def _gateway(stack, build, folder, baud, settings, certificates):
    own = folder / build.name
    own.mkdir()
    config = CONFIG.replace("NETWORK", NETWORK.replace("FOLDER", str(folder)) if certificates else "")
    config = config.replace("TTY", simulator(stack, own / "tty", baud)).replace("BAUD", str(baud or UNPACED_BAUD))
    daemon = Daemon(str(own), config.replace("SETTINGS", settings), program=str(build.folder / "axisgated"))
    stack.callback(daemon.stop)
    tls = re.search(r"gRPC with TLS on (\S+)", daemon.log())
    return Served(build.name, daemon.pid, _targets(folder, daemon.socket, daemon.address(), tls and tls[1]), daemon)


def _targets(folder, path, tcp, tls):
    return {"Unix": ("--target", f"unix:{path}"), "TCP": ("--target", tcp),
            "TLS": ("--target", tls, "--certificates", str(folder))}


@contextlib.contextmanager
def serial_sharer():
    """ser2net before a simulator: the address of a raw port that all its clients share."""
    program = shutil.which("ser2net") or shutil.which("ser2net", path="/usr/sbin")
    if not program:
        raise NotMeasured("ser2net is missing (Debian package ser2net)")
    with contextlib.ExitStack() as stack:
        folder = pathlib.Path(stack.enter_context(tempfile.TemporaryDirectory(prefix="axisgate-bench-")))
        with socket.create_server(("127.0.0.1", 0)) as free:
            port = free.getsockname()[1]
        config = SER2NET.replace("PORT", str(port)).replace("TTY", simulator(stack, folder / "tty"))
        path = folder / "ser2net.yaml"
        path.write_text(config, encoding="ascii")
        process = subprocess.Popen([program, "-n", "-c", path], stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL,
                                   stderr=subprocess.DEVNULL)
        stack.callback(process.wait)
        stack.callback(process.kill)
        _await_port(port)
        yield f"127.0.0.1:{port}"


def _await_port(port):
    deadline = time.monotonic() + LIMIT_S
    while True:
        try:
            return socket.create_connection(("127.0.0.1", port), timeout=1).close()
        except OSError as error:
            if time.monotonic() > deadline:
                raise NotMeasured(f"ser2net does not listen: {error}") from error
        time.sleep(0.05)  # between two looks; the deadline above decides


def measure(*words, look=lambda: None):
    """One measurement by axisgate-bench; `look` is called when it begins and when it ends."""
    process = subprocess.Popen([BIN / "axisgate-bench", *words], stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                               stderr=subprocess.PIPE, text=True)
    limit = threading.Timer(MEASUREMENT_LIMIT_S, process.kill)
    limit.start()
    measured = Measured({}, None, None)
    with process:
        try:
            for line in process.stdout:
                if line == "begun\n":
                    measured.before = look()
                elif line == "ended\n":
                    measured.after = look()
                else:
                    measured.figures = json.loads(line)
            errors, code = process.stderr.read(), process.wait()
        finally:
            limit.cancel()
            process.kill()
    if code != 0:
        raise NotMeasured(f"{words[0]} ended with {code}: {errors.strip()}")
    return measured
