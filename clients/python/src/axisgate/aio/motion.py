"""Motions in the asyncio form."""

from __future__ import annotations

import logging
from types import TracebackType
from typing import TYPE_CHECKING, AsyncIterator, Awaitable, Callable, Optional, Type

from axisgate._methods import CANCEL_MOTION
from axisgate._record import MotionRecord, Progress, ProgressMeter
from axisgate.errors import AxisgateError
from axisgate.results import Result, is_over
from axisgate.v1 import motion_pb2, stage_pb2

if TYPE_CHECKING:
    from axisgate.aio._session import DeviceSession

_log = logging.getLogger("axisgate")


class Motion(MotionRecord):
    """A Motion was started, and continues whatever this program does.

    ``async with motion:`` cancels the motion if the block ends by an exception before the motion does.
    """

    def __init__(self, session: DeviceSession, message: motion_pb2.Motion) -> None:
        super().__init__(message)
        self._session = session

    @property
    def done(self) -> Awaitable[bool]:
        """True if the motion has its outcome: ``await motion.done``. Asks the daemon, if the outcome is not known."""
        return self._is_over()

    @property
    def result(self) -> Awaitable[Result]:
        """The result: ``await motion.result``. Does the same as wait(0)."""
        return self.wait(0)

    async def wait(self, timeout: Optional[float] = None) -> Result:
        """Waits for the outcome, also over broken connections and restarts of the daemon.

        Raises Stopped, MotionFailed or OutcomeUnknown unless the motion succeeds. Raises TimeoutError after `timeout`
        seconds. The motion continues then, and if the task that waits is cancelled.
        """
        await self._follow(timeout)
        return self._result(timeout)

    async def progress(self, interval: float = 0.2) -> AsyncIterator[Progress]:
        """Yields the progress every `interval` seconds until the motion has its outcome, which wait() then returns."""
        meter = ProgressMeter()
        while not is_over(await self._follow(interval)):
            yield meter.take(self._message, await self._session.read())

    async def cancel(self) -> None:
        """Stops the motion, or drops it if it has not started. Has no effect on a motion with an outcome."""
        await self._session.act(CANCEL_MOTION, stage_pb2.CancelMotionRequest(motion=self.name))

    def add_done_callback(self, function: Callable[[Motion], object]) -> None:
        """Calls `function(motion)` from a task once the motion has its outcome, or cannot be followed."""
        self._session.connection.check()

        async def run() -> None:
            try:
                await self._follow(None)
            except (AxisgateError, RuntimeError) as failure:  # wait() raises it again
                _log.debug("%s is not followed: %s", self.name, failure)
            finally:
                function(self)
        self._session.connection.tasks.start(run(), self.name)

    async def __aenter__(self) -> Motion:
        return self

    async def __aexit__(self, kind: Optional[Type[BaseException]], error: Optional[BaseException],
                        trace: Optional[TracebackType]) -> None:
        if error is not None and not is_over(self._message):
            await self._session.connection.tasks.finish(self._cancel_quietly(), "cancel")

    async def _cancel_quietly(self) -> None:
        try:
            await self.cancel()
        except (AxisgateError, RuntimeError) as failure:  # the error of the block is raised
            _log.warning("%s was not cancelled: %s", self.name, failure)

    async def _is_over(self) -> bool:
        return is_over(await self._follow(0.0))

    async def _follow(self, timeout: Optional[float]) -> motion_pb2.Motion:
        if not is_over(self._message):
            self._message = await self._session.connection.follow(self._message, timeout)
        return self._message
