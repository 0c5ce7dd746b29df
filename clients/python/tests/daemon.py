"""A daemon with a simulated stage, and a relay that cuts its connections. AXISGATE_BIN has the programs."""

import contextlib
import os
import pathlib
import re
import select
import signal
import socket
import subprocess
import tempfile
import threading
import time
import unittest

BIN = pathlib.Path(os.environ.get("AXISGATE_BIN", pathlib.Path(__file__).resolve().parents[3] / "build" / "bin"))
LIMIT_S = 30

# The stage runs on a pseudo-terminal of its own, so that it survives the daemon.
CONFIG = """
listen = "127.0.0.1:0"
metrics = "127.0.0.1:0"
socket = "{socket}"
[journal]
kept = {journal}
[[device]]
name = "stage"
connection = "serial"
path = "{tty}"
[[device.axis]]
number = 1
name = "x"
unit = "mm"
travel_minimum = "-15mm"
travel_maximum = "15mm"
[[device.axis]]
number = 2
name = "y"
unit = "mm"
"""


def wait_until(condition, what):
    """Returns once `condition()` is true."""
    limit = time.monotonic() + LIMIT_S
    while not condition():
        if time.monotonic() > limit:
            raise AssertionError(f"waited in vain: {what}")
        time.sleep(0.02)


class Daemon:
    """The daemon of one test, and the simulator that it serves."""

    def __init__(self, folder, journal="true", more=""):
        self._folder = folder
        self.socket = os.path.join(folder, "axisgate.sock")
        tty = os.path.join(folder, "tty")
        self._control = os.path.join(folder, "control")
        self._simulator = subprocess.Popen([BIN / "shrc203-sim", "--pty", tty, "--speed", "4", "--control",
                                            self._control], stdout=subprocess.DEVNULL,
                                           stdin=subprocess.DEVNULL)
        wait_until(lambda: os.path.exists(tty), "the simulator's terminal")
        self._config = os.path.join(folder, "axisgate.toml")
        with open(self._config, "w", encoding="utf-8") as file:
            file.write(CONFIG.format(socket=self.socket, tty=tty, journal=journal) + more)
        self._process = None
        try:
            self.start()
        except BaseException:
            self.end()
            raise

    def start(self, ready="stage: link is UP"):
        """Starts the daemon, and waits until its log has the text `ready`: its controller answers."""
        self._log = open(os.path.join(self._folder, "log"), "w+", encoding="utf-8")
        environment = dict(os.environ, STATE_DIRECTORY=os.path.join(self._folder, "state"))
        self._process = subprocess.Popen([BIN / "axisgated", "--config", self._config], stdout=self._log,
                                         stderr=subprocess.STDOUT, stdin=subprocess.DEVNULL, env=environment)
        wait_until(lambda: self._process.poll() is not None or ready in self.log(), "a ready daemon")
        if self._process.poll() is not None:
            raise AssertionError(f"the daemon ended: {self.log()}")

    def log(self):
        with open(os.path.join(self._folder, "log"), encoding="utf-8") as file:
            return file.read()

    def address(self):
        """Its TCP address, whose callers are anonymous."""
        return re.search(r"gRPC on (\S+) and", self.log())[1]

    def at_stage(self, action):
        """Does what a person at the simulated stage does, such as "unplug 3". Returns the reply."""
        with socket.socket(socket.AF_UNIX) as control:
            control.connect(self._control)
            control.sendall(f"{action}\n".encode())
            answer = control.recv(4096).decode()
        if not answer.startswith("ok"):
            raise AssertionError(answer)
        return answer.strip()

    def restart_without_controller(self):
        """Restarts the daemon, whose controller then does not answer until let_controller_answer()."""
        self._simulator.send_signal(signal.SIGSTOP)
        self.kill()
        self.start(ready="gRPC on")

    def let_controller_answer(self):
        self._simulator.send_signal(signal.SIGCONT)

    def kill(self):
        self._process.kill()
        self._process.wait()
        self._log.close()

    def end(self):
        self.kill()
        self._simulator.kill()
        self._simulator.wait()


class Relay:
    """Passes bytes between clients and the daemon's socket, and cuts connections once the daemon answers."""

    def __init__(self, folder, upstream):
        self.socket = os.path.join(folder, "relay.sock")
        self.cuts = 0
        self._upstream = upstream
        self._first_stream = None
        self._left = 0
        self._listener = socket.socket(socket.AF_UNIX)
        self._listener.bind(self.socket)
        self._listener.listen()
        threading.Thread(target=self._serve, daemon=True).start()

    def cut_answers(self, stream, times=1):
        """Drops the answers to a stream of HTTP/2 (1, 3, 5, ... of each connection) and closes the connection. After
        the first cut, the first answer on each new connection is dropped, `times` times in all."""
        self._first_stream, self._left = stream, times

    def end(self):
        self._listener.close()

    def _serve(self):
        while True:
            try:
                client = self._listener.accept()[0]
            except OSError:  # the listener has ended
                return
            daemon = socket.socket(socket.AF_UNIX)
            try:
                daemon.connect(self._upstream)
            except OSError:  # the daemon does not run
                client.close()
                daemon.close()
                continue
            threading.Thread(target=self._pass, args=(client, daemon), daemon=True).start()

    def _pass(self, client, daemon):
        frames = Frames()
        others = {client: daemon, daemon: client}
        with client, daemon, contextlib.suppress(OSError):
            while True:
                for side in select.select(list(others), [], [])[0]:
                    data = side.recv(65536)
                    if not data or (side is daemon and self._is_cut(frames.streams(data))):
                        return
                    others[side].sendall(data)

    def _is_cut(self, streams):
        if not self._left or not any(stream >= self._first_stream for stream in streams):
            return False
        self.cuts += 1
        self._left -= 1
        self._first_stream = 1
        return True


class Frames:
    """The frames of HTTP/2 that a daemon sends on one connection (RFC 9113, 4.1)."""

    def __init__(self):
        self._unread = b""

    def streams(self, data):
        """Takes bytes. Returns the numbers of the streams whose headers or data begin in them."""
        self._unread += data
        found = []
        while len(self._unread) >= 9:
            if self._unread[3] in (0, 1):
                found.append(int.from_bytes(self._unread[5:9], "big"))
            end = 9 + int.from_bytes(self._unread[:3], "big")
            if len(self._unread) < end:
                break
            self._unread = self._unread[end:]
        return found


class DaemonTest(unittest.TestCase):
    """A test with a daemon of its own."""

    journal = "true"
    more = ""

    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="axisgate-python-")
        self.addCleanup(folder.cleanup)
        self.folder = folder.name
        self.daemon = Daemon(self.folder, self.journal, self.more)
        self.addCleanup(self.daemon.end)

    def open(self, target=None, **arguments):
        """A Stage that is closed when the test ends."""
        from axisgate import Stage
        stage = Stage(target or self.daemon.socket, **arguments)
        self.addCleanup(stage.close)
        return stage
