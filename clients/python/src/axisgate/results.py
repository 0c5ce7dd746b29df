"""Positions, and the results of motions and stops. All objects are immutable."""

from __future__ import annotations

import csv
import html
from dataclasses import dataclass
from decimal import Decimal
from typing import Any, Dict, Iterable, Mapping, Optional, Tuple, Type, Union

from axisgate._outcomes import error_of_problem
from axisgate.errors import AxisgateError, MotionFailed, OutcomeUnknown, Stopped
from axisgate.units import Unit, deg, mm, nm, pulses, um
from axisgate.v1 import common_pb2, motion_pb2, stage_pb2

_UNITS: Dict[int, Unit] = {
    common_pb2.UNIT_PULSES: pulses,
    common_pb2.UNIT_NANOMETERS: nm,
    common_pb2.UNIT_MICROMETERS: um,
    common_pb2.UNIT_MILLIMETERS: mm,
    common_pb2.UNIT_DEGREES: deg,
}
_ERRORS: Dict[int, Type[AxisgateError]] = {
    motion_pb2.MOTION_STATE_STOPPED: Stopped,
    motion_pb2.MOTION_STATE_FAILED: MotionFailed,
    motion_pb2.MOTION_STATE_UNKNOWN: OutcomeUnknown,
}


@dataclass(frozen=True)
class Position:
    """Position of one axis. `value` is exact, in `unit`. `value` or `pulses` is None if unknown."""

    axis: str
    value: Optional[Decimal]
    unit: Unit
    pulses: Optional[int]

    def __str__(self) -> str:
        return f"{self.axis} {'unknown' if self.value is None else f'{self.value:f} {self.unit}'}"


@dataclass(frozen=True)
class Scan:
    """Trigger pulses of a scan: due in the whole run, due within the range, and computed from the displacement. None:
    unknown.

    `positions` are those at which the pulses of the whole run are due, in the unit of the axis. They are nominal: the
    controller does not compare positions. Empty if unknown.
    """

    expected: Optional[int]
    expected_in_range: Optional[int]
    observed: Optional[int]
    positions: Tuple[Decimal, ...] = ()


@dataclass(frozen=True)
class Result:
    """Result of a motion that succeeded: the positions by the names of the axes, and the duration in seconds.

    An axis without a name has its number: "1". `scan` is None unless the motion was a scan.
    """

    motion: str
    positions: Mapping[str, Position]
    duration: float
    scan: Optional[Scan] = None

    def __str__(self) -> str:
        return ", ".join(map(str, self.positions.values()))

    def _repr_html_(self) -> str:
        return table(("axis", "position", "pulses"), ((one.axis, f"{_text(one.value)} {one.unit}", _text(one.pulses))
                                                      for one in self.positions.values()))

    def to_csv(self, path: str) -> None:
        """Writes a scan's trigger pulses and their nominal positions to a file, or else the positions of the axes."""
        with open(path, "w", encoding="utf-8", newline="") as file:
            writer = csv.writer(file)
            if self.scan is not None:
                axis = next(iter(self.positions.values()))
                writer.writerow(("pulse", f"{axis.axis} ({axis.unit})"))
                writer.writerows((number, _text(at)) for number, at in enumerate(self.scan.positions, 1))
            else:
                writer.writerow(("axis", "position", "unit", "pulses"))
                writer.writerows((one.axis, _text(one.value), one.unit, _text(one.pulses))
                                 for one in self.positions.values())


@dataclass(frozen=True)
class AxisStop:
    """Result of a stop for one axis. `stationary` is None if it was not seen after the stop."""

    position: Position
    stationary: Optional[bool]

    def __str__(self) -> str:
        state = {True: "stationary", False: "still moving", None: "not seen stationary"}[self.stationary]
        return f"{self.position} ({state})"


