"""Motions: a motion is one request to move, from its acceptance to its outcome."""

from __future__ import annotations

import logging
import threading
from types import TracebackType
from typing import TYPE_CHECKING, Callable, Iterator, Optional, Type

from axisgate._methods import CANCEL_MOTION
from axisgate._record import MotionRecord, Progress, ProgressMeter
from axisgate.errors import AxisgateError
from axisgate.results import Result, is_over
from axisgate.v1 import motion_pb2, stage_pb2

if TYPE_CHECKING:
    from axisgate._session import DeviceSession


_log = logging.getLogger("axisgate")


class Motion(MotionRecord):
    """A Motion was started, and continues whatever this program does. All functions are thread safe.

    ``with motion:`` cancels the motion if the block ends by an exception before the motion does.
    """

    def __init__(self, session: DeviceSession, message: motion_pb2.Motion) -> None:
        super().__init__(message)
        self._session = session

    @property
    def done(self) -> bool:
        """True if the motion has its outcome. Asks the daemon, if the outcome is not known yet."""
        return is_over(self._follow(0.0))

    @property
    def result(self) -> Result:
        """The result. Does the same as wait(0)."""
        return self.wait(0)

    def wait(self, timeout: Optional[float] = None) -> Result:
        """Waits for the outcome, also over broken connections and restarts of the daemon.

        Raises Stopped, MotionFailed or OutcomeUnknown unless the motion succeeds. Raises TimeoutError after `timeout`
        seconds; the motion then continues.
        """
        self._follow(timeout)
        return self._result(timeout)

    def progress(self, interval: float = 0.2) -> Iterator[Progress]:
        """Yields the progress every `interval` seconds until the motion has its outcome, which wait() then returns."""
        meter = ProgressMeter()
        while not is_over(self._follow(interval)):
            yield meter.take(self._message, self._session.read())

    def cancel(self) -> None:
        """Stops the motion, or drops it if it has not started. Has no effect on a motion with an outcome."""
        self._session.act(CANCEL_MOTION, stage_pb2.CancelMotionRequest(motion=self.name))

    def add_done_callback(self, function: Callable[[Motion], object]) -> None:
        """Calls `function(motion)` from another thread once the motion has its outcome, or cannot be followed."""
        def run() -> None:
            try:
                self._follow(None)
            finally:
                function(self)
        threading.Thread(target=run, name=f"axisgate {self.name}", daemon=True).start()

    def __enter__(self) -> Motion:
        return self

    def __exit__(self, kind: Optional[Type[BaseException]], error: Optional[BaseException],
                 trace: Optional[TracebackType]) -> None:
        if error is None or is_over(self._message):
            return
        try:
            self.cancel()
        except AxisgateError as failure:  # the error of the block is raised
            _log.warning("%s was not cancelled: %s", self.name, failure)

    def _follow(self, timeout: Optional[float]) -> motion_pb2.Motion:
        if not is_over(self._message):
            self._message = self._session.connection.follow(self._message, timeout)
        return self._message

