"""Axes as devices of ophyd-async::

    from bluesky import RunEngine, plans
    from ophyd_async.core import init_devices
    from axisgate.ophyd_async import StageAxis, StageConnection

    engine = RunEngine()
    with init_devices():
        connection = StageConnection()
        x = StageAxis(connection, "x")
    engine(plans.scan([detector], x, 0, 1.5, 16))

Positions are bare numbers in the unit of the axis (`describe` names it), rounded to the nearest pulse. A refused motion
and a motion that ends without success fail its status. Needs ophyd-async 0.21, which needs Python 3.11.
"""

from __future__ import annotations

import asyncio
import time
from typing import Any, AsyncIterator, Awaitable, Callable, Dict, List, Optional, Union

from bluesky.protocols import Checkable, Locatable, Location, Stoppable, Subscribable
from ophyd_async.core import (CALCULATE_TIMEOUT, AsyncStatus, SignalR, StandardReadable, StandardReadableFormat,
                              WatchableAsyncStatus, WatcherUpdate, set_mock_value)

from axisgate._methods import MOVE
from axisgate._ophyd_signal import PositionBackend, StageConnection
from axisgate._requests import move
from axisgate.aio import Axis, Lease, Motion
from axisgate.errors import Stopped

__all__ = ["StageAxis", "StageConnection"]

_UPDATE_EVERY_S = 0.1
_MOCK_STEPS = 5
_MOCK_STEP_S = 0.01


