"""Failed calls and problems, as values and as exceptions. Nothing here waits or sends."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Dict, FrozenSet, Optional, Type, TypeVar

import grpc
from google.protobuf.message import DecodeError

from axisgate import _status_pb2
from axisgate._hints import with_methods
from axisgate.errors import (AxisgateError, LeaseHeld, LeaseLost, MotionFailed, NotAllowed, NotHomed, OutcomeUnknown,
                             OutsideTravel, Refused, Stopped, StoppedBy, Unavailable)
from axisgate.v1 import common_pb2

_T = TypeVar("_T")
_DETAILS = "grpc-status-details-bin"

# Start of gRPC's text for a call that never had a connection. Texts that differ only make an outcome unknown.
_NEVER_CONNECTED = "failed to connect to all addresses"

_CLASSES: Dict[str, Type[AxisgateError]] = {
    "OUTSIDE_TRAVEL": OutsideTravel,
    "NOT_HOMED": NotHomed,
    "LEASE_HELD": LeaseHeld,
    "LEASE_LOST": LeaseLost,
    "STOPPED_BY": StoppedBy,
    "NOT_ALLOWED": NotAllowed,
    "UNAUTHENTICATED": NotAllowed,
    "LINK_DOWN": Unavailable,
    "NOT_SENT": Unavailable,
    "REPLY_TIMED_OUT": Unavailable,
    "LINE_FAULT": Unavailable,
    "COMPLETION_OUTSTANDING": Unavailable,
    "JOURNAL_UNAVAILABLE": Unavailable,
    "DAEMON_ENDING": Unavailable,
    "STOPPED": Stopped,
    "TARGET_NOT_REACHED": MotionFailed,
    "OUTCOME_UNKNOWN": OutcomeUnknown,
    "REQUEST_MEMORY_LOST": OutcomeUnknown,
}

# Reasons that the daemon may give before it compares the request's id with earlier requests.
_BEFORE_MEMORY: FrozenSet[str] = frozenset({
    "INVALID_REQUEST", "UNKNOWN_DEVICE", "UNKNOWN_AXIS", "QUEUE_FULL", "NOT_ALLOWED", "UNAUTHENTICATED", "LEASE_LOST",
    "INTERNAL", "REQUEST_ID_REUSED"})

# Codes of calls that the daemon refuses before it can send a problem. RESOURCE_EXHAUSTED is none of them: gRPC also
# reports it for an answer that is too long, after the request has acted.
_EARLY = {
    grpc.StatusCode.UNAUTHENTICATED: "UNAUTHENTICATED",
    grpc.StatusCode.PERMISSION_DENIED: "NOT_ALLOWED",
    grpc.StatusCode.UNIMPLEMENTED: "UNIMPLEMENTED",
}


@dataclass(frozen=True)
class Failure:
    """A Failure is a call that ended without an answer. `problem` is None if the daemon did not report one."""

    code: grpc.StatusCode
    text: str
    problem: Optional[common_pb2.Problem]

    @property
    def reason(self) -> str:
        """Name of the reason, or empty without a problem."""
        return reason_name(self.problem.reason) if self.problem is not None else _EARLY.get(self.code, "")

    @property
    def lost(self) -> bool:
        """True if the answer was lost: the request may have acted."""
        return self.problem is None and self.code not in _EARLY

    @property
    def never_sent(self) -> bool:
        """True if there was no connection, so the request cannot have acted."""
        return self.lost and self.text.startswith(_NEVER_CONNECTED)

    @property
    def passing(self) -> bool:
        """True if the same request may succeed a moment later."""
        return self.lost or self.code is grpc.StatusCode.UNAVAILABLE

    @property
    def can_resume(self) -> bool:
        """True if a call that waits or watches is begun again."""
        return self.passing or self.reason == "QUEUE_FULL"

    @property
    def decides_repeat(self) -> bool:
        """True if this refusal of a repeated request means that the first request did not act either."""
        return not self.passing and self.reason not in _BEFORE_MEMORY


def reason_name(number: int) -> str:
    """Returns "OUTSIDE_TRAVEL" for a reason's number, and "REASON 99" for a number of a newer daemon."""
    value = common_pb2.Reason.DESCRIPTOR.values_by_number.get(number)
    return str(value.name)[len("REASON_"):] if value is not None else f"REASON {number}"


def failure_of(error: Any) -> Failure:
    """Returns the failure that a `grpc.RpcError` reports."""
    metadata = error.trailing_metadata() or ()
    problem = next((_problem_in(value) for key, value in metadata if key == _DETAILS), None)
    return Failure(error.code(), error.details() or "", problem)


def _problem_in(details: bytes) -> Optional[common_pb2.Problem]:
    status = _status_pb2.Status()
    try:
        status.ParseFromString(details)
        for detail in status.details:
            problem = common_pb2.Problem()
            if detail.Unpack(problem):
                return problem
    except DecodeError:  # not the daemon's
        pass
    return None


def error_of(failure: Failure, target: str) -> AxisgateError:
    """Returns the exception for a call that failed and is not repeated. `target` is the daemon's address."""
    if failure.problem is not None:
        return error_of_problem(failure.problem, failure.code.name)
    if not failure.lost:
        early: Type[AxisgateError] = _CLASSES.get(failure.reason, Refused)
        return early(failure.reason, failure.text, code=failure.code.name)
    if failure.never_sent:
        return unavailable(failure, target)
    return OutcomeUnknown("OUTCOME_UNKNOWN", f"the answer of the daemon at {target} was lost: {failure.text}",
                          "look at the stage before you repeat the request", code=failure.code.name)


def unavailable(failure: Failure, target: str) -> Unavailable:
    """Returns the exception for a request that acted nowhere because the daemon did not answer."""
    return Unavailable("UNAVAILABLE", f"no daemon answers at {target}: {failure.text}",
                       "start axisgated, or set AXISGATE_TARGET to its address", code=failure.code.name)


def undelivered_stop(error: Unavailable) -> OutcomeUnknown:
    """Returns the exception for a stop that reached no daemon. It is not Refused: the axes may be moving."""
    return OutcomeUnknown(error.reason, f"the stop was not delivered: {error.message}",
                          "press the emergency stop at the device", code=error.code)


def error_of_problem(problem: common_pb2.Problem, code: str = "",
                     kind: Optional[Type[AxisgateError]] = None) -> AxisgateError:
    """Returns the exception for a problem, of the class `kind`, or of the class for its reason."""
    reason = reason_name(problem.reason)
    axis = problem.axis if problem.HasField("axis") else None
    hint = with_methods(problem.hint, "" if axis is None else str(axis))
    chosen = _CLASSES.get(reason, Refused) if kind is None else kind
    return chosen(reason, problem.message, hint, axis=axis, sent=problem.sent, wire_reply=problem.wire_reply, code=code)


def own(answer: _T, request_id: str) -> _T:
    """Returns the answer to the request with this id. Raises OutcomeUnknown if its motion is that of another request."""
    motion: Any = getattr(answer, "motion", answer)
    if getattr(motion, "name", "") and getattr(motion, "request_id", request_id) != request_id:
        raise OutcomeUnknown("OUTCOME_UNKNOWN", f"the daemon answered with {motion.name}, which another request started",
                             "look at the stage before you repeat the request")
    return answer
