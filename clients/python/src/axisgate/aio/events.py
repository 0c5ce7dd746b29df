"""Events and states in the asyncio form."""

from __future__ import annotations

import asyncio
from types import TracebackType
from typing import Any, Generic, Optional, Type, TypeVar, Union

import grpc
import grpc.aio

from axisgate._cursor import Cursor
from axisgate._methods import LIST_DEVICES, WATCH_DEVICE, WATCH_EVENTS, Method
from axisgate._outcomes import Failure, error_of, failure_of
from axisgate._repeat import Backoff
from axisgate._requests import duration
from axisgate.aio._connection import Connection, end
from axisgate.aio._session import DeviceSession
from axisgate.events import Event, Gap, cursor_now, cursor_since, event_of
from axisgate.state import Status, status_of
from axisgate.v1 import device_pb2, event_pb2

_T = TypeVar("_T")
_Self = TypeVar("_Self", bound="ResumingStream[Any]")


class ResumingStream(Generic[_T]):
    """A ResumingStream is an asynchronous iterator over the answers to a request, also over broken connections.

    It begins with its block, or with the first item. An iteration that was cancelled can be continued. Iterate in one
    task; close() may be called in any task of the loop, and ends the iteration.
    """

    def __init__(self, connection: Connection, method: Method) -> None:
        self._connection = connection
        self._method = method
        self._backoff = Backoff()
        self._closed = False
        self._call: Any = None

    async def _request(self) -> Any:
        """Returns the request for all answers that were not received yet."""
        raise NotImplementedError

    def _take(self, answer: Any) -> _T:
        """Returns the item of an answer."""
        raise NotImplementedError

    def _skip(self, failure: Failure) -> Optional[_T]:
        """Returns the item for answers that cannot be received any more. None: the failure is another one."""
        return None

    def __aiter__(self: _Self) -> _Self:
        return self

    async def __anext__(self) -> _T:
        while not self._closed:
            failure: Optional[Failure] = None
            try:
                await self._begin()
                answer = await self._call.read()
            except grpc.RpcError as error:
                failure = failure_of(error)
            except asyncio.CancelledError:
                self._call = None
                if self._closed:
                    break
                self._connection.explain_cancellation()
                raise
            else:
                if answer is not grpc.aio.EOF:
                    self._backoff.reset()
                    return self._take(answer)
                failure = Failure(grpc.StatusCode.UNAVAILABLE, "the stream has ended", None)
            self._call = None
            if not self._closed:
                item = await self._resume(failure)
                if item is not None:
                    return item
        raise StopAsyncIteration

    async def close(self) -> None:
        """Ends the iteration."""
        self._closed = True
        if self._call is not None:
            await end(self._call)

    async def __aenter__(self: _Self) -> _Self:
        await self._begin()
        return self

    async def __aexit__(self, kind: Optional[Type[BaseException]], error: Optional[BaseException],
                        trace: Optional[TracebackType]) -> None:
        await self.close()

    async def _begin(self) -> None:
        if self._call is not None:
            return
        request = await self._request()
        self._call = self._connection.watch(self._method, request)
        await self._call.initial_metadata()  # the daemon sends it once it has begun

    async def _resume(self, failure: Failure) -> Optional[_T]:
        item = self._skip(failure)
        if item is None:
            if not failure.can_resume:
                raise error_of(failure, self._connection.target.address)
            await self._connection.pause_before_repeat(failure, self._backoff.pause())
        return item


class Events(ResumingStream[Union[Event, Gap]]):
    """Events is the iterator of Stage.events()."""

    def __init__(self, session: DeviceSession, since: Union[None, int, Event]) -> None:
        super().__init__(session.connection, WATCH_EVENTS)
        self._device = session.device
        self._cursor: Optional[Cursor] = None if since is None else cursor_since(session.device, since)

    async def _request(self) -> event_pb2.WatchRequest:
        if self._cursor is None:
            listed = await self._connection.ask(LIST_DEVICES, device_pb2.ListDevicesRequest())
            self._cursor = cursor_now(self._device, listed)
        return self._cursor.request()

    def _take(self, answer: event_pb2.WatchResponse) -> Event:
        if self._cursor is not None:
            self._cursor.take(answer.event)
        return event_of(answer.event)

    def _skip(self, failure: Failure) -> Optional[Gap]:
        resume = None if self._cursor is None else self._cursor.gap_after(failure)
        return None if resume is None else Gap(resume)


class States(ResumingStream[Status]):
    """States is the iterator of Stage.watch()."""

    def __init__(self, session: DeviceSession, min_interval: float) -> None:
        super().__init__(session.connection, WATCH_DEVICE)
        self._watch = device_pb2.WatchDeviceRequest(device=session.device, min_interval=duration(min_interval))

    async def _request(self) -> device_pb2.WatchDeviceRequest:
        return self._watch

    def _take(self, answer: device_pb2.WatchDeviceResponse) -> Status:
        return status_of(answer.device)
