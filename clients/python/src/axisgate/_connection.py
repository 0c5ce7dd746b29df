"""The blocking form of all calls. It sends and waits; `_repeat` and `_following` decide."""

from __future__ import annotations

import logging
import os
import time
from typing import Any, Callable, Iterable, Optional, TypeVar

import grpc

from axisgate import _version
from axisgate._following import Following
from axisgate._methods import LIST_DEVICES, WAIT_MOTION, Method
from axisgate._outcomes import Failure, failure_of, own, undelivered_stop
from axisgate._repeat import Repeat, for_action
from axisgate._target import OPTIONS, Target
from axisgate.errors import Unavailable
from axisgate.results import is_over
from axisgate.v1 import common_pb2, device_pb2, motion_pb2

_log = logging.getLogger("axisgate")
_T = TypeVar("_T")


class Connection:
    """A Connection is the daemon as one program sees it. All functions are thread safe.

    Stops have a connection of their own, which is open from the start, so that no other call delays them.
    """

    def __init__(self, target: Target, timeout: float) -> None:
        self.target = target
        self._process = os.getpid()
        self._half = timeout / 2
        self._channel = _open(target)
        self._stop_channel = _open(target)
        self._closed = False

    def open(self) -> device_pb2.ListDevicesResponse:
        """Connects for stops and lists the devices. Raises Unavailable at once if no daemon answers."""
        repeat = Repeat(time.monotonic(), self.target.address, self._half, acts=False)
        listed: device_pb2.ListDevicesResponse = self._send(
            repeat, self._unary(self._stop_channel, LIST_DEVICES, device_pb2.ListDevicesRequest()), self._stop_channel)
        _version.compare(listed.version)
        return listed

    def close(self) -> None:
        """Closes the connections. Motions continue."""
        self._closed = True
        self._channel.close()
        self._stop_channel.close()

    def ask(self, method: Method, request: Any, patience: Optional[float] = None) -> Any:
        """Returns the answer to a question. It is repeated for `patience` seconds while no daemon answers."""
        until = time.monotonic() + (self._half if patience is None else patience)
        repeat = Repeat(until, self.target.address, self._half, acts=False)
        return self._send(repeat, self._unary(self._channel, method, request), self._channel)

    def act(self, method: Method, request: Any, lease_token: bytes, patience: float = 0.0,
            started: Optional[Callable[[str], None]] = None) -> Any:
        """Sends a request that changes something, so that it acts at most once, and returns its answer.

        `patience` is the time in seconds that the request may wait for something. `started` receives the id of the
        request before it is sent.
        """
        def attempt(context: common_pb2.CallContext) -> Callable[[float], Any]:
            request.context.CopyFrom(context)
            return self._unary(self._channel, method, request)
        return self.act_by(attempt, lease_token, patience, started)

    def act_by(self, attempt_with: Callable[[common_pb2.CallContext], Callable[[float], _T]], lease_token: bytes,
               patience: float = 0.0, started: Optional[Callable[[str], None]] = None) -> _T:
        """Does the same as act() for a call of another form: `attempt_with` returns the function that sends it once."""
        listed = self.ask(LIST_DEVICES, device_pb2.ListDevicesRequest())
        context, repeat = for_action(listed, self.target, lease_token, patience + self._half, self._half,
                                     time.monotonic())
        if started is not None:
            started(context.request_id)
        return own(self._send(repeat, attempt_with(context), self._channel), context.request_id)

    def stop(self, method: Method, request: Any) -> Any:
        """Sends a stop over its own connection, and returns the answer."""
        repeat = Repeat(time.monotonic() + self._half, self.target.address, self._half)
        try:
            return self._send(repeat, self._unary(self._stop_channel, method, request), self._stop_channel)
        except Unavailable as error:
            raise undelivered_stop(error) from None

    def follow(self, motion: motion_pb2.Motion, timeout: Optional[float]) -> motion_pb2.Motion:
        """Returns the motion with its outcome, or as it is after `timeout` seconds. None: no limit."""
        end = None if timeout is None else time.monotonic() + timeout
        following = Following(motion, self.target.address, time.monotonic())
        while not is_over(motion):
            left = float("inf") if end is None else end - time.monotonic()
            request, limit = following.question(left)
            try:
                motion = self._unary(self._channel, WAIT_MOTION, request)(limit).motion
            except grpc.RpcError as error:
                failure = failure_of(error)
                pause = following.pause_after(failure, time.monotonic())
                if pause is not None:
                    pause_before_repeat(self, failure, min(pause, max(left, 0.0)))
            else:
                following.take(motion, time.monotonic())
            if following.error is not None:
                raise following.error
            if left <= 0:
                break
        return motion

    def stream(self, method: Method, requests: Iterable[bytes], timeout: Optional[float] = None) -> Any:
        """Begins a call with streams in both directions. The result iterates over the answers."""
        self._check()
        _log.debug("%s begins", method.name)
        call = self._channel.stream_stream(method.path, request_serializer=None, response_deserializer=method.parse)
        return call(iter(requests), timeout=timeout, metadata=self.target.metadata)

    def watch(self, method: Method, request: Any, timeout: Optional[float] = None) -> Any:
        """Begins a call that streams answers to one request. The result iterates over them."""
        self._check()
        _log.debug("%s begins", method.name)
        call = self._channel.unary_stream(method.path, request_serializer=None, response_deserializer=method.parse)
        return call(request.SerializeToString(), timeout=timeout, metadata=self.target.metadata)

    def once(self, method: Method, request: Any) -> Callable[[float], Any]:
        """Returns a function that sends the request once, always with the same bytes. Its argument is the deadline."""
        return self._unary(self._channel, method, request)

    def _unary(self, channel: Any, method: Method, request: Any) -> Callable[[float], Any]:
        call = channel.unary_unary(method.path, request_serializer=None, response_deserializer=method.parse)
        content = request.SerializeToString()

        def attempt(timeout: float) -> Any:
            self._check()
            _log.debug("%s is sent", method.name)
            return call(content, timeout=timeout, metadata=self.target.metadata)
        return attempt

    def _send(self, repeat: Repeat, attempt: Callable[[float], _T], channel: Any) -> _T:
        while True:
            try:
                return attempt(repeat.attempt_timeout(time.monotonic()))
            except grpc.RpcError as error:
                failure = failure_of(error)
            pause = repeat.pause_after(failure, time.monotonic())
            _log.debug("failed with %s %s: %s", failure.code.name, failure.reason, failure.text)
            if repeat.error is not None or pause is None:
                raise repeat.error or AssertionError("a repeat without a pause has an error")
            _pause(channel, failure, pause)

    def _check(self) -> None:
        if self._process != os.getpid():
            raise RuntimeError("this Stage was opened before fork(): open another one in the child process")
        if self._closed:
            raise RuntimeError("this Stage is closed")


def pause_before_repeat(connection: Connection, failure: Failure, seconds: float) -> None:
    """Waits before a call that does not stop is sent again."""
    _pause(connection._channel, failure, seconds)


def _pause(channel: Any, failure: Failure, seconds: float) -> None:
    """Waits, at most until there is a connection if there was none. gRPC connects only while something waits for it."""
    if not failure.never_sent:
        return time.sleep(seconds)
    try:
        grpc.channel_ready_future(channel).result(timeout=seconds)
    except grpc.FutureTimeoutError:
        pass


def _open(target: Target) -> Any:
    credentials = target.credentials()
    if credentials is None:
        return grpc.insecure_channel(target.address, options=OPTIONS)
    return grpc.secure_channel(target.address, credentials, options=OPTIONS)
