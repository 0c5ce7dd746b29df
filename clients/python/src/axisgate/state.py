"""The newest known state of a device and its axes. All objects are immutable."""

from __future__ import annotations

import html
from dataclasses import dataclass
from decimal import Decimal
from typing import Any, Mapping, Optional, Tuple

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
    axes: Mapping[str, AxisState]
    message: device_pb2.Device

    def __str__(self) -> str:
        positions = ", ".join(str(axis.position) for axis in self.axes.values())
        return f"{self.device} {self.link}: {self.link_problem or positions}"

    def _repr_html_(self) -> str:
        rows = ((axis.name, str(axis.position).partition(" ")[2], {True: "moving", False: "stationary", None: ""}[
            axis.moving], "homed" if axis.homed else "", ", ".join(axis.conditions)) for axis in self.axes.values())
        return f"{html.escape(self.device)} {self.link} {html.escape(self.link_problem)}" + table(
            ("axis", "position", "motion", "home", "conditions"), rows)


def status_of(device: device_pb2.Device) -> Status:
    """Returns the state of a device. Axes that the controller does not allow to be moved are left out."""
    axes = [axis_state(axis) for axis in device.axes if axis.controllable]
    return Status(device.name[len("devices/"):], _name(device_pb2.LinkState, device.link, "LINK_STATE_"),
                  device.link_problem, _name(common_pb2.Mode, device.mode, "MODE_"), {axis.name: axis for axis in axes},
                  device)


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
