"""The daemon, a simulated stage and mill, and what happens to them: what the scenario calls the world.

The stage is a simulator at the end of a cable that can be pulled, so that what its controller was sent is counted where
no client and no daemon can be wrong about it.
"""

import contextlib
import json
import os
import pathlib
import re
import shutil
import socket
import subprocess
import sys
import tempfile
import time

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parents[1]
sys.path.insert(0, str(ROOT / "tests" / "integration"))

from cables import Cable, Unit  # noqa: E402
from programs import BIN, LIMIT_S, Daemon  # noqa: E402

from relay import Relay  # noqa: E402

CONFIG = """
listen = "127.0.0.1:FIRST_PORT"
metrics = "127.0.0.1:0"
socket = "{socket}"

[network]
listen = "127.0.0.1:SECOND_PORT"
certificate = "FOLDER/gateway.crt"
key = "FOLDER/gateway.key"
client_ca = "FOLDER/lab.crt"

[access]
local = "operator"

[[device]]
name = "stage"
connection = "serial"
path = "CABLE"
baud = 38400

[[device.axis]]
number = 1
name = "x"
unit = "mm"
travel_minimum = "-2mm"
travel_maximum = "20mm"

[[device.axis]]
number = 2
name = "y"
unit = "um"

[[device]]
name = "mill"
kind = "rml1"
profile = "PROFILE"
connection = "simulated"
tools = ["T1"]
"""
ANSWER_DELAY_S = 0.5  # much longer than the time from a start on the line to the cut that it triggers
STARTS = re.compile(r"(?:G|H|J|HRT|Z|ZRT):")  # lines that start motion (manual 60) and later)


