#!/usr/bin/python3
"""A gateway that is broken in one way: passes all calls on to the daemon, and does one thing wrong. What a row's check is
worth is seen when it fails here.
usage: breaker.py FAULT DAEMON      prints its own address, and ends with its standard input"""

import concurrent.futures
import itertools
import os
import sys
import threading
import time

import grpc

WORKERS = 600  # a call needs one as long as it runs
MANY = 50  # so many calls of a method are answered well
SETTLE_S = 0.1

# These options let honest clients send PINGs and metadata.
GENEROUS = {"grpc.max_metadata_size": 64 << 10, "grpc.http2.max_ping_strikes": 0, "grpc.so_reuseport": 0}
OPTIONS = {
    "no gzip": {"grpc.compression_enabled_algorithms_bitset": 1},
    "few pings": {"grpc.http2.max_ping_strikes": 1},
    "little metadata": {"grpc.max_metadata_size": 8 << 10},
}


def without(messages, number):
    """All but the one of this number, which counts from 0."""
    return (message for at, message in enumerate(messages) if at != number)


def repeated(messages):
    """The last one again and again, as a caller who is still there would send it."""
    last = None
    for last in itertools.islice(messages, 1):
        yield last
    while True:
        time.sleep(SETTLE_S)
        yield last


class Relay(grpc.GenericRpcHandler):
    def __init__(self, fault, daemon):
        self._fault = fault
        self._channel = grpc.insecure_channel(daemon, options=[("grpc.max_metadata_size", 64 << 10)])
        self._calls = {}
        self._deaf = []  # calls that would be cancelled with their last reference
        self._lock = threading.Lock()

    def service(self, details):
        method = details.method.rsplit("/", 1)[-1]
        return grpc.stream_stream_rpc_method_handler(
            lambda requests, context: self._pass_on(details, method, requests, context))

    def _number(self, method):
        with self._lock:
            self._calls[method] = self._calls.get(method, 0) + 1
            return self._calls[method]

    def _pass_on(self, details, method, requests, context):
        number = self._number(method)
        if self._fault == "refuses some" and method == "GetDevice" and number % MANY == 0:
            context.abort(grpc.StatusCode.RESOURCE_EXHAUSTED, "one too many")
        if self._fault == "ends watches" and method == "Watch":
            return
        if self._fault == "loses a part" and method == "SendJob":
            requests = without(requests, MANY)
        if self._fault == "acts twice" and method == "SendJob":
            requests = list(requests)
            list(self._begin(details, iter(requests), context))
            requests = iter(requests)
        deaf = self._fault == "hears no cancel" and method == "Jog"
        if deaf:
            requests = repeated(requests)
        try:
            answers = self._begin(details, requests, context, not deaf)
            yield from self._shown(method, number, answers)
        except grpc.RpcError as error:
            context.set_trailing_metadata(error.trailing_metadata() or ())
            context.abort(error.code(), error.details())

    def _begin(self, details, requests, context, cancelled_with=True):
        metadata = [(key, value) for key, value in details.invocation_metadata if key != "user-agent"]
        call = self._channel.stream_stream(details.method)(
            requests, metadata=metadata, timeout=context.time_remaining() if cancelled_with else None,
            wait_for_ready=True)
        if cancelled_with:
            context.add_callback(call.cancel)
        else:
            self._deaf.append(call)
        return call

    def _shown(self, method, number, answers):
        if self._fault == "loses an event" and method == "Watch":
            return without(answers, 3)
        if self._fault == "loses the next event" and method == "Watch" and number > 1:
            return without(answers, 0)
        if self._fault == "loses a reply" and method == "Execute":
            return without(answers, 1)
        if self._fault == "loses an answer" and method in ("GetDevice", "GetCaller") and number == MANY:
            return without(answers, 0)
        if self._fault == "ends early" and method in ("Jog", "KeepLeaseAlive"):
            return itertools.islice(answers, 1)
        return answers


def main():
    fault, daemon = sys.argv[1:]
    options = GENEROUS | OPTIONS.get(fault, {})
    if fault != "few pings":
        options |= {"grpc.keepalive_permit_without_calls": 1, "grpc.http2.min_recv_ping_interval_without_data_ms": 10}
    threads = concurrent.futures.ThreadPoolExecutor(WORKERS)
    server = grpc.server(threads, [Relay(fault, daemon)], options=list(options.items()))
    port = server.add_insecure_port("127.0.0.1:0")
    server.start()
    print(f"127.0.0.1:{port}", flush=True)
    sys.stdin.read()
    os._exit(0)  # calls that hear no cancel would be waited for


if __name__ == "__main__":
    main()
