"""Paths, and series of points."""

from __future__ import annotations

from typing import Any, Callable, Iterable, List, Optional, Sequence, Union

from axisgate import _requests
from axisgate._methods import RUN_PATH
from axisgate._session import DeviceSession
from axisgate.motion import Motion
from axisgate.points import Arc
from axisgate.units import Speed
from axisgate.v1 import common_pb2, motion_pb2, stage_pb2

# Segments that are sent in a second at the least; the time for them is added to the limit of the request.
_SEGMENTS_PER_S = 2000


def start(session: DeviceSession, points: Iterable[Union[Arc, Iterable[object]]], axes: Sequence[str],
          speed: Optional[Speed]) -> Motion:
    """Starts a path. See Stage.path()."""
    segments = segments_of(points, axes, speed)

    def attempt_with(context: common_pb2.CallContext) -> Callable[[float], motion_pb2.Motion]:
        messages = _requests.path(session.device, context, segments)
        return lambda timeout: _started(session.connection.stream(RUN_PATH, messages, timeout))
    return Motion(session, session.connection.act_by(attempt_with, session.token(), patience(segments)))


def segments_of(points: Iterable[Union[Arc, Iterable[object]]], axes: Sequence[str],
                speed: Optional[Speed]) -> List[stage_pb2.Segment]:
    """Returns the segments of a path. Reads all points, and raises what they raise."""
    return [_requests.segment(axes, point, speed) for point in points]


def patience(segments: List[stage_pb2.Segment]) -> float:
    """Returns the time in seconds for which the segments may be sent."""
    return len(segments) / _SEGMENTS_PER_S


def _started(answers: Any) -> motion_pb2.Motion:
    """Returns the motion once it has started. The path continues without the call."""
    for answer in answers:
        if answer.HasField("motion"):
            answers.cancel()
            motion: motion_pb2.Motion = answer.motion
            return motion
    raise AssertionError("the daemon ended a path without its motion")
