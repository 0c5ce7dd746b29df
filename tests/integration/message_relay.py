"""Between one gRPC client and the daemon: passes on everything, and knows when the client's messages passed."""

import contextlib
import os
import select
import socket
import threading
import time

from programs import LIMIT_S

_PREFACE_BYTES = 24  # RFC 9113, 3.4
_HEADER_BYTES = 9  # of a frame: length (3), type (1), flags, stream
_DATA = 0


class MessageRelay:
    """For one connection, by Unix sockets."""

    def __init__(self, path, daemon):
        self.path = path
        self._daemon = daemon
        self._listener = socket.socket(socket.AF_UNIX)
        self._listener.bind(path)
        self._listener.listen()
        self._end, self._ended = os.pipe()
        self._unread = b""
        self._skip = _PREFACE_BYTES
        self._passed = {}  # by stream: when each of its messages did
        self._thread = threading.Thread(target=self._serve)
        self._thread.start()

    def until_stream_of(self, count):
        """Waits for a stream on which so many messages have passed: the times of all of them, by time.monotonic()."""
        limit = time.monotonic() + LIMIT_S
        while True:
            for passed in list(self._passed.values()):
                if len(passed) >= count:
                    return passed
            if time.monotonic() > limit:
                raise AssertionError(f"no stream of {count} messages: {self._passed}")
            time.sleep(0.01)  # between two looks; the limit above decides

    def streams(self):
        """How many have passed messages."""
        return len(self._passed)

    def _serve(self):
        if self._end in select.select([self._listener, self._end], [], [])[0]:
            return
        with self._listener.accept()[0] as client, socket.socket(socket.AF_UNIX) as daemon:
            daemon.connect(self._daemon)
            with contextlib.suppress(ConnectionError):  # one of them was killed
                self._pass_on(client, daemon)

    def _pass_on(self, client, daemon):
        others = {client: daemon, daemon: client}
        while True:
            ready = select.select([*others, self._end], [], [])[0]
            if self._end in ready:
                return
            for side in ready:
                data = side.recv(65536)
                if not data:
                    return
                if side is client:
                    self._note(data)
                others[side].sendall(data)

    def _note(self, data):
        now = time.monotonic()
        self._unread += data
        while len(self._unread) >= self._skip + _HEADER_BYTES:
            frame = self._unread[self._skip:]
            if frame[3] == _DATA:
                self._passed.setdefault(frame[5:9], []).append(now)
            self._unread = frame
            self._skip = _HEADER_BYTES + int.from_bytes(frame[:3], "big")

    def stop(self):
        os.write(self._ended, b"!")
        self._thread.join()
        self._listener.close()
        os.close(self._end)
        os.close(self._ended)
