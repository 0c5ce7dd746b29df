"""A client that counts the windows of both sides: the Python library h2 raises an error if the daemon sends more than it
was allowed to, and so does this program if it is kept from what it was allowed."""

import socket
import struct
import time

import h2.config
import h2.connection
import h2.events
import h2.settings

LIMIT_S = 30
FRONTS = "/axisgate.v1.DeviceService/ListDevices"
GRPCS = "/axisgate.v1.CommandService/ListCommands"
ROUNDS = 20


def message(payload):
    return struct.pack(">BI", 0, len(payload)) + payload


class Client:
    """Opens the windows of its streams only as `take` says."""

    def __init__(self, address, window):
        host, _, port = address.rpartition(":")
        self._socket = socket.create_connection((host.strip("[]"), int(port)), LIMIT_S)
        self._h2 = h2.connection.H2Connection(h2.config.H2Configuration(header_encoding="utf-8"))
        self._h2.initiate_connection()
        self._h2.update_settings({h2.settings.SettingCodes.INITIAL_WINDOW_SIZE: window})
        self._address, self.taken, self.ended = address, {}, {}
        self._flush()

    def _flush(self):
        self._socket.sendall(self._h2.data_to_send())

    def call(self, path, payload=b""):
        stream = self._h2.get_next_available_stream_id()
        self._h2.send_headers(stream, [(":method", "POST"), (":scheme", "http"), (":authority", self._address),
                                       (":path", path), ("content-type", "application/grpc"), ("te", "trailers")])
        self._h2.send_data(stream, message(payload), end_stream=True)
        self.taken[stream] = 0
        self._flush()
        return stream

    def take(self, stream, size):
        """The daemon may send as many bytes more, of this stream and in all."""
        self._h2.increment_flow_control_window(size)
        if stream not in self.ended:
            self._h2.increment_flow_control_window(size, stream)
        self._flush()

    def read_until(self, done):
        """h2 raises FlowControlError where more comes than the windows allow."""
        deadline = time.monotonic() + LIMIT_S
        while not done():
            if time.monotonic() > deadline:
                raise AssertionError(f"nothing comes: {self.taken}, ended: {self.ended}")
            data = self._socket.recv(65536)
            if not data:
                raise AssertionError("the daemon has closed the connection")
            for event in self._h2.receive_data(data):
                self._note(event)
            self._flush()

    def _note(self, event):
        if isinstance(event, h2.events.DataReceived):
            self.taken[event.stream_id] += event.flow_controlled_length
        if isinstance(event, h2.events.TrailersReceived):
            self.ended[event.stream_id] = dict(event.headers).get("grpc-status")
        if isinstance(event, (h2.events.StreamReset, h2.events.ConnectionTerminated)):
            raise AssertionError(f"{event}")

    def close(self):
        self._socket.close()


def check(address):
    """Answers of the front and of gRPC share the window of a connection: each gets what its own window allows, and both
    go on as it is opened. How many calls were made."""
    client = Client(address, window=1000)
    device = b"\x0a\x0d" + b"devices/stage"
    calls = 0
    for _ in range(ROUNDS):
        long, short = client.call(GRPCS, device), client.call(FRONTS)
        calls += 2
        client.read_until(lambda: short in client.ended and client.taken[long] == 1000)
        while long not in client.ended:
            had = client.taken[long]
            client.take(long, 1000)
            client.read_until(lambda: long in client.ended or client.taken[long] == had + 1000)
        client.take(short, client.taken[short])
        if client.ended[long] != "0" or client.ended[short] != "0":
            raise AssertionError(f"statuses {client.ended}")
    client.close()
    return calls