class StageAxis(StandardReadable, Locatable[float], Checkable[float], Stoppable, Subscribable[float]):
    """A StageAxis is an axis as a device of ophyd-async, for `scan`, `mv` and other plans.

    `stage`, which the plans of bluesky call, acquires a lease of the axis. `lease` is the lease that a program has
    already, or False: the axis moves without one. Connected with `mock=True`, it moves without a daemon.
    """

    def __init__(self, connection: StageConnection, axis: Union[str, int], name: str = "", *,
                 lease: Union[bool, Lease] = True) -> None:
        self._backend = PositionBackend(connection, axis)
        self._connection = connection
        self._lease = lease
        self._own_lease: Optional[Lease] = None
        self._moves: List[_Move] = []
        self.position = SignalR(self._backend)
        self.add_readables([self.position], StandardReadableFormat.HINTED_UNCACHED_SIGNAL)
        super().__init__(name=name)

    def set_name(self, name: str, *, child_name_separator: Optional[str] = None) -> None:
        """Names the device, and its value."""
        super().set_name(name, child_name_separator=child_name_separator)
        self.position.set_name(name)

    def set(self, value: float, timeout: Any = CALCULATE_TIMEOUT) -> WatchableAsyncStatus[float]:
        """Starts a move to a position. The motion is cancelled after `timeout` seconds; the default is no limit.

        The status fails with Refused, Stopped, MotionFailed, OutcomeUnknown or TimeoutError. A cancelled status cancels
        the motion.
        """
        one = _Move(float(value), None if timeout == CALCULATE_TIMEOUT else timeout)
        self._moves.append(one)  # before the status has its first turn, so that no stop misses the move
        status = self._mock_move(one) if self._mock else self._move(one)
        status.task.add_done_callback(lambda _: self._end(one))
        return status

    async def stop(self, success: bool = False) -> None:
        """Stops the axis if a motion of this device is in progress, and no motion of anybody else.

        bluesky calls it for a pause, and for each device at the end of a plan. With `success`, the status of the motion
        ends with success. Returns when the axis was seen stationary, or after 4 s.
        """
        moves = list(self._moves)
        for one in moves:
            one.expect_stop(success)
        if not moves or self._mock:
            return
        for one in moves:
            await one.settled.wait()
        if any(one.motion is not None for one in moves):
            await self._with_lease(self._axis.stop)

    async def check_value(self, value: float) -> None:
        """Checks a move as far as possible without moving. Raises Refused if it would be refused."""
        if self._mock:
            return
        session = self._connection.stage._session
        request = move(session.device, {str(self._axis.number): float(value) * self._axis.unit}, relative=False,
                       validate_only=True)
        await self._with_lease(lambda: session.act(MOVE, request))

    async def locate(self) -> Location[float]:
        """Returns the requested position and the present position.

        Both are the present position unless a motion of this device is in progress: relative plans begin there.
        """
        readback = await self.position.get_value(cached=False)
        return Location(setpoint=self._moves[-1].target if self._moves else readback, readback=readback)

    def subscribe_reading(self, function: Callable[[Dict[str, Any]], None]) -> None:
        """Calls `function` with the reading, now and after every change of the state."""
        self.position.subscribe_reading(function)

    subscribe = subscribe_reading

    def clear_sub(self, function: Callable[[Dict[str, Any]], None]) -> None:
        """Ends subscribe_reading()."""
        self.position.clear_sub(function)

    @AsyncStatus.wrap
    async def stage(self) -> None:
        """Acquires a lease, unless the device has one or needs none. Fails with LeaseHeld if the axis is not free."""
        if self._own_lease is not None:
            raise RuntimeError(f"{self.name} is staged already")
        if self._lease is True and not self._mock and not self._connection.stage._session.token():
            lease = self._connection.stage.lease(self._axis.name, purpose=f"bluesky: {self.name}")
            self._own_lease = await lease.acquire()

    @AsyncStatus.wrap
    async def unstage(self) -> None:
        """Stops a motion of this device that is still in progress, and releases the lease of stage()."""
        try:
            await self.stop(success=True)
        finally:
            lease, self._own_lease = self._own_lease, None
            if lease is not None:
                await lease.release()

    @property
    def _axis(self) -> Axis:
        return self._backend.axis

    def _end(self, one: _Move) -> None:
        self._moves.remove(one)
        one.settled.set()  # a status that is cancelled before its first turn has started nothing

    @WatchableAsyncStatus.wrap
    async def _move(self, one: _Move) -> AsyncIterator[WatcherUpdate[float]]:
        try:
            motion = await self._started(one)
            async with motion:
                initial: Optional[float] = None
                async for progress in motion.progress(_UPDATE_EVERY_S):
                    one.check_timeout(self.name)
                    position = progress.positions.get(self._axis.name)
                    if position is not None and position.value is not None:
                        current = float(position.value)
                        initial = current if initial is None else initial
                        yield WatcherUpdate(current, initial, one.target, self.name, str(self._axis.unit),
                                            fraction=progress.fraction)
                await motion.wait()
        except Stopped:
            if not one.stop_succeeds:
                raise

    @WatchableAsyncStatus.wrap
    async def _mock_move(self, one: _Move) -> AsyncIterator[WatcherUpdate[float]]:
        initial = await self.position.get_value(cached=False)
        for step in range(1, _MOCK_STEPS + 1):
            await asyncio.sleep(_MOCK_STEP_S)
            one.check_timeout(self.name)
            if one.stop_succeeds is not None:
                break
            current = initial + (one.target - initial) * step / _MOCK_STEPS if step < _MOCK_STEPS else one.target
            set_mock_value(self.position, current)
            yield WatcherUpdate(current, initial, one.target, self.name, fraction=step / _MOCK_STEPS)
        if one.stop_succeeds is False:
            raise Stopped("STOPPED", f"{self.name} was stopped")

    async def _started(self, one: _Move) -> Motion:
        """Starts the move. If the status is cancelled meanwhile, waits for the answer and cancels the motion."""
        starting = asyncio.ensure_future(self._with_lease(lambda: self._axis.start(one.target * self._axis.unit)))
        try:
            motion: Motion = await asyncio.shield(starting)
            one.motion = motion
            return motion
        except asyncio.CancelledError:
            await asyncio.wait([starting])
            if not starting.cancelled() and starting.exception() is None:
                async with starting.result():
                    raise
            raise
        finally:
            one.settled.set()

    async def _with_lease(self, call: Callable[[], Awaitable[Any]]) -> Any:
        """Makes the calls of `call` carry the lease. bluesky calls from tasks of its own."""
        lease = self._own_lease or (self._lease if isinstance(self._lease, Lease) else None)
        with self._connection.stage._session.carrying(b"" if lease is None else lease.token):
            return await call()


class _Move:
    """A _Move is a call of set() whose status has not ended."""

    def __init__(self, target: float, timeout: Optional[float]) -> None:
        self.target = target
        self.motion: Optional[Motion] = None
        """The motion. None if it has not started, or was refused."""
        self.settled = asyncio.Event()
        """Set once the answer to the request to move has arrived."""
        self.stop_succeeds: Optional[bool] = None
        """How a stop ends the status. None: no stop of this device."""
        self._timeout = timeout
        self._begun = time.monotonic()

    def expect_stop(self, success: bool) -> None:
        """Decides whether a stop counts as success from now on."""
        self.stop_succeeds = success

    def check_timeout(self, device: str) -> None:
        """Raises TimeoutError if the time is over."""
        if self._timeout is not None and time.monotonic() - self._begun > self._timeout:
            raise asyncio.TimeoutError(f"{device} has not arrived after {self._timeout} s")
