"""The controller's own commands."""

from __future__ import annotations

import uuid
from dataclasses import dataclass
from typing import List, Optional, Sequence

import grpc

from axisgate._methods import EXECUTE
from axisgate._outcomes import Failure, error_of, error_of_problem, failure_of
from axisgate._requests import duration
from axisgate._session import DeviceSession
from axisgate.errors import AxisgateError, MotionFailed, OutcomeUnknown, Refused, Unavailable
from axisgate.motion import Motion
from axisgate.v1 import command_pb2, common_pb2, motion_pb2

_ANSWER_S = 5.0


@dataclass(frozen=True)
class Executed:
    """Answers of the controller to lines, and the motion that they started, which may continue. None: no motion."""

    answers: Sequence[str]
    motion: Optional[Motion]


def execute(session: DeviceSession, lines: Sequence[str], timeout: float) -> Executed:
    """Sends lines, once. See Stage.execute()."""
    request = command_pb2.ExecuteRequest(device=session.device, lines=lines, timeout=duration(timeout), context=(
        common_pb2.CallContext(request_id=str(uuid.uuid4()), lease_token=session.token())))
    answers: List[str] = []
    motion = ""
    try:
        for change in session.connection.watch(EXECUTE, request, timeout + _ANSWER_S):
            motion = motion or change.motion
            if change.HasField("reply"):
                answers.append(change.reply.answer)
    except grpc.RpcError as error:
        raise _error_of(failure_of(error), bool(motion), session.connection.target.address) from None
    started = motion_pb2.Motion(name=motion, request_id=request.context.request_id)
    return Executed(answers, Motion(session, started) if motion else None)


def _error_of(failure: Failure, moves: bool, target: str) -> AxisgateError:
    """Returns the exception. It is not Refused, which means that nothing moved, if lines were sent that may move."""
    error = error_of(failure, target)
    if not moves or failure.problem is None or not isinstance(error, Refused):
        return error
    uncertain = isinstance(error, Unavailable) or error.reason == "DEADLINE_PASSED"
    return error_of_problem(failure.problem, error.code, OutcomeUnknown if uncertain else MotionFailed)
