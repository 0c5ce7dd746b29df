"""The process that translates acts: one JSON object on a line each way."""

import contextlib
import json
import queue
import subprocess
import threading

LIMIT_S = 120


class Runner:
    """A Runner ends with its block. A runner that gave no reply in time is ended at once, and may be started again."""

    def __init__(self, command):
        self._command = command
        self._process = None

    @property
    def runs(self):
        return self._process is not None and self._process.poll() is None

    def start(self):
        """Starts the process. It must not run."""
        self._close()
        self._process = subprocess.Popen(self._command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)
        self._replies = queue.Queue()
        self._reader = threading.Thread(target=self._read)
        self._reader.start()

    def __enter__(self):
        return self

    def _read(self):
        for line in self._process.stdout:
            self._replies.put(line)
        self._replies.put(None)

    def say(self, act, limit_s):
        """Returns the reply. Raises AssertionError if the runner gives none within the limit."""
        try:
            self._process.stdin.write(json.dumps(act) + "\n")
            self._process.stdin.flush()
            line = self._replies.get(timeout=limit_s)
        except BrokenPipeError:
            line = None
        except queue.Empty:
            self._process.kill()  # a reply that comes late must not be taken for that to the next act
            self._process.wait()
            raise AssertionError(f"no reply within {limit_s} s to {json.dumps(act)}") from None
        if line is None:
            raise AssertionError(f"the runner ended at {act}")
        return json.loads(line)

    def __exit__(self, *_):
        self._close()

    def _close(self):
        if self._process is None:
            return
        with contextlib.suppress(BrokenPipeError):
            self._process.stdin.close()
        try:
            self._process.wait(timeout=LIMIT_S)
        except subprocess.TimeoutExpired:
            self._process.kill()
            self._process.wait()
        self._reader.join()
        self._process.stdout.close()
