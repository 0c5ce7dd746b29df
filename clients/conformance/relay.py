"""A relay between a client and the daemon, which delays answers or cuts connections when it is told to."""

import collections
import contextlib
import os
import select
import socket
import threading
import time


class Relay:
    """Passes bytes between its own address and the daemon's; both are ("unix", path) or ("tcp", port on loopback)."""

    def __init__(self, own, daemon):
        self._daemon = daemon
        self._listener = _listen(own)
        self.port = None if own[0] == "unix" else self._listener.getsockname()[1]
        self._lock = threading.Lock()
        self._delay_s = 0.0
        self._refuses = False
        self._delayed = collections.deque()  # (when it is due, to whom, bytes)
        self._pairs = {}  # the end of each pair by the other
        self._wake, self._woken = os.pipe()
        self._ends = False
        self._thread = threading.Thread(target=self._serve)
        self._thread.start()

    def delay(self, seconds):
        """From now on what the daemon sends reaches the client so much later, and never if a cut comes first."""
        self._set(delay_s=seconds)

    def cut(self, *, refuses=False):
        """Closes all connections, and with `refuses` each new one, until restore()."""
        self._set(refuses=refuses)
        with self._lock:
            self._delayed.clear()
            for end in list(self._pairs):
                with contextlib.suppress(OSError):
                    end.shutdown(socket.SHUT_RDWR)

    def restore(self):
        self._set()

    def _set(self, delay_s=0.0, refuses=False):
        with self._lock:
            self._delay_s, self._refuses = delay_s, refuses
        os.write(self._woken, b"!")

    def _serve(self):
        while not self._ends:
            self._send_due()
            with self._lock:
                waiting = [self._listener, self._wake, *self._pairs]
                until = max(self._delayed[0][0] - time.monotonic(), 0) if self._delayed else None
            for ready in select.select(waiting, [], [], until)[0]:
                if ready is self._wake:
                    os.read(self._wake, 100)
                elif ready is self._listener:
                    self._accept()
                elif ready in self._pairs:
                    self._pass_on(ready)
        for end in list(self._pairs):
            end.close()

    def _accept(self):
        client = self._listener.accept()[0]
        daemon = _socket(self._daemon)
        try:
            if self._refuses:
                raise ConnectionRefusedError
            daemon.connect(_address(self._daemon))
        except OSError:
            client.close()
            daemon.close()
            return
        with self._lock:
            self._pairs[client] = (daemon, "daemon")  # what the client sends goes to the daemon
            self._pairs[daemon] = (client, "client")

    def _pass_on(self, end):
        other, side = self._pairs[end]
        try:
            data = end.recv(65536)
        except OSError:
            data = b""
        with self._lock:
            delay_s = self._delay_s if side == "client" else 0.0
        if data and delay_s:
            self._delayed.append((time.monotonic() + delay_s, other, data))
        elif not data or not _sent(other, data):
            self._close(end)

    def _send_due(self):
        while self._delayed and self._delayed[0][0] <= time.monotonic():
            _, end, data = self._delayed.popleft()
            if end in self._pairs and not _sent(end, data):
                self._close(end)

    def _close(self, end):
        with self._lock:
            for closed in (self._pairs[end][0], end):
                del self._pairs[closed]
                closed.close()

    def end(self):
        self._ends = True
        os.write(self._woken, b"!")
        self._thread.join()
        self._listener.close()
        os.close(self._wake)
        os.close(self._woken)


def _sent(end, data):
    try:
        end.sendall(data)
    except OSError:
        return False
    return True


def _socket(address):
    return socket.socket(socket.AF_UNIX if address[0] == "unix" else socket.AF_INET)


def _address(address):
    return address[1] if address[0] == "unix" else ("127.0.0.1", address[1])


def _listen(address):
    listener = _socket(address)
    listener.bind(_address(address))
    listener.listen()
    return listener
