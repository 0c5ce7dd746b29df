"""Axes and triggered lines as devices of bluesky, without ophyd::

    from bluesky import RunEngine, plans
    from axisgate import Stage
    from axisgate.bluesky import BlueskyAxis

    with Stage() as stage:
        x = BlueskyAxis(stage["x"], "x")
        RunEngine()(plans.scan([detector], x, 0, 1.5, 16))

Positions are bare numbers in the unit of the axis (`describe` names it), rounded to the nearest pulse. A refused motion
raises Refused in the plan; a motion that ends without success fails its status. While no daemon answers, a call blocks
the RunEngine for at most half of the Stage's timeout. This module does not import bluesky.
"""

from __future__ import annotations

import contextlib
import logging
import threading
import time
from dataclasses import dataclass
from typing import Any, Callable, Dict, Iterator, List, Optional, Tuple

from axisgate._bluesky_status import MotionStatus, Status, in_thread, succeeded, until_it_fails
from axisgate._methods import MOVE, SCAN
from axisgate._readings import AxisReading, data_key, has_position, reading_of
from axisgate._requests import move, scan
from axisgate.axis import Axis
from axisgate.lease import Lease
from axisgate.samples import States
from axisgate.units import s

_log = logging.getLogger("axisgate")

Documents = Dict[str, Dict[str, Any]]
"""Readings or data keys, by the name of the value."""


class _AxisDevice:
    """An _AxisDevice has a name, a lease, and at most one motion in progress."""

    def __init__(self, axis: Axis, name: str, lease: Optional[Lease], leased: Tuple[str, ...]) -> None:
        self._axis = axis
        self._leased = leased
        self._name = name
        self._given_lease = lease
        self._own_lease: Optional[Lease] = None
        self._status: Optional[MotionStatus] = None

    @property
    def name(self) -> str:
        """Name of the device, and of its value."""
        return self._name

    @property
    def parent(self) -> None:
        """None: the device is no part of another one."""
        return None

    @property
    def hints(self) -> Dict[str, Any]:
        """Value to plot."""
        return {"fields": [self._name]}

    def stage(self) -> List[object]:
        """Acquires a lease, unless the device has one. Raises LeaseHeld if the axes are not free."""
        if self._own_lease is not None:
            raise RuntimeError(f"{self._name} is staged already")
        if self._given_lease is None and not self._axis._stage._session.token():
            self._own_lease = self._axis._stage.lease(*self._leased, purpose=f"bluesky: {self._name}")
        return [self]

    def unstage(self) -> List[object]:
        """Stops a motion of this device that is still in progress, and releases the lease of stage()."""
        try:
            self.stop()
        finally:
            lease, self._own_lease = self._own_lease, None
            if lease is not None:
                lease.release()
        return [self]

    def stop(self, success: bool = True) -> None:
        """Stops the axis if a motion of this device is in progress, and no motion of anybody else.

        bluesky calls it for a pause, and for each device at the end of a plan. With `success`, the status of the motion
        ends with success.
        """
        status = self._status
        if status is None or status.done:
            return
        status.expect_stop(success)
        with self._carrying_lease():
            self._axis.stop()

    def __repr__(self) -> str:
        return f"<{type(self).__name__} {self._name}: {self._axis}>"

    @contextlib.contextmanager
    def _carrying_lease(self) -> Iterator[None]:
        """Makes the calls of a block carry the lease. bluesky calls from threads and tasks of its own."""
        lease = self._own_lease or self._given_lease
        with self._axis._stage._session.carrying(b"" if lease is None else lease.token):
            yield

    @property
    def _source(self) -> str:
        return f"axisgate:{self._axis._stage.name}/{self._axis.name}"

    def _state(self, max_age: Optional[float] = None) -> AxisReading:
        return reading_of(self._axis._stage.status(max_age), self._axis)

    def _data_key(self) -> Dict[str, Any]:
        return data_key(self._state(), self._axis, self._source)


