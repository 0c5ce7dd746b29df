"""The process that translates acts: one JSON object on a line each way."""

import contextlib
import json
import queue
import subprocess
import threading

LIMIT_S = 120


class Runner:
    def __init__(self, command):
        self._process = subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)
        self._replies = queue.Queue()
        self._reader = threading.Thread(target=self._read)
        self._reader.start()

    def __enter__(self):
        return self

    def _read(self):
        for line in self._process.stdout:
            self._replies.put(line)
        self._replies.put(None)

    def say(self, act):
        """Returns the reply. Raises AssertionError if the runner has none."""
        try:
            self._process.stdin.write(json.dumps(act) + "\n")
            self._process.stdin.flush()
            line = self._replies.get(timeout=LIMIT_S)
        except BrokenPipeError:
            line = None
        except queue.Empty:
            raise AssertionError(f"no reply to {act} within {LIMIT_S} s") from None
        if line is None:
            raise AssertionError(f"the runner ended at {act}")
        return json.loads(line)

    def __exit__(self, *_):
        with contextlib.suppress(BrokenPipeError):
            self._process.stdin.close()
        try:
            self._process.wait(timeout=LIMIT_S)
        except subprocess.TimeoutExpired:
            self._process.kill()
        self._reader.join()
        self._process.stdout.close()
