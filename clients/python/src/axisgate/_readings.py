"""States of one axis as packages for data acquisition need them: bare numbers in the unit of the axis."""

from __future__ import annotations

import time
from dataclasses import dataclass
from decimal import Decimal
from typing import Any, Dict, Optional, Protocol

from axisgate.state import AxisState, Status, axis_in
from axisgate.units import Distance, Unit
from axisgate.v1 import device_pb2

_NANOMETERS = {"nm": Decimal(1), "um": Decimal(1000), "mm": Decimal(1_000_000)}
_MILLIONTHS = Decimal(1_000_000)


class AnyAxis(Protocol):
    """An Axis, or an Axis of the asyncio form."""

    name: str
    number: int
    unit: Unit


@dataclass(frozen=True)
class AxisReading:
    """State of an axis, its message, and the time of its reading in seconds since 1970."""

    state: AxisState
    message: device_pb2.Axis
    read_at: float

    @property
    def position(self) -> float:
        """Position in the unit of the axis. Raises RuntimeError if unknown."""
        if self.state.position.value is None:
            raise RuntimeError(f"the position of axis {self.state.name} is unknown")
        return float(self.state.position.value)


def reading_of(status: Status, axis: AnyAxis) -> AxisReading:
    """Returns the state of an axis. Raises Unavailable while the daemon does not know the axes."""
    state = axis_in(status, axis.name)
    message = next(one for one in status.message.axes if one.number == state.number)
    read_at = status.message.read_time.ToNanoseconds() / 1e9 if status.message.HasField("read_time") else time.time()
    return AxisReading(state, message, read_at)


def has_position(status: Status, axis: AnyAxis) -> bool:
    """Reports whether the position is known. It is not until the controller answers a daemon that was restarted."""
    state = status.axes.get(axis.name)
    return state is not None and state.position.value is not None


def pulse_of(reading: AxisReading, axis: AnyAxis) -> Optional[Decimal]:
    """Returns the size of a pulse in the unit of the axis. None if unknown."""
    if axis.unit.symbol == "pulses":
        return Decimal(1)
    if not reading.message.per_pulse:
        return None
    unit = _MILLIONTHS if reading.message.rotary else _NANOMETERS.get(axis.unit.symbol)
    return None if unit is None else Decimal(reading.message.per_pulse) / unit


def data_key(reading: AxisReading, axis: AnyAxis, source: str) -> Dict[str, Any]:
    """Returns bluesky's description of the position: its unit, its precision and the travel limits."""
    key: Dict[str, Any] = {"source": source, "dtype": "number", "shape": [], "units": str(axis.unit)}
    pulse = pulse_of(reading, axis)
    if pulse is not None:
        key["precision"] = max(0, -pulse.adjusted())
    limits = {end: _in_unit(limit, axis) for end, limit in (("low", reading.state.minimum),
                                                           ("high", reading.state.maximum)) if limit is not None}
    if limits and None not in limits.values():
        key["limits"] = {"control": limits}
    return key


def _in_unit(distance: Distance, axis: AnyAxis) -> Optional[float]:
    """Returns a distance in the unit of the axis. None if it cannot be converted."""
    if distance.unit.symbol == axis.unit.symbol:
        return float(distance.value)
    given, wanted = _NANOMETERS.get(distance.unit.symbol), _NANOMETERS.get(axis.unit.symbol)
    return None if given is None or wanted is None else float(Decimal(distance.value) * given / wanted)
