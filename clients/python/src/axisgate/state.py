"""The newest known state of a device and its axes. All objects are immutable."""

from __future__ import annotations

import functools
import html
from dataclasses import dataclass
from decimal import Decimal
from typing import Any, Mapping, Optional, Tuple

from axisgate.errors import Refused, Unavailable
from axisgate.results import Position, axis_name, decimal_of, table, unit_of
from axisgate.units import Distance, Unit, deg, mm, nm, pulses, um
from axisgate.v1 import common_pb2, device_pb2

_FIELDS = {"pulses": pulses, "nm": nm, "um": um, "mm": mm, "degrees": deg}


@dataclass(frozen=True)
class AxisState:
    """State of one axis. None means unknown; a limit that is None does not exist."""

    number: int
    name: str
    unit: Unit
    position: Position
    moving: Optional[bool]
    motor_on: Optional[bool]
    homed: bool
    minimum: Optional[Distance]
    maximum: Optional[Distance]
    conditions: Tuple[str, ...]


@dataclass(frozen=True)
class Status:
    """State of a device. `link` is "UP" if the controller answers, and `link_problem` says why not.

    `message` is the whole state, as the API's message `Device`.
    """

    device: str
    link: str
    link_problem: str
    mode: str
    message: device_pb2.Device

    @functools.cached_property
    def axes(self) -> Mapping[str, AxisState]:
        """States of the axes by their names. Axes that the controller does not allow to be moved are left out."""
        states = (axis_state(axis) for axis in self.message.axes if axis.controllable)
        return {state.name: state for state in states}

    def __str__(self) -> str:
        positions = ", ".join(str(axis.position) for axis in self.axes.values())
        return f"{self.device} {self.link}: {self.link_problem or positions}"

    def _repr_html_(self) -> str:
        rows = ((axis.name, str(axis.position).partition(" ")[2], {True: "moving", False: "stationary", None: ""}[
            axis.moving], "homed" if axis.homed else "", ", ".join(axis.conditions)) for axis in self.axes.values())
        return f"{html.escape(self.device)} {self.link} {html.escape(self.link_problem)}" + table(
            ("axis", "position", "motion", "home", "conditions"), rows)


def status_of(device: device_pb2.Device) -> Status:
    """Returns the state of a device."""
    return Status(device.name[len("devices/"):], _name(device_pb2.LinkState, device.link, "LINK_STATE_"),
                  device.link_problem, _name(common_pb2.Mode, device.mode, "MODE_"), device)


def known_axes(status: Status) -> Mapping[str, AxisState]:
    """Returns the axes that can be moved. Raises Unavailable while the daemon does not know them: from its start until
    the controller answers."""
    if status.axes:
        return status.axes
    why = f"the device cannot be asked: {status.link_problem}" if status.link_problem else (
        "it is not known yet which axes the device has")
    raise Unavailable("LINK_DOWN", why, "try again when the controller answers")


def axis_in(status: Status, name: str) -> AxisState:
    """Returns the state of an axis. Raises Unavailable like known_axes()."""
    state = known_axes(status).get(name)
    if state is None:
        raise Refused("UNKNOWN_AXIS", f"the controller no longer allows axis {name} to be moved")
    return state


def axis_state(axis: device_pb2.Axis) -> AxisState:
    """Returns the state of an axis."""
    name, unit = axis_name(axis.name, axis.number), unit_of(axis.unit)
    known = axis.position_pulses if axis.HasField("position_pulses") else None
    return AxisState(axis.number, name, unit, Position(name, decimal_of(axis.position), unit, known),
                     axis.busy if axis.HasField("busy") else None, axis.excited if axis.HasField("excited") else None,
                     axis.homed, _limit(axis, "travel_minimum"), _limit(axis, "travel_maximum"),
                     tuple(_name(device_pb2.Condition, one, "CONDITION_") for one in axis.conditions))


def _limit(axis: device_pb2.Axis, field: str) -> Optional[Distance]:
    if not axis.HasField(field):
        return None
    limit: Any = getattr(axis, field)
    chosen = limit.WhichOneof("amount")
    return Distance(Decimal(getattr(limit, chosen)), _FIELDS[chosen]) if chosen in _FIELDS else None


def _name(enum: Any, number: int, prefix: str) -> str:
    value = enum.DESCRIPTOR.values_by_number.get(number)
    return f"{prefix}{number}" if value is None else str(value.name)[len(prefix):]
