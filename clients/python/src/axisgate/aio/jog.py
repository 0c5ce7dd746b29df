"""Jogs in the asyncio form."""

from __future__ import annotations

import asyncio
from types import TracebackType
from typing import Any, AsyncIterator, Mapping, Optional, Type

import grpc
import grpc.aio

from axisgate._methods import JOG
from axisgate._outcomes import error_of, failure_of
from axisgate._requests import jog
from axisgate.aio._session import DeviceSession
from axisgate.aio.motion import Motion
from axisgate.jog import EVERY_S
from axisgate.results import Result
from axisgate.units import Speed
from axisgate.v1 import stage_pb2


class Jog:
    """A Jog runs axes while its block lasts::

        async with stage.jog(x=200 * um / s, y=-50 * um / s):
            await asyncio.sleep(2)

    The axes are stopped if the program ends, or if its event loop does not run for 500 ms. At the end of the block the
    axes slow down. Stopped, MotionFailed or OutcomeUnknown is raised there if something else ended the jog.
    """

    def __init__(self, session: DeviceSession, speeds: Mapping[str, Speed]) -> None:
        self._session = session
        self._speeds = speeds
        self._call: Any = None
        self._motion: Optional[Motion] = None
        self.result: Optional[Result] = None
        """Result of the jog. None while it runs."""

    @property
    def motion(self) -> Motion:
        """The motion of the jog. Raises RuntimeError before the block begins."""
        if self._motion is None:
            raise RuntimeError("use a jog by `async with stage.jog(...):`")
        return self._motion

    async def __aenter__(self) -> Jog:
        first = jog(self._session.device, self._speeds, self._session.token())
        self._ended = asyncio.Event()
        self._call = self._session.connection.stream(JOG, self._messages(first))
        try:
            answer = await self._call.read()
        except grpc.RpcError as error:
            self._ended.set()
            raise error_of(failure_of(error), self._session.connection.target.address) from None
        except BaseException:
            self._end_at_once()
            raise
        if answer is grpc.aio.EOF:
            raise AssertionError("the daemon ended a jog without its motion")
        self._motion = Motion(self._session, answer.motion)
        return self

    async def __aexit__(self, kind: Optional[Type[BaseException]], error: Optional[BaseException],
                        trace: Optional[TracebackType]) -> None:
        self._ended.set()
        try:
            while await self._call.read() is not grpc.aio.EOF:  # until the outcome
                pass
        except grpc.RpcError:  # the outcome says more
            pass
        except BaseException:
            self._end_at_once()
            raise
        if error is None:
            self.result = await self.motion.wait()

    async def _messages(self, first: stage_pb2.JogRequest) -> AsyncIterator[bytes]:
        yield first.SerializeToString()
        while not await self._is_ended():
            yield stage_pb2.JogRequest().SerializeToString()

    async def _is_ended(self) -> bool:
        """Returns True once the block has ended, and False if it lasts longer than the time between two messages."""
        try:
            await asyncio.wait_for(self._ended.wait(), EVERY_S)
        except asyncio.TimeoutError:
            return False
        return True

    def _end_at_once(self) -> None:
        self._ended.set()
        self._call.cancel()
