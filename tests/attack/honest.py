"""A caller who does nothing wrong, on one connection. Its frames are made by hand as those of the floods; compressed
headers are read by python3-hpack."""

import time

import hpack
import http2
from http2 import Door, frame

STOP = "/axisgate.v1.StageService/Stop"
LIST_DEVICES = "/axisgate.v1.DeviceService/ListDevices"
DEVICE = "devices/stage"
PROBLEM = 2  # the field of StopResponse that is set if something went wrong

_WINDOW = 2**30  # of the connection: no call ends for want of it


class Failed(Exception):
    """A call was not answered, or not with OK."""


def _length_delimited(field, content):
    return bytes([field << 3 | 2, len(content)]) + content


def _varint(data, at):
    value = shift = 0
    while True:
        value |= (data[at] & 0x7F) << shift
        at, shift = at + 1, shift + 7
        if data[at - 1] < 0x80:
            return value, at


def fields(content):
    """The numbers of a message's fields, all of which are messages, texts or whole numbers."""
    at, numbers = 0, []
    while at < len(content):
        key, at = _varint(content, at)
        value, at = _varint(content, at)
        at += value if key & 7 == 2 else 0
        numbers.append(key >> 3)
    return numbers


class Caller:
    def __init__(self, door: Door, token: str | None = None):
        self._door, self._token = door, token
        self._stream = -1
        self._link = door.link()
        self._headers = hpack.Decoder()
        beginning = http2.PREFACE + frame(http2.SETTINGS, 0, 0)
        self._send(beginning + frame(http2.WINDOW_UPDATE, 0, 0, _WINDOW.to_bytes(4, "big")), time.monotonic() + 5)

    def call(self, method: str, content: bytes = b"", limit_s: float = 5) -> bytes:
        """The answer's message."""
        until = time.monotonic() + limit_s
        self._stream += 2
        headers = http2.request_headers(method, secure=self._door.way == "tls", token=self._token)
        self._send(frame(http2.HEADERS, http2.END_HEADERS, self._stream, headers)
                   + frame(http2.DATA, http2.END_STREAM, self._stream, http2.message(content)), until)
        answer = b""
        while not self._link.closed and time.monotonic() < until:
            for kind, flags, stream, payload in self._link.next(until):
                # Of every stream, or the table of what was sent before is lost.
                headers = dict(self._headers.decode(payload)) if kind == http2.HEADERS else {}
                if stream != self._stream:
                    continue
                if kind == http2.DATA:
                    answer += payload
                elif kind == http2.RST_STREAM:
                    raise Failed(f"RST_STREAM {int.from_bytes(payload, 'big')}")
                elif kind == http2.HEADERS and flags & http2.END_STREAM:
                    return self._judged(headers, answer)
        raise Failed(self._closing() if self._link.closed else f"no answer within {limit_s:.1f} s")

    def stop(self, limit_s: float = 5) -> float:
        """Stops all axes, and answers with how many seconds that took."""
        begun = time.monotonic()
        answer = self.call(STOP, _length_delimited(2, DEVICE.encode("ascii")), limit_s)
        if PROBLEM in fields(answer):
            raise Failed(f"the answer names a problem: {answer!r}")
        return time.monotonic() - begun

    def ping(self, limit_s: float = 5) -> None:
        """Failed, if it is not answered."""
        until, before = time.monotonic() + limit_s, self._link.pings_answered
        self._send(frame(http2.PING, 0, 0, b"honestly"), until)
        while self._link.pings_answered == before:
            if self._link.closed or time.monotonic() > until:
                raise Failed(self._closing() if self._link.closed else "a PING is not answered")
            self._link.next(until)

    def idle(self, seconds: float) -> None:
        self._link.wait(time.monotonic() + seconds)

    @property
    def closed(self) -> bool:
        """By the daemon."""
        self._link.take()
        return self._link.closed

    def close(self) -> None:
        self._link.close()

    def _send(self, data, until):
        if not self._link.send(data, until):
            raise Failed(self._closing() if self._link.closed else "nothing can be sent")

    def _closing(self):
        code = self._link.goaway
        return "the connection was closed" + ("" if code is None else f" after a GOAWAY with error code {code}")

    @staticmethod
    def _judged(trailers, answer):
        status = trailers.get("grpc-status")
        if status != "0":
            raise Failed(f"status {status}: {trailers.get('grpc-message')!r}")
        return answer[5:]
