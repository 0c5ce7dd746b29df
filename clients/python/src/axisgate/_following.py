"""The policy by which a motion is followed to its outcome, as a state machine without a clock or a connection."""

from __future__ import annotations

from typing import Optional, Tuple

from axisgate._outcomes import Failure, error_of
from axisgate._repeat import Backoff
from axisgate._requests import duration
from axisgate.errors import AxisgateError, OutcomeUnknown
from axisgate.v1 import motion_pb2, stage_pb2

LOST_LIMIT_S = 60.0
"""Time without an answer after which the outcome of a motion counts as unknown."""
_WAIT_S = 10.0
_ANSWER_S = 5.0


class Following:
    """A Following asks for the outcome of one motion, also over broken connections and restarts of the daemon."""

    def __init__(self, motion: motion_pb2.Motion, target: str, now: float) -> None:
        self._motion = motion
        self._target = target
        self._answered = now
        self._backoff = Backoff()
        self.error: Optional[AxisgateError] = None

    def question(self, wait_s: float) -> Tuple[stage_pb2.WaitMotionRequest, float]:
        """Returns the next request, which waits at most `wait_s`, and its deadline in seconds."""
        wait = max(min(wait_s, _WAIT_S), 0.0)
        request = stage_pb2.WaitMotionRequest(motion=self._motion.name, max_wait=duration(wait))
        return request, wait + _ANSWER_S

    def take(self, motion: motion_pb2.Motion, now: float) -> bool:
        """Takes an answer. Returns False if it is about another motion; `error` is then set.

        A daemon without a journal gives the names of motions again after a restart.
        """
        self._answered = now
        self._backoff.reset()
        if motion.request_id == self._motion.request_id:
            return True
        self.error = self._unknown("the daemon was restarted, and no longer has the motion")
        return False

    def pause_after(self, failure: Failure, now: float) -> Optional[float]:
        """Returns the time after which the daemon is asked again. None: never; `error` is then set."""
        if not failure.can_resume:
            self.error = self._unknown("its outcome cannot be read")
            self.error.__cause__ = error_of(failure, self._target)
            return None
        if now - self._answered > LOST_LIMIT_S:
            self.error = self._unknown(f"the daemon has not answered for {LOST_LIMIT_S:.0f} s")
            return None
        return self._backoff.pause()

    def _unknown(self, why: str) -> OutcomeUnknown:
        return OutcomeUnknown("OUTCOME_UNKNOWN", f"the outcome of {self._motion.name} is unknown: {why}",
                              "look at the stage before you repeat the motion")
