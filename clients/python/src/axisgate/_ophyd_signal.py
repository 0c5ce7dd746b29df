"""The connection to a stage, and the position of an axis as a signal of ophyd-async."""

from __future__ import annotations

import asyncio
import logging
import time
from typing import Any, Callable, Optional, Union

from bluesky.protocols import Reading
from event_model import DataKey
from ophyd_async.core import NotConnectedError, SignalBackend

from axisgate._readings import AxisReading, data_key, has_position, reading_of
from axisgate.aio import Axis, Stage, States
from axisgate.errors import AxisgateError, Unavailable

_log = logging.getLogger("axisgate")
_CONNECT_EVERY_S = 0.5


class StageConnection:
    """A StageConnection is the connection to a stage that some devices share.

    The arguments are those of axisgate.Stage. The first device that connects opens it, in the loop of the RunEngine, to
    which it belongs from then on. close() ends it.
    """

    def __init__(self, target: Optional[str] = None, **arguments: Any) -> None:
        """Does not connect yet. Raises ValueError if the arguments contradict each other."""
        self._new_stage: Callable[[], Stage] = lambda: Stage(target, **arguments)
        self._new_stage()  # checks the arguments
        self._stage: Optional[Stage] = None
        self._lock = asyncio.Lock()

    @property
    def stage(self) -> Stage:
        """The stage, for calls in the loop of the RunEngine. Raises RuntimeError unless connected."""
        if self._stage is None:
            raise RuntimeError("the stage is not connected: connect its devices first, as by `init_devices`")
        return self._stage

    async def open(self, timeout: float, instead_of: Optional[Stage] = None) -> Stage:
        """Returns the stage, which is connected anew if it is `instead_of`.

        Raises NotConnectedError if the daemon does not answer within `timeout` seconds, or has no such stage.
        """
        async with self._lock:
            if self._stage is not None and self._stage is instead_of:
                await self._close()
            if self._stage is None:
                self._stage = await self._connected(time.monotonic() + timeout)
            return self._stage

    async def close(self) -> None:
        """Closes the connection. Motions continue."""
        async with self._lock:
            await self._close()

    async def _close(self) -> None:
        stage, self._stage = self._stage, None
        if stage is not None:
            await stage.close()

    async def _connected(self, end: float) -> Stage:
        while True:
            left = end - time.monotonic()
            try:
                return await asyncio.wait_for(self._new_stage().connect(), max(left, 0.0))
            except asyncio.TimeoutError:
                raise NotConnectedError("no answer from the daemon") from None
            except Unavailable as error:
                if left < _CONNECT_EVERY_S:
                    raise NotConnectedError(str(error)) from error
                await asyncio.sleep(_CONNECT_EVERY_S)
            except (AxisgateError, LookupError) as error:
                raise NotConnectedError(str(error)) from error


class PositionBackend(SignalBackend[float]):
    """A PositionBackend reads the position of an axis, in the unit of the axis."""

    def __init__(self, connection: StageConnection, axis: Union[str, int]) -> None:
        super().__init__(float)
        self._connection = connection
        self._axis = axis
        self._used: Optional[Stage] = None
        self._states: Optional[States] = None
        self._task: Optional[asyncio.Task[None]] = None

    @property
    def axis(self) -> Axis:
        """The axis. Raises RuntimeError unless connected."""
        return self._connection.stage[self._axis]

    def source(self, name: str, read: bool) -> str:
        """Returns the source of the values."""
        if self._used is None:
            return f"axisgate:{self._axis}"
        return f"axisgate:{self._used.name}/{self._used[self._axis].name}"

    async def connect(self, timeout: float) -> None:
        """Connects the stage. Connects it anew if it was connected for this axis before."""
        stage = await self._connection.open(timeout, self._used)
        try:
            await self.get_reading()
        except KeyError as error:
            raise NotConnectedError(f"there is no axis {error.args[0]}") from error
        except (AxisgateError, RuntimeError) as error:
            raise NotConnectedError(str(error)) from error
        self._used = stage

    async def get_reading(self) -> Reading[float]:
        """Reads the position from the controller."""
        return _document(reading_of(await self._connection.stage.status(max_age=0.0), self.axis))

    async def get_value(self) -> float:
        """Reads the position from the controller."""
        return float((await self.get_reading())["value"])

    async def get_setpoint(self) -> float:
        """Returns the position: the signal has no setpoint."""
        return await self.get_value()

    async def put(self, value: Optional[float]) -> None:
        """Raises TypeError: the signal cannot be set."""
        raise TypeError("the position is read only: use the device's set()")

    async def get_datakey(self, source: str) -> DataKey:
        """Returns the unit, the precision and the travel limits of the position."""
        reading = reading_of(await self._connection.stage.status(), self.axis)
        key: Any = {**data_key(reading, self.axis, source), "dtype_numpy": "<f8"}
        described: DataKey = key
        return described

    def set_callback(self, callback: Optional[Callable[[Reading[float]], None]]) -> None:
        """Calls `callback` with the reading, now and after every change. None: no longer."""
        task, self._task = self._task, None
        if task is not None:
            task.cancel()
        if callback is not None:
            self._task = asyncio.get_running_loop().create_task(self._watch(callback))

    async def _watch(self, callback: Callable[[Reading[float]], None]) -> None:
        try:
            async with self._connection.stage.watch() as states:
                async for status in states:
                    if has_position(status, self.axis):
                        callback(_document(reading_of(status, self.axis)))
        except (AxisgateError, RuntimeError) as error:
            _log.debug("axis %s is not watched: %s", self._axis, error)


def _document(reading: AxisReading) -> Reading[float]:
    return Reading(value=reading.position, timestamp=reading.read_at, alarm_severity=0)