class World:
    """One for each run of the scenario over one transport; end() ends everything that it has begun.

    `through` returns a proxy in front of a daemon's socket, for the transport "unix". None: there is no proxy.
    """

    def __init__(self, transport, through=None):
        self._transport = transport
        self._through = through
        with contextlib.ExitStack() as begun:
            self._folder = begun.enter_context(tempfile.TemporaryDirectory(prefix="axisgate-conform-"))
            self._begin(begun)
            self._begun = begun.pop_all()

    def _begin(self, begun):
        subprocess.run([BIN / "axisgate-certificates", self._folder, "lab", "gateway", "anna"], check=True, timeout=LIMIT_S)
        self._unit = Unit(self._path("unit"), "2106001001", "--control", self._path("control"))
        begun.callback(self._unit.end)
        self._cable = Cable(self._path("cable"))
        self._cable.plug(self._unit)
        begun.callback(self._cable.unplug)
        first, second = _free_ports()  # a daemon that is started again has the same ones
        self._config = CONFIG
        for name, value in (("FOLDER", self._folder), ("CABLE", self._cable.path), ("FIRST_PORT", first),
                            ("SECOND_PORT", second), ("PROFILE", ROOT / "deploy" / "mills" / "mdx-20.toml")):
            self._config = self._config.replace(name, str(value))
        self.daemon = Daemon(self._folder, self._config)
        begun.callback(lambda: self.daemon.stop())
        self._front = self.daemon.socket
        if self._through is not None:
            self._front = begun.enter_context(self._through(self.daemon.socket)).socket
        self._relay = Relay(*self._ends())
        begun.callback(self._relay.end)

    def _path(self, name):
        return os.path.join(self._folder, name)

    def _ends(self):
        if self._transport == "unix":
            return ("unix", self._path("relay.sock")), ("unix", self._front)
        if self._transport == "loopback":
            return ("tcp", 0), ("tcp", int(self.daemon.address().rsplit(":", 1)[1]))
        return ("tcp", 0), ("tcp", int(re.findall(r"gRPC with TLS on \S+:(\d+)", self.daemon.log())[-1]))

    def way_in(self):
        """How the client reaches the daemon: through the relay, as who the transport makes it."""
        if self._transport == "unix":
            return {"target": f"unix:{self._path('relay.sock')}"}
        if self._transport == "loopback":
            return {"target": f"127.0.0.1:{self._relay.port}", "token": self.new_token("operator")}
        return {"target": f"localhost:{self._relay.port}", "ca": self._path("lab.crt"),
                "certificate": self._path("anna.crt"), "key": self._path("anna.key")}

    def new_token(self, role):
        self._tokens = getattr(self, "_tokens", 0) + 1
        made = self.daemon.run("token", "create", f"conform-{self._tokens}", "--role", role)
        return made.stdout.strip()

    # The acts of the scenario.

    def axisctl(self, *words):
        done = self.daemon.run(*words)
        if done.returncode != 0:
            raise AssertionError(f"axisctl {' '.join(words)}: {done.stderr}")

    def stop(self):
        """Stops all axes, as a caller of another name."""
        command = self.daemon.command("stop")
        subprocess.run(command, env=dict(os.environ, AXISGATE_TOKEN=self.new_token("operator")), capture_output=True,
                       check=True, timeout=LIMIT_S)

    def begin_lease(self):
        self._lease = self.daemon.start("lease", "run", "--axes", "x", "--purpose", "a scan by another", "--",
                                        "sh", "-c", "echo held; tail --pid=$PPID -f /dev/null")
        self._lease.until("held")

    def end_lease(self):
        self._lease.process.terminate()
        self._lease.end()

    def limit(self):
        self._at_the_device("limit 1 cw on")

    def limit_off(self):
        self._at_the_device("limit 1 cw off")
        self.axisctl("clear", "1")

    def _at_the_device(self, command):
        with socket.socket(socket.AF_UNIX) as person:
            person.settimeout(LIMIT_S)
            person.connect(self._path("control"))
            person.sendall(command.encode() + b"\n")
            reply = person.makefile(encoding="ascii").readline()
        if not reply.startswith("ok"):
            raise AssertionError(f"the simulator's {command}: {reply}")

    def kill_and_start(self):
        self.daemon.kill()
        self._start_again()

    def forget_and_start(self):
        """Ends the daemon, deletes its journal, and starts it again. Its tokens are deleted, too."""
        self.daemon.kill()
        shutil.rmtree(self._path("state"))
        self._start_again()

    def _start_again(self):
        self.daemon.stop()
        self.daemon = Daemon(self._folder, self._config)

    def unplug(self):
        self._cable.unplug()

    def plug(self):
        self._cable.plug(self._unit)
        self._until(lambda: self._stage()["link"] == "LINK_STATE_UP", "the line is up")

    def delay(self):
        self._relay.delay(ANSWER_DELAY_S)

    def cut(self):
        self._relay.cut()

    def cut_off(self):
        self._relay.cut(refuses=True)

    def restore(self):
        self._relay.restore()

    def until_stationary(self):
        self._until(lambda: not any(axis["busy"] for axis in self._stage()["axes"]), "the axes are stationary")

    def _stage(self):
        return json.loads(self.daemon.run("--json", "status").stdout)

    # Observations.

    def starts(self):
        """The number of lines so far that started motion."""
        return sum(bool(STARTS.match(line)) for _, line in self._unit.told)

    def until_started(self, before):
        """Waits until the controller was sent one more line that starts motion than `before`."""
        self._until(lambda: self.starts() > before, "a motion has started")

    def _until(self, happened, what):
        limit = time.monotonic() + LIMIT_S
        while not happened():
            if time.monotonic() > limit:
                raise AssertionError(f"not seen in {LIMIT_S} s: {what}")
            time.sleep(0.02)  # between two looks; the limit above decides

    def end(self):
        self._begun.close()


def _free_ports():
    with socket.create_server(("127.0.0.1", 0)) as first, socket.create_server(("127.0.0.1", 0)) as second:
        return first.getsockname()[1], second.getsockname()[1]
