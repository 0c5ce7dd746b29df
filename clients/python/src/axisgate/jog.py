"""Jogs: motion at a given speed until it is stopped."""

from __future__ import annotations

import threading
from types import TracebackType
from typing import Any, Iterator, Mapping, Optional, Type

import grpc

from axisgate._methods import JOG
from axisgate._outcomes import error_of, failure_of
from axisgate._requests import jog
from axisgate._session import DeviceSession
from axisgate.motion import Motion
from axisgate.results import Result
from axisgate.units import Speed
from axisgate.v1 import stage_pb2

EVERY_S = 0.1
"""Time between two messages in seconds. The daemon stops the axes after 0.5 s without a message."""


class Jog:
    """A Jog runs axes while its block lasts::

        with stage.jog(x=200 * um / s, y=-50 * um / s):
            time.sleep(2)

    gRPC's thread keeps the axes running. They are stopped if the program ends, or does not run for 500 ms. At the end
    of the block the axes slow down. Stopped, MotionFailed or OutcomeUnknown is raised there if something else ended the
    jog. A Jog is used by one thread.
    """

    def __init__(self, session: DeviceSession, speeds: Mapping[str, Speed]) -> None:
        self._session = session
        self._first = jog(session.device, speeds, session.token())
        self._ended = threading.Event()
        self._call: Any = None
        self._motion: Optional[Motion] = None
        self.result: Optional[Result] = None
        """Result of the jog. None while it runs."""

    @property
    def motion(self) -> Motion:
        """The motion of the jog. Raises RuntimeError before the block begins."""
        if self._motion is None:
            raise RuntimeError("use a jog by `with stage.jog(...):`")
        return self._motion

    def __enter__(self) -> Jog:
        self._call = self._session.connection.stream(JOG, self._messages())
        try:
            self._motion = Motion(self._session, next(self._call).motion)
        except grpc.RpcError as error:
            self._ended.set()
            raise error_of(failure_of(error), self._session.connection.target.address) from None
        except BaseException:
            self._end_at_once()
            raise
        return self

    def __exit__(self, kind: Optional[Type[BaseException]], error: Optional[BaseException],
                 trace: Optional[TracebackType]) -> None:
        self._ended.set()
        try:
            for _ in self._call:  # until the outcome
                pass
        except grpc.RpcError:  # the outcome says more
            pass
        except BaseException:
            self._end_at_once()
            raise
        if error is None:
            self.result = self.motion.wait()

    def _messages(self) -> Iterator[bytes]:
        yield self._first.SerializeToString()
        while not self._ended.wait(EVERY_S):
            yield stage_pb2.JogRequest().SerializeToString()

    def _end_at_once(self) -> None:
        self._ended.set()
        self._call.cancel()