@dataclass(frozen=True)
class StopReport:
    """What was seen of a stop. `stays_open` means that the axes were not confirmed stationary: the daemon repeats the
    stop, and refuses motion of these axes. `problem` is None, or says why."""

    axes: Tuple[AxisStop, ...]
    stays_open: bool
    problem: Optional[AxisgateError]

    def __str__(self) -> str:
        seen = ", ".join(map(str, self.axes)) + ("; the stop stays open" if self.stays_open else "")
        return seen if self.problem is None else f"{seen}: {self.problem}"


def table(head: Iterable[str], rows: Iterable[Iterable[str]]) -> str:
    """Returns an HTML table for notebooks."""
    def line(tag: str, cells: Iterable[str]) -> str:
        return "<tr>" + "".join(f"<{tag}>{html.escape(cell)}</{tag}>" for cell in cells) + "</tr>"
    return "<table>" + line("th", head) + "".join(line("td", row) for row in rows) + "</table>"


def _text(value: Union[None, int, Decimal]) -> str:
    """Returns a number as decimal text. Empty if it is None."""
    return "" if value is None else f"{value:f}" if isinstance(value, Decimal) else str(value)


def unit_of(number: int) -> Unit:
    """Returns the unit of an axis. An unknown unit of a newer daemon has its number as its symbol."""
    return _UNITS.get(number) or Unit(f"UNIT {number}")


def axis_name(name: str, number: int) -> str:
    """Returns the configured name of an axis, or its number as text."""
    return name or str(number)


def decimal_of(text: str) -> Optional[Decimal]:
    """Returns the number of a decimal text. None if it is empty."""
    return Decimal(text) if text else None


def _optional(message: Any, field: str) -> Any:
    return getattr(message, field) if message.HasField(field) else None


def is_over(motion: motion_pb2.Motion) -> bool:
    """Reports whether the motion has its outcome."""
    return bool(motion.HasField("end_time"))


def outcome_of(motion: motion_pb2.Motion) -> Result:
    """Returns the result of a motion that is over. Raises Stopped, MotionFailed or OutcomeUnknown for other outcomes
    than success."""
    if motion.state != motion_pb2.MOTION_STATE_SUCCEEDED:
        raise error_of_problem(motion.problem, kind=_ERRORS.get(motion.state, MotionFailed))
    positions = {axis_name(one.name, one.axis): Position(axis_name(one.name, one.axis), decimal_of(one.position),
                                                         unit_of(one.unit), _optional(one, "command_pulses"))
                 for one in motion.results}
    began = motion.start_time if motion.HasField("start_time") else motion.create_time
    seconds = (motion.end_time.ToNanoseconds() - began.ToNanoseconds()) / 1e9
    return Result(motion.name, positions, seconds, _scan_of(motion))


def _scan_of(motion: motion_pb2.Motion) -> Optional[Scan]:
    if not motion.HasField("scan"):
        return None
    scan = motion.scan
    return Scan(_optional(scan, "expected_triggers"), _optional(scan, "expected_triggers_in_range"),
                _optional(scan, "observed_triggers"), _positions_of(scan))


def _positions_of(scan: motion_pb2.Scan) -> Tuple[Decimal, ...]:
    first, last = decimal_of(scan.run_from), decimal_of(scan.run_to)
    if first is None or last is None or not scan.HasField("interval_pulses"):
        return ()
    pulse = (last - first) / (scan.run_to_pulses - scan.run_from_pulses)
    return tuple(first + number * scan.interval_pulses * pulse for number in range(1, scan.expected_triggers + 1))


def report_of(answer: Any) -> StopReport:
    """Returns the report of the answer to a stop of one device."""
    axes = tuple(_axis_stop(one) for device in answer.devices for one in device.axes)
    problem = next((error_of_problem(device.problem) for device in answer.devices if device.HasField("problem")), None)
    return StopReport(axes, answer.stays_open, problem)


def _axis_stop(stop: stage_pb2.AxisStop) -> AxisStop:
    position = Position(axis_name(stop.name, stop.axis), decimal_of(stop.position), unit_of(stop.unit),
                        _optional(stop, "position_pulses"))
    return AxisStop(position, _optional(stop, "ready"))
