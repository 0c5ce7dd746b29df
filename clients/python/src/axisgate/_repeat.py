"""The policy by which a request is sent again, as a state machine without a clock or a connection."""

from __future__ import annotations

from typing import Optional, Tuple

from axisgate._outcomes import Failure, error_of, unavailable
from axisgate._requests import clock_ahead, new_context
from axisgate._target import Target
from axisgate.errors import AxisgateError, OutcomeUnknown
from axisgate.v1 import common_pb2, device_pb2

FIRST_PAUSE_S = 0.25
LONGEST_PAUSE_S = 5.0


class Backoff:
    """A Backoff is a series of pauses, each twice as long as the previous one."""

    def __init__(self) -> None:
        self._next = FIRST_PAUSE_S

    def pause(self) -> float:
        """Returns the next pause in seconds."""
        pause = self._next
        self._next = min(2 * pause, LONGEST_PAUSE_S)
        return pause

    def reset(self) -> None:
        """Begins with the shortest pause again."""
        self._next = FIRST_PAUSE_S


class Repeat:
    """A Repeat decides after each failed attempt whether the same request is sent again.

    `until` is the latest time of an attempt, on the clock of the caller, and `answer_s` the time for its answer.
    `acts` is False for a question, which may always be repeated. `remembered` is False if the daemon does not remember
    requests: a request that acts is then not repeated once it may have reached the daemon.
    """

    def __init__(self, until: float, target: str, answer_s: float, *, acts: bool = True,
                 remembered: bool = True) -> None:
        self.until = until
        self._target = target
        self._answer_s = answer_s
        self._acts = acts
        self._remembered = remembered
        self._backoff = Backoff()
        self._may_have_acted = False
        self.error: Optional[AxisgateError] = None

    def attempt_timeout(self, now: float) -> float:
        """Returns the deadline of the attempt that is sent now, in seconds."""
        return max(self.until - now, 0.0) + self._answer_s

    def pause_after(self, failure: Failure, now: float) -> Optional[float]:
        """Returns the time after which the same request is sent again. None: not again; `error` is then set."""
        self._may_have_acted |= self._acts and failure.lost and not failure.never_sent
        if self._may_be_repeated(failure):
            pause = min(self._backoff.pause(), self.until - now)
            if pause > 0:
                return pause
        self.error = self._error_of(failure)
        return None

    def _may_be_repeated(self, failure: Failure) -> bool:
        if self._may_have_acted and not self._remembered:
            return False
        return failure.passing or (self._may_have_acted and failure.reason == "QUEUE_FULL")

    def _error_of(self, failure: Failure) -> AxisgateError:
        if not self._acts and failure.lost:
            return unavailable(failure, self._target)
        error = error_of(failure, self._target)
        if not self._may_have_acted or failure.decides_repeat or isinstance(error, OutcomeUnknown):
            return error
        unknown = OutcomeUnknown("OUTCOME_UNKNOWN", "the answer to the request was lost, and a repeat was refused: "
                                 f"{error.message}", "look at the stage before you repeat the request",
                                 code=error.code)
        unknown.__cause__ = error
        return unknown


def for_action(listed: device_pb2.ListDevicesResponse, target: Target, lease_token: bytes, patience_s: float,
               answer_s: float, now: float) -> Tuple[common_pb2.CallContext, Repeat]:
    """Returns the context of a request that acts, and the policy of its repeats. `listed` was received just now."""
    memory = listed.request_memory if listed.requests_kept else ""
    ahead_s = 0.0 if target.is_local else clock_ahead(listed)
    context = new_context(memory, lease_token, ahead_s, patience_s)
    return context, Repeat(now + patience_s, target.address, answer_s, remembered=bool(memory))
