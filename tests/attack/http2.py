"""HTTP/2 by hand: frames, headers and connections, without a library, so that they can also be wrong."""

import dataclasses
import select
import socket
import ssl
import struct
import time

PREFACE = b"PRI * HTTP/2.0\r\n\r\nSM\r\n\r\n"
FRAME_BYTES_MAX = 16_384  # until the other side allows more

DATA, HEADERS, RST_STREAM, SETTINGS, PING, GOAWAY, WINDOW_UPDATE, CONTINUATION = 0, 1, 3, 4, 6, 7, 8, 9
ACK = END_STREAM = 0x1
END_HEADERS = 0x4
CANCEL = 8  # an error code

_HEADER_BYTES = 9
_READ_BYTES = 65_536
_READS_AT_ONCE = 16  # then it is time to send again
_LOOK_S = 0.05  # how soon somebody who waits notices that its time is over

WAYS = ("unix", "loopback", "tls")


def frame(kind, flags, stream, payload=b""):
    return struct.pack(">I", len(payload))[1:] + struct.pack(">BBI", kind, flags, stream) + payload


def _number(value, bits):
    """An integer of HPACK whose first byte has room for `bits` bits (RFC 7541, 5.1)."""
    most = (1 << bits) - 1
    if value < most:
        return bytes([value])
    encoded, value = bytearray([most]), value - most
    while value >= 128:
        encoded.append(value % 128 + 128)
        value //= 128
    return bytes(encoded) + bytes([value])


def _text(text):
    return _number(len(text), 7) + text.encode("ascii")


def literal(name, value):
    """A header without indexing; `name` is text, or a number of the static table (RFC 7541, 6.2.2 and appendix A)."""
    return (_number(name, 4) if isinstance(name, int) else b"\0" + _text(name)) + _text(value)


def request_headers(path, secure=False, token=None):
    """Those of a gRPC call. Indices of the static table: 3 and 6 or 7 whole, 1, 4, 23 and 31 the name."""
    headers = bytes([0x80 | 3, 0x80 | (7 if secure else 6)]) + literal(4, path) + literal(1, "localhost")
    headers += literal(31, "application/grpc") + literal("te", "trailers")
    return headers + (literal(23, f"Bearer {token}") if token else b"")


def message(content=b""):
    """A gRPC message, not compressed."""
    return struct.pack(">BI", 0, len(content)) + content


def tls_context():
    """Whose certificate it is, is not the subject here."""
    context = ssl.SSLContext(ssl.PROTOCOL_TLS_CLIENT)
    context.check_hostname = False
    context.verify_mode = ssl.CERT_NONE
    context.set_alpn_protocols(["h2"])
    return context


@dataclasses.dataclass(frozen=True)
class Door:
    """One way into the daemon: a path, or HOST:PORT."""

    way: str
    address: str

    def connect(self, limit_s=5.0):
        """A socket; no byte was sent."""
        if self.way == "unix":
            raw = socket.socket(socket.AF_UNIX)
            try:
                raw.settimeout(limit_s)
                raw.connect(self.address)
            except OSError:
                raw.close()
                raise
            return raw
        host, port = self.address.rsplit(":", 1)
        raw = socket.create_connection((host, int(port)), timeout=limit_s)
        raw.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        return raw

    def link(self, **how):
        """A connection on which HTTP/2 may begin."""
        raw = self.connect()
        if self.way == "tls":
            try:
                raw = tls_context().wrap_socket(raw)
            except OSError:
                raw.close()
                raise
        return Link(raw, **how)


class Link:
    """A connection that notes what the other side does. `acknowledges`: the other side's SETTINGS and PINGs are
    answered. `deaf`: nothing is read. `is_over` ends each wait early."""

    def __init__(self, connection, acknowledges=True, deaf=False, is_over=lambda: False):
        self.opened = time.monotonic()
        self.closed_after_s = None  # by the other side
        self.goaway = None  # its error code
        self.pings_answered = 0
        self._acknowledges = acknowledges
        self._deaf = deaf
        self._is_over = is_over
        self._unread = b""
        self._replies = b""
        self._connection = connection
        connection.setblocking(False)

    @property
    def closed(self):
        return self.closed_after_s is not None

    def send(self, data, until):
        """Sends all of it, and reads meanwhile. False where the connection was closed or the time was over before."""
        self.take()
        view = memoryview(data + self._replies)  # the first that is sent is the preface
        self._replies = b""
        while view and not self.closed:
            try:
                view = view[self._connection.send(view):]
            except (BlockingIOError, ssl.SSLWantReadError, ssl.SSLWantWriteError):
                if time.monotonic() > until or self._is_over():
                    return False
                self._sleep_until_ready(writing=True)
                self.take()
            except OSError:
                self._note_closed()
        return not self.closed

    def wait(self, until):
        """Reads until then, or until the other side closes; answers with the frames."""
        frames = []
        while not self.closed and time.monotonic() < until and not self._is_over():
            self._sleep_until_ready(writing=False, limit_s=until - time.monotonic())
            frames += self.take()
            if self._replies:
                self.send(b"", until)
        return frames

    def next(self, until):
        """The frames that were received next; none where the time is over or the connection was closed."""
        frames = self.take()
        while not frames and not self.closed and time.monotonic() < until:
            self._sleep_until_ready(writing=False, limit_s=until - time.monotonic())
            frames = self.take()
        return frames

    def take(self):
        """The frames that are there: (kind, flags, stream, payload) of each."""
        frames = []
        if self._deaf:
            return frames
        for _ in range(_READS_AT_ONCE):
            try:
                data = self._connection.recv(_READ_BYTES)
            except (BlockingIOError, ssl.SSLWantReadError, ssl.SSLWantWriteError):
                break
            except OSError:
                data = b""
            if not data:
                self._note_closed()
                break
            frames += self._frames(data)
        return frames

    def close(self):
        self._connection.close()

    def _sleep_until_ready(self, writing, limit_s=_LOOK_S):
        if not writing and isinstance(self._connection, ssl.SSLSocket) and self._connection.pending():
            return
        reading = [] if self._deaf else [self._connection]
        select.select(reading, [self._connection] if writing else [], [], max(0, min(limit_s, _LOOK_S)))

    def _note_closed(self):
        if not self.closed:
            self.closed_after_s = time.monotonic() - self.opened

    def _frames(self, data):
        data, begin, frames = self._unread + data, 0, []
        while len(data) - begin >= _HEADER_BYTES:
            end = begin + _HEADER_BYTES + int.from_bytes(data[begin:begin + 3], "big")
            if end > len(data):
                break
            kind, flags, stream = struct.unpack_from(">BBI", data, begin + 3)
            frames.append((kind, flags, stream, data[begin + _HEADER_BYTES:end]))
            self._note(*frames[-1])
            begin = end
        self._unread = data[begin:]
        return frames

    def _note(self, kind, flags, _stream, payload):
        if kind == GOAWAY:
            self.goaway = int.from_bytes(payload[4:8], "big")
        elif kind == PING and flags & ACK:
            self.pings_answered += 1
        elif kind in (PING, SETTINGS) and not flags & ACK and self._acknowledges:
            self._replies += frame(kind, ACK, 0, payload if kind == PING else b"")
