"""A tty as a host sees it, without the gateway, and a serial server that offers one on loopback."""

import os
import select
import socket
import threading
import tty

from programs import LIMIT_S


def ask(path, command):
    """The controller's answer to one line."""
    line = os.open(path, os.O_RDWR | os.O_NOCTTY)
    try:
        tty.setraw(line)
        os.write(line, command.encode() + b"\r\n")
        answer = b""
        while not answer.endswith(b"\r\n"):
            if not select.select([line], [], [], LIMIT_S)[0]:
                raise AssertionError(f"no answer to {command}: {answer}")
            answer += os.read(line, 100)
        return answer.decode().strip()
    finally:
        os.close(line)


class SerialServer:
    """A raw port, which takes one connection at a time: a second one is reset at once."""

    def __init__(self, path):
        self._path = path
        self._listener = socket.create_server(("127.0.0.1", 0))
        self.port = self._listener.getsockname()[1]
        self._wake, self._woken = os.pipe()
        self._drop = False
        self._thread = threading.Thread(target=self._serve)
        self._thread.start()

    def _serve(self):
        line = os.open(self._path, os.O_RDWR | os.O_NOCTTY)
        tty.setraw(line)
        client = None
        while True:
            waiting = [self._listener, self._wake, line] + ([client] if client else [])
            ready = select.select(waiting, [], [])[0]
            if self._wake in ready and os.read(self._wake, 1) == b"e":
                break
            if self._wake in ready and client:
                client.close()
                client = None
                continue
            if self._listener in ready:
                fresh = self._listener.accept()[0]
                client, refused = (client, fresh) if client else (fresh, None)
                if refused:
                    refused.close()
            if line in ready:
                data = os.read(line, 4096)
                if client:
                    client.sendall(data)
            if client in ready:
                client = self._pass_on(client, line)
        for end in (client, self._listener):
            if end:
                end.close()
        os.close(line)

    @staticmethod
    def _pass_on(client, line):
        try:
            data = client.recv(4096)
        except ConnectionResetError:
            data = b""
        if not data:
            client.close()
            return None
        os.write(line, data)
        return client

    def drop_connection(self):
        os.write(self._woken, b"d")

    def stop(self):
        os.write(self._woken, b"e")
        self._thread.join()
        os.close(self._wake)
        os.close(self._woken)
