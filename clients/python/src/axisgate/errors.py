"""The exceptions of this package.

Every exception says what happened, and with `hint` what helps. `Refused` means that nothing moved.
"""

from __future__ import annotations

from typing import Optional


class AxisgateError(Exception):
    """Base of all errors that the daemon reports, or that the connection to it causes.

    `reason` is stable, such as "OUTSIDE_TRAVEL"; a reason that this package does not know is "REASON 99". `message` is
    one sentence, and `hint` advice, which may be empty. `axis` is the number of the axis, or None. `sent` and
    `wire_reply` are the command line and the controller's reply, which may be empty. `code` is the name of the gRPC
    code, or empty if the error is not the answer to a call.
    """

    def __init__(self, reason: str, message: str, hint: str = "", *, axis: Optional[int] = None, sent: str = "",
                 wire_reply: str = "", code: str = "") -> None:
        super().__init__(reason, message, hint)
        self.reason = reason
        self.message = message
        self.hint = hint
        self.axis = axis
        self.sent = sent
        self.wire_reply = wire_reply
        self.code = code

    def __str__(self) -> str:
        return f"{self.reason}: {self.message}" + (f" ({self.hint})" if self.hint else "")


class Refused(AxisgateError):
    """The request was refused: nothing moved."""


class OutsideTravel(Refused):
    """The target is outside the travel limits of the axis."""


class NotHomed(Refused):
    """The axis must be homed before any other motion."""


class LeaseHeld(Refused):
    """Somebody else holds the axes, or moves them."""


class LeaseLost(Refused):
    """The lease of this program has ended."""


class StoppedBy(Refused):
    """Somebody else stopped the axes. This program must call `Stage.rearm` before it moves them again."""


class NotAllowed(Refused):
    """The daemon does not know this caller, or the caller's role does not allow the request."""


class Unavailable(Refused):
    """The daemon or the controller cannot be reached."""


class Stopped(AxisgateError):
    """A stop ended the motion, or prevented it."""


class MotionFailed(AxisgateError):
    """The motion ended with an error."""


class OutcomeUnknown(AxisgateError):
    """The outcome of the request is unknown. The axes may be moving: look at the stage before you repeat it."""
