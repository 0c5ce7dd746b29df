"""Streams of answers that are begun again after a broken connection."""

from __future__ import annotations

from types import TracebackType
from typing import Any, Generic, Optional, Type, TypeVar

import grpc

from axisgate._connection import Connection, pause_before_repeat
from axisgate._methods import Method
from axisgate._outcomes import Failure, error_of, failure_of
from axisgate._repeat import Backoff

_T = TypeVar("_T")
_Self = TypeVar("_Self", bound="ResumingStream[Any]")


class ResumingStream(Generic[_T]):
    """A ResumingStream is an iterator over the answers to a request. Iterate in one thread; close() may be called from
    any thread, and ends the iteration."""

    def __init__(self, connection: Connection, method: Method) -> None:
        self._connection = connection
        self._method = method
        self._backoff = Backoff()
        self._closed = False
        self._begin()

    def _request(self) -> Any:
        """Returns the request for all answers that were not received yet."""
        raise NotImplementedError

    def _take(self, answer: Any) -> _T:
        """Returns the item of an answer."""
        raise NotImplementedError

    def _skip(self, failure: Failure) -> Optional[_T]:
        """Returns the item for answers that cannot be received any more. None: the failure is another one."""
        return None

    def __iter__(self: _Self) -> _Self:
        return self

    def __next__(self) -> _T:
        while not self._closed:
            try:
                answer = next(self._call)
            except grpc.RpcError as error:
                failure = failure_of(error)
            except StopIteration:  # only a daemon of another version ends the stream without an error
                failure = Failure(grpc.StatusCode.UNAVAILABLE, "the stream has ended", None)
            else:
                self._backoff.reset()
                return self._take(answer)
            if not self._closed:
                item = self._resume(failure)
                if item is not None:
                    return item
        raise StopIteration

    def close(self) -> None:
        """Ends the iteration."""
        self._closed = True
        self._call.cancel()

    def __enter__(self: _Self) -> _Self:
        return self

    def __exit__(self, kind: Optional[Type[BaseException]], error: Optional[BaseException],
                 trace: Optional[TracebackType]) -> None:
        self.close()

    def _begin(self) -> None:
        self._call = self._connection.watch(self._method, self._request())
        self._call.initial_metadata()  # the daemon sends it once it has begun

    def _resume(self, failure: Failure) -> Optional[_T]:
        item = self._skip(failure)
        if item is None:
            if not failure.can_resume:
                raise error_of(failure, self._connection.target.address)
            pause_before_repeat(self._connection, failure, self._backoff.pause())
        self._begin()
        return item