class BlueskyAxis(_AxisDevice):
    """A BlueskyAxis is an axis as a device of bluesky, for `scan`, `mv` and other plans.

    `stage`, which the plans of bluesky call, acquires a lease of the axis. A program that has one gives it as `lease`.
    """

    def __init__(self, axis: Axis, name: Optional[str] = None, *, lease: Optional[Lease] = None) -> None:
        super().__init__(axis, axis.name if name is None else name, lease, leased=(axis.name,))
        self._lock = threading.Lock()
        self._subscribers: List[Callable[[Documents], object]] = []
        self._states: Optional[States] = None

    @property
    def position(self) -> float:
        """Present position."""
        return self._state(max_age=0.0).position

    def set(self, value: float) -> MotionStatus:
        """Starts a move to a position. Raises Refused if it does not start."""
        with self._carrying_lease():
            motion = self._axis.start(float(value) * self._axis.unit)
        self._status = MotionStatus(self._name, self._axis, motion, float(value))
        return self._status

    def check_value(self, value: float) -> None:
        """Checks a move as far as possible without moving. Raises Refused if it would be refused."""
        session = self._axis._stage._session
        request = move(session.device, {str(self._axis.number): float(value) * self._axis.unit}, relative=False,
                       validate_only=True)
        with self._carrying_lease():
            session.act(MOVE, request)

    def locate(self) -> Dict[str, float]:
        """Returns the requested position and the present position.

        Both are the present position unless a motion of this device is in progress: relative plans begin there.
        """
        readback = self.position
        moving = self._status is not None and not self._status.done
        target = self._status._target if self._status is not None and moving else None
        return {"setpoint": readback if target is None else target, "readback": readback}

    def read(self) -> Documents:
        """Reads the position from the controller."""
        return self._document(self._state(max_age=0.0))

    def describe(self) -> Documents:
        """Returns the unit, the precision and the travel limits of the position."""
        return {self._name: self._data_key()}

    def read_configuration(self) -> Documents:
        """Returns the highest speed of the axis in pulses/s. Empty if unknown."""
        state = self._state()
        fastest = state.message.speeds.maximum
        if fastest.WhichOneof("amount") != "pulses_per_s":
            return {}
        return {f"{self._name}_speed": {"value": fastest.pulses_per_s, "timestamp": state.read_at}}

    def describe_configuration(self) -> Documents:
        """Describes read_configuration()."""
        return {name: {"source": self._source, "dtype": "integer", "shape": [], "units": "pulses/s"}
                for name in self.read_configuration()}

    def subscribe(self, function: Callable[[Documents], object]) -> None:
        """Calls `function` with the reading from another thread, now and after every change of the state."""
        with self._lock:
            self._subscribers.append(function)
            if self._states is None:
                self._states = states = self._axis._stage.watch()
                return in_thread(lambda: self._tell(states), self._name)
        function(self.read())

    def clear_sub(self, function: Callable[[Documents], object]) -> None:
        """Ends subscribe()."""
        with self._lock:
            self._subscribers.remove(function)
            states = self._states
            if self._subscribers or states is None:
                return
            self._states = None
        states.close()

    def _tell(self, states: States) -> None:
        with until_it_fails(self._name):
            for status in states:
                if has_position(status, self._axis):
                    for function in list(self._subscribers):
                        function(self._document(reading_of(status, self._axis)))

    def _document(self, reading: AxisReading) -> Documents:
        return {self._name: {"value": reading.position, "timestamp": reading.read_at}}


@dataclass(frozen=True)
class Line:
    """A Line is a range of a triggered scan: positions, the distance of two trigger pulses, and the speed, in the unit
    of the axis. `speed` None: as the axis is set."""

    start: float
    stop: float
    every: float
    speed: Optional[float] = None


class BlueskyLine(_AxisDevice):
    """A BlueskyLine is a triggered scan of one axis as a flyer of bluesky::

        line = BlueskyLine(stage["x"], "line")
        yield from bps.prepare(line, Line(0, 1, every=0.01, speed=0.5), wait=True)
        yield from bps.kickoff(line, wait=True)
        yield from bps.complete(line, wait=True)
        yield from bps.collect(line)

    The events are the positions at which the trigger pulses were due. They are nominal: the controller does not compare
    positions. Their times are that of the collection. A scan that was stopped has no events. A pause does not stop the
    scan. If the line is staged, an abort of the plan stops it. `stage` acquires a lease of the whole stage, because the
    controller's trigger is used by all axes; a BlueskyAxis in the same plan needs the same `lease`.
    """

    def __init__(self, axis: Axis, name: Optional[str] = None, *, lease: Optional[Lease] = None) -> None:
        super().__init__(axis, axis.name if name is None else name, lease, leased=())  # a scan needs all axes
        self._line: Optional[Line] = None

    def prepare(self, value: Line) -> Status:
        """Takes the range of the next scan, and checks it without moving. Raises Refused if it would be refused."""
        with self._carrying_lease():
            self._axis._stage._session.act(SCAN, self._request(value, validate_only=True))
        self._line = value
        return succeeded(self._name)

    def kickoff(self) -> Status:
        """Starts the scan. Raises Refused if it does not start."""
        if self._line is None:
            raise RuntimeError(f"{self._name} is not prepared: use bps.prepare(line, Line(...))")
        with self._carrying_lease():
            motion = self._axis._stage._session.start(SCAN, self._request(self._line))
        self._status = MotionStatus(self._name, self._axis, motion, self._line.stop)
        return succeeded(self._name)

    def complete(self) -> Status:
        """Returns the outcome of the scan."""
        if self._status is None:
            raise RuntimeError(f"{self._name} is not running: use bps.kickoff(line) first")
        self._status.add_callback(self._check_pulses)
        return self._status

    def describe_collect(self) -> Dict[str, Documents]:
        """Describes the events, in a stream with the name of the device."""
        return {self._name: {self._name: self._data_key()}}

    def collect(self) -> Iterator[Dict[str, Any]]:
        """Yields an event for each trigger pulse of the last scan, once."""
        status = self._status
        if status is None or not status.done or status.result is None:
            return
        self._status = None
        assert status.result.scan is not None
        ended = time.time()
        for position in status.result.scan.positions:
            yield {"time": ended, "data": {self._name: float(position)}, "timestamps": {self._name: ended}}

    def _request(self, line: Line, validate_only: bool = False) -> Any:
        unit = self._axis.unit
        speed = None if line.speed is None else float(line.speed) * (unit / s)
        request = scan(self._axis._stage._session.device, self._axis.name, float(line.start) * unit,
                       float(line.stop) * unit, float(line.every) * unit, speed)
        request.validate_only = validate_only
        return request

    def _check_pulses(self, status: Status) -> None:
        result = status.result if isinstance(status, MotionStatus) else None
        if result is not None and result.scan is not None and result.scan.observed != result.scan.expected:
            _log.warning("%s gave %s trigger pulses, not %s: the positions may be wrong", self._name,
                         result.scan.observed, result.scan.expected)
