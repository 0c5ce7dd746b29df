"""The daemon that is attacked, its doors, and attackers in processes of their own."""

import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import threading

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent / "integration"))

from http2 import Door  # noqa: E402
from programs import BIN, LIMIT_S, Daemon  # noqa: E402

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

LIMIT_KIB = 4 * 1024 * 1024
_SAMPLE_S = 0.05


class Target:
    """A daemon of its own, with a simulated stage. `end` ends it."""

    def __init__(self):
        self._folder = tempfile.TemporaryDirectory(prefix="axisgate-attack-")
        folder = self._folder.name
        subprocess.run([BIN / "axisgate-certificates", folder, "lab", "gateway"], check=True, timeout=LIMIT_S)
        try:
            self.daemon = Daemon(folder, CONFIG.replace("FOLDER", folder))
        except BaseException:
            self._folder.cleanup()
            raise
        self._addresses = {"unix": self.daemon.socket, "loopback": self.daemon.address(),
                           "tls": re.search(r"gRPC with TLS on (\S+)", self.daemon.log())[1]}
        self.honest_token = self._new_token("honest")
        self.attackers_token = self._new_token("attacker")

    def end(self):
        self.daemon.stop()
        self._folder.cleanup()

    def door(self, way):
        return Door(way, self._addresses[way])

    def _new_token(self, name):
        made = self.daemon.run("token", "create", name)
        if made.returncode != 0:
            raise AssertionError(made.stderr)
        return made.stdout.strip()

    def axisctl(self, way, *words, limit_s=LIMIT_S):
        """A new process: whether it succeeded within the time limit."""
        environment = {name: value for name, value in os.environ.items() if not name.startswith("AXISGATE_")}
        command = [BIN / "axisctl", "--target", self._addresses[way]]
        if way == "tls":
            command += ["--ca", os.path.join(self._folder.name, "lab.crt")]
            environment["AXISGATE_TOKEN"] = self.honest_token
        try:
            return subprocess.run([*command, *words], env=environment, stdin=subprocess.DEVNULL, capture_output=True,
                                  timeout=limit_s, check=False).returncode == 0
        except subprocess.TimeoutExpired:
            return False

    def memory_kib(self):
        """0 where it is no more."""
        try:
            with open(f"/proc/{self.daemon.pid}/status", encoding="ascii") as file:
                found = re.search(r"VmRSS:\s+(\d+) kB", file.read())
        except OSError:
            found = None
        return int(found[1]) if found else 0


class MemoryPeak:
    """The most memory that a daemon takes from `begin` to `end`, by samples. Beyond the limit the attackers are ended,
    so that a flood does not take the memory of the machine."""

    def __init__(self, target, attackers, limit_kib=LIMIT_KIB):
        self._target, self._attackers, self._limit_kib = target, attackers, limit_kib
        self._over = threading.Event()
        self._thread = threading.Thread(target=self._sample)
        self.kib = 0
        self.limit_reached = False

    def begin(self):
        self._thread.start()

    def end(self):
        self._over.set()
        self._thread.join()

    def __enter__(self):
        self.begin()
        return self

    def __exit__(self, *_):
        self.end()

    def _sample(self):
        while True:
            self.kib = max(self.kib, self._target.memory_kib())
            if self.kib > self._limit_kib and not self.limit_reached:
                self.limit_reached = True
                self._attackers.terminate()
            if self._over.wait(_SAMPLE_S):
                return


class Attackers:
    """Processes that flood a target, one connection each, all of them on one core."""

    def __init__(self, target, flood, way, credentials, count, seconds, deaf=False):
        door = target.door(way)
        command = [sys.executable, HERE / "floods.py", flood, "--way", way, "--address", door.address,
                   "--credentials", credentials, "--seconds", str(seconds),
                   "--core", str(max(os.sched_getaffinity(0))), *(["--deaf"] if deaf else [])]
        environment = dict(os.environ, AXISGATE_TOKEN=target.attackers_token, PYTHONDONTWRITEBYTECODE="1")
        self._limit_s = seconds + LIMIT_S
        self._processes = [subprocess.Popen(command, env=environment, stdin=subprocess.DEVNULL,
                                            stdout=subprocess.PIPE, text=True) for _ in range(count)]

    def await_begin(self):
        for process in self._processes:
            if process.stdout.readline() != "begun\n":
                self.kill()
                raise AssertionError("an attacker does not begin")

    def terminate(self):
        """Ends their floods now."""
        for process in self._processes:
            process.terminate()

    def outcomes(self):
        """When their seconds are over: what each reports."""
        try:
            return [json.loads(process.communicate(timeout=self._limit_s)[0].splitlines()[-1])
                    for process in self._processes]
        finally:
            self.kill()

    def kill(self):
        for process in self._processes:
            process.kill()
            process.wait()
            process.stdout.close()
