"""The real programs, started, awaited and ended by the tests of this folder."""

import os
import pathlib
import queue
import re
import subprocess
import threading
import time
import urllib.request

ROOT = pathlib.Path(__file__).resolve().parents[2]
BIN = pathlib.Path(os.environ.get("AXISGATE_BIN", ROOT / "build" / "bin"))
LIMIT_S = 30


def can_trace():
    """Whether strace works here: a container may forbid it."""
    return subprocess.run(["strace", "-qq", "-o", "/dev/null", "true"], check=False).returncode == 0


class Lines:
    """A process whose output is awaited line by line, each wait with a limit."""

    def __init__(self, arguments):
        self.process = subprocess.Popen(arguments, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                                        stderr=subprocess.PIPE, text=True)
        self._errors = ""
        self._has_errors = threading.Condition()
        self._lines = queue.Queue()
        self._readers = [threading.Thread(target=self._read), threading.Thread(target=self._read_errors)]
        for reader in self._readers:
            reader.start()

    def _read(self):
        for line in self.process.stdout:
            self._lines.put(line.rstrip("\n"))
        self._lines.put(None)

    def _read_errors(self):
        for line in self.process.stderr:
            with self._has_errors:
                self._errors += line
                self._has_errors.notify()

    @property
    def errors(self):
        """All of standard error, which is known only once the process has ended; before, see until_error()."""
        assert not any(reader.is_alive() for reader in self._readers), "errors of a process that still runs"
        return self._errors

    def until_error(self, pattern):
        """What is shown on standard output may be read before what was written to standard error ahead of it."""
        with self._has_errors:
            if not self._has_errors.wait_for(lambda: re.search(pattern, self._errors), LIMIT_S):
                raise AssertionError(f"standard error does not say {pattern}: {self._errors}")

    def next(self):
        line = self._lines.get(timeout=LIMIT_S)
        if line is None:
            raise AssertionError("the output ended; standard error: " + self._errors)
        return line

    def until(self, pattern):
        while True:
            line = self.next()
            if re.search(pattern, line):
                return line

    def end(self):
        code = self.process.wait(timeout=LIMIT_S)
        for reader in self._readers:
            reader.join()
        self.process.stdout.close()
        self.process.stderr.close()
        return code

    def kill(self):
        self.process.kill()
        self.end()


class Daemon:
    """`process` goes to subprocess.Popen."""

    def __init__(self, folder, config, program="axisgated", **process):
        self.socket = os.path.join(folder, "axisgate.sock")
        path = os.path.join(folder, "axisgate.toml")
        with open(path, "w", encoding="utf-8") as file:
            file.write(config.format(socket=self.socket))
        self._log_path = os.path.join(folder, "axisgated.log")
        self._log = open(self._log_path, "a+", encoding="utf-8")
        process.setdefault("env", dict(os.environ, STATE_DIRECTORY=os.path.join(folder, "state")))
        self._process = subprocess.Popen([BIN / program, "--config", path], stdout=self._log,
                                         stderr=subprocess.STDOUT, **process)
        self.pid = self._process.pid
        self._wait_until_ready()

    def _wait_until_ready(self):
        deadline = time.monotonic() + LIMIT_S
        while not self._is_ready():
            if self._process.poll() is not None or time.monotonic() > deadline:
                self.stop()
                raise AssertionError("the daemon did not get ready")
            time.sleep(0.05)  # between two looks; the deadline above decides

    def _is_ready(self):
        """A mill is up as soon as its line is open: where there is a stage, it decides."""
        devices = self.run("devices").stdout.splitlines()
        stages = [line for line in devices if "  rml1  " not in line]
        return any("UP" in line for line in stages or devices)

    def command(self, *arguments):
        return [BIN / "axisctl", "--target", self.socket, *arguments]

    def run(self, *arguments, stdin=""):
        return subprocess.run(self.command(*arguments), input=stdin, capture_output=True, text=True,
                              timeout=2 * LIMIT_S, check=False)

    def start(self, *arguments):
        return Lines(self.command(*arguments))

    def address(self):
        return re.findall(r"gRPC on (\S+) and", self.log())[-1]  # a daemon of the same folder may have been before

    def log(self):
        with open(self._log_path, encoding="utf-8") as file:
            return file.read()

    def metrics_address(self):
        return re.findall(r"metrics on http://(\S+)/metrics", self.log())[-1]

    def metrics_page(self):
        with urllib.request.urlopen(f"http://{self.metrics_address()}/metrics", timeout=LIMIT_S) as answer:
            return answer.read().decode("utf-8")

    def wait_for_log(self, pattern):
        deadline = time.monotonic() + LIMIT_S
        while not re.search(pattern, self.log()):
            if time.monotonic() > deadline:
                raise AssertionError(f"the log does not say {pattern}: {self.log()}")
            time.sleep(0.02)  # between two looks; the deadline above decides

    def signal(self, number):
        self._process.send_signal(number)

    def wait(self, seconds):
        """Raises subprocess.TimeoutExpired."""
        return self._process.wait(timeout=seconds)

    def exit_code(self):
        return self.wait(LIMIT_S)

    def kill(self):
        self._process.kill()
        self._process.wait(timeout=LIMIT_S)

    def stop(self):
        self._process.terminate()
        try:
            self._process.wait(timeout=LIMIT_S)
        except subprocess.TimeoutExpired:
            self._process.kill()
            self._process.wait()
        self._log.close()
