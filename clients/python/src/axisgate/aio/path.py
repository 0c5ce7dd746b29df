"""Paths in the asyncio form."""

from __future__ import annotations

from typing import Any, Iterable, Optional, Sequence, Union

import grpc.aio

from axisgate import _requests
from axisgate._methods import RUN_PATH
from axisgate.aio._connection import Attempt, end
from axisgate.aio._session import DeviceSession
from axisgate.aio.motion import Motion
from axisgate.path import patience, segments_of
from axisgate.points import Arc
from axisgate.units import Speed
from axisgate.v1 import common_pb2, motion_pb2


async def start(session: DeviceSession, points: Iterable[Union[Arc, Iterable[object]]], axes: Sequence[str],
                speed: Optional[Speed]) -> Motion:
    """Starts a path. See Stage.path()."""
    segments = segments_of(points, axes, speed)

    def attempt_with(context: common_pb2.CallContext) -> Attempt[motion_pb2.Motion]:
        messages = _requests.path(session.device, context, segments)

        async def attempt(timeout: float) -> motion_pb2.Motion:
            return await _started(session.connection.stream(RUN_PATH, messages, timeout))
        return attempt
    return Motion(session, await session.connection.act_by(attempt_with, session.token(), patience(segments)))


async def _started(call: Any) -> motion_pb2.Motion:
    """Returns the motion once it has started. The path continues without the call."""
    while True:
        answer = await call.read()
        if answer is grpc.aio.EOF:
            raise AssertionError("the daemon ended a path without its motion")
        if answer.HasField("motion"):
            await end(call)
            motion: motion_pb2.Motion = answer.motion
            return motion
