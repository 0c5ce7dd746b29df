"""Calls of one channel, counted, with checks that say what was seen and what was expected."""

import importlib
import os

import grpc

CALL_S = 30


class Failure(Exception):
    """Something was not as described."""

    def __init__(self, what, seen, expected):
        super().__init__(" ".join(f"{what}: seen {seen}, expected {expected}".split()))


def expect(what, seen, expected):
    if seen != expected:
        raise Failure(what, seen, expected)


class Stream:
    """Reads the messages of one streaming call in their order."""

    def __init__(self, name, call):
        self.name = name
        self.call = call

    def next(self):
        """Returns the next message, or None if the call has ended."""
        try:
            return next(self.call)
        except (StopIteration, grpc.RpcError):
            return None

    def said(self):
        return f"{self.call.code().name} {self.call.details()}"

    def message(self):
        """Returns the next message. Raises Failure if the call has ended."""
        message = self.next()
        if message is None:
            raise Failure(self.name, f"end with {self.said()}", "a message")
        return message

    def end(self, code):
        """Reads to the end of the call and returns the messages. Raises Failure if it does not end with `code`."""
        messages = list(iter(self.next, None))
        if self.call.code().name != code:
            raise Failure(f"end of {self.name}", self.said(), code)
        return messages


class Calls:
    """Makes calls on one channel. Methods are named after their file and service: "device.DeviceService.GetDevice"."""

    def __init__(self, target, options=(), compression=None):
        self.count = 0
        self.stubs = {}
        probe = [("grpc.http2.bdp_probe", 0)] if os.environ.get("AXISGATE_BDP_PROBE") == "0" else []
        options = [("grpc.enable_http_proxy", 0), *probe, *options]
        self.channel = grpc.insecure_channel(target, options, compression)

    def method(self, name):
        """Returns the method's callable and counts one call."""
        self.count += 1
        file, service, method = name.split(".")
        if service not in self.stubs:
            module = importlib.import_module(f"axisgate.v1.{file}_pb2_grpc")
            self.stubs[service] = getattr(module, f"{service}Stub")(self.channel)
        return getattr(self.stubs[service], method)

    def call(self, name, request, code="OK", **options):
        """Returns the answer to a message or an iterator of messages. Raises Failure if it does not end with `code`."""
        try:
            answer = self.method(name)(request, **{"timeout": CALL_S, **options})
        except grpc.RpcError as error:
            if error.code().name != code:
                raise Failure(name, f"{error.code().name} {error.details()}", code) from None
            return None
        expect(name, "OK", code)
        return answer

    def begin(self, name, request):
        """Begins a unary call and returns its future."""
        return self.method(name).future(request, timeout=CALL_S)

    def stream(self, name, request, **options):
        """Begins a call whose answer is a stream; its request is a message or an iterator of messages."""
        return Stream(name, self.method(name)(request, **{"timeout": CALL_S, **options}))
