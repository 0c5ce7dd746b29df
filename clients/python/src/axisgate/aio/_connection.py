"""The asyncio form of all calls. It sends and waits; `_repeat` and `_following` decide."""

from __future__ import annotations

import asyncio
import logging
import os
import time
from typing import Any, Awaitable, Callable, Optional, Set, TypeVar

import grpc
import grpc.aio

from axisgate import _version
from axisgate._following import Following
from axisgate._methods import LIST_DEVICES, WAIT_MOTION, Method
from axisgate._outcomes import Failure, failure_of, own, undelivered_stop
from axisgate._repeat import Repeat, for_action
from axisgate._target import OPTIONS, Target
from axisgate.aio._tasks import Tasks, is_being_cancelled
from axisgate.errors import Unavailable
from axisgate.results import is_over
from axisgate.v1 import common_pb2, device_pb2, motion_pb2

_log = logging.getLogger("axisgate")
_T = TypeVar("_T")
Attempt = Callable[[float], Awaitable[_T]]
"""Sends a request once. The argument is the deadline in seconds."""


class Connection:
    """A Connection is the daemon as one event loop sees it.

    Stops have a connection of their own, which is open from the start, so that no other call delays them.
    """

    def __init__(self, target: Target, timeout: float) -> None:
        self.target = target
        self.tasks = Tasks()
        self._half = timeout / 2
        self._channel: Any = None
        self._stop_channel: Any = None
        self._closed = False
        self._calls: Set[Any] = set()

    async def open(self) -> device_pb2.ListDevicesResponse:
        """Connects for stops and lists the devices. Raises Unavailable at once if no daemon answers."""
        if self._channel is not None:
            raise RuntimeError("this Stage was opened before: create another one")
        self._process = os.getpid()
        self._loop = asyncio.get_running_loop()
        self._channel = _open(self.target)
        self._stop_channel = _open(self.target)
        repeat = Repeat(time.monotonic(), self.target.address, self._half, acts=False)
        listed: device_pb2.ListDevicesResponse = await self._send(
            repeat, self._unary(self._stop_channel, LIST_DEVICES, device_pb2.ListDevicesRequest()), self._stop_channel)
        _version.compare(listed.version)
        return listed

    async def close(self) -> None:
        """Ends all tasks and closes the connections. Motions continue."""
        if self._channel is None or self._closed:
            return
        self.check()
        await self.tasks.end()
        self._closed = True
        await asyncio.gather(*(end(call) for call in list(self._calls)))
        await self._channel.close()
        await self._stop_channel.close()

    async def ask(self, method: Method, request: Any, patience: Optional[float] = None) -> Any:
        """Returns the answer to a question. It is repeated for `patience` seconds while no daemon answers."""
        until = time.monotonic() + (self._half if patience is None else patience)
        repeat = Repeat(until, self.target.address, self._half, acts=False)
        return await self._send(repeat, self._unary(self._channel, method, request), self._channel)

    async def act(self, method: Method, request: Any, lease_token: bytes, patience: float = 0.0,
                  started: Optional[Callable[[str], None]] = None) -> Any:
        """Sends a request that changes something, so that it acts at most once, and returns its answer.

        `patience` is the time in seconds that the request may wait for something. `started` receives the id of the
        request before it is sent.
        """
        def attempt(context: common_pb2.CallContext) -> Attempt[Any]:
            request.context.CopyFrom(context)
            return self._unary(self._channel, method, request)
        return await self.act_by(attempt, lease_token, patience, started)

    async def act_by(self, attempt_with: Callable[[common_pb2.CallContext], Attempt[_T]], lease_token: bytes,
                     patience: float = 0.0, started: Optional[Callable[[str], None]] = None) -> _T:
        """Does the same as act() for a call of another form: `attempt_with` returns the function that sends it once."""
        listed = await self.ask(LIST_DEVICES, device_pb2.ListDevicesRequest())
        context, repeat = for_action(listed, self.target, lease_token, patience + self._half, self._half,
                                     time.monotonic())
        if started is not None:
            started(context.request_id)
        return own(await self._send(repeat, attempt_with(context), self._channel), context.request_id)

    async def stop(self, method: Method, request: Any) -> Any:
        """Sends a stop over its own connection, and returns the answer."""
        repeat = Repeat(time.monotonic() + self._half, self.target.address, self._half)
        try:
            return await self._send(repeat, self._unary(self._stop_channel, method, request), self._stop_channel)
        except Unavailable as error:
            raise undelivered_stop(error) from None

    async def follow(self, motion: motion_pb2.Motion, timeout: Optional[float]) -> motion_pb2.Motion:
        """Returns the motion with its outcome, or as it is after `timeout` seconds. None: no limit."""
        end = None if timeout is None else time.monotonic() + timeout
        following = Following(motion, self.target.address, time.monotonic())
        while not is_over(motion):
            left = float("inf") if end is None else end - time.monotonic()
            request, limit = following.question(left)
            try:
                motion = (await self._unary(self._channel, WAIT_MOTION, request)(limit)).motion
            except grpc.RpcError as error:
                failure = failure_of(error)
                pause = following.pause_after(failure, time.monotonic())
                if pause is not None:
                    await self.pause_before_repeat(failure, min(pause, max(left, 0.0)))
            else:
                following.take(motion, time.monotonic())
            if following.error is not None:
                raise following.error
            if left <= 0:
                break
        return motion

    def stream(self, method: Method, requests: Any, timeout: Optional[float] = None) -> Any:
        """Begins a call with streams in both directions. `requests` is an iterator, which may be asynchronous."""
        self.check()
        _log.debug("%s begins", method.name)
        call = self._channel.stream_stream(method.path, request_serializer=None, response_deserializer=method.parse)
        return self._noted(call(requests, timeout=timeout, metadata=self.target.metadata))

    def watch(self, method: Method, request: Any) -> Any:
        """Begins a call that streams answers to one request."""
        self.check()
        _log.debug("%s begins", method.name)
        call = self._channel.unary_stream(method.path, request_serializer=None, response_deserializer=method.parse)
        return self._noted(call(request.SerializeToString(), metadata=self.target.metadata))

    async def pause_before_repeat(self, failure: Failure, seconds: float) -> None:
        """Waits before a call that does not stop is sent again."""
        await _pause(self._channel, failure, seconds)

    def explain_cancellation(self) -> None:
        """Raises RuntimeError if close() has cancelled the call of this task, rather than the task itself."""
        if self._closed and not is_being_cancelled():
            raise RuntimeError("this Stage is closed") from None

    def check(self) -> None:
        """Raises RuntimeError unless calls are possible here and now."""
        if self._channel is None:
            raise RuntimeError("this Stage is not open: use it by `async with Stage() as stage:`")
        if self._process != os.getpid():
            raise RuntimeError("this Stage was opened before fork(): open another one in the child process")
        if asyncio.get_running_loop() is not self._loop:
            raise RuntimeError("this Stage belongs to another event loop: open one in each loop")
        if self._closed:
            raise RuntimeError("this Stage is closed")

    def _unary(self, channel: Any, method: Method, request: Any) -> Attempt[Any]:
        self.check()
        call = channel.unary_unary(method.path, request_serializer=None, response_deserializer=method.parse)
        content = request.SerializeToString()

        async def attempt(timeout: float) -> Any:
            self.check()
            _log.debug("%s is sent", method.name)
            try:
                return await self._noted(call(content, timeout=timeout, metadata=self.target.metadata))
            except asyncio.CancelledError:
                self.explain_cancellation()
                raise
        return attempt

    def _noted(self, call: Any) -> Any:
        """Returns the call, which close() ends if it is still open."""
        self._calls.add(call)
        call.add_done_callback(self._calls.discard)
        return call

    async def _send(self, repeat: Repeat, attempt: Attempt[_T], channel: Any) -> _T:
        while True:
            try:
                return await attempt(repeat.attempt_timeout(time.monotonic()))
            except grpc.RpcError as error:
                failure = failure_of(error)
            pause = repeat.pause_after(failure, time.monotonic())
            _log.debug("failed with %s %s: %s", failure.code.name, failure.reason, failure.text)
            if repeat.error is not None or pause is None:
                raise repeat.error or AssertionError("a repeat without a pause has an error")
            await _pause(channel, failure, pause)


async def end(call: Any) -> None:
    """Cancels a call, and waits until gRPC no longer has a task for it."""
    call.cancel()
    await call.code()


async def _pause(channel: Any, failure: Failure, seconds: float) -> None:
    """Waits, at most until there is a connection if there was none. gRPC connects only while something waits for it."""
    if not failure.never_sent:
        return await asyncio.sleep(seconds)
    try:
        await asyncio.wait_for(channel.channel_ready(), seconds)
    except asyncio.TimeoutError:
        pass


def _open(target: Target) -> Any:
    credentials = target.credentials()
    if credentials is None:
        return grpc.aio.insecure_channel(target.address, options=OPTIONS)
    return grpc.aio.secure_channel(target.address, credentials, options=OPTIONS)
