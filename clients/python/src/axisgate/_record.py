"""A motion as its newest message has it, and its progress. Nothing here sends."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Dict, Mapping, Optional

from axisgate.results import Position, Result, is_over, outcome_of
from axisgate.state import status_of
from axisgate.v1 import device_pb2, motion_pb2


@dataclass(frozen=True)
class Progress:
    """Progress of a motion. `fraction` is None if the distance is unknown. `segment` counts finished ones of a path."""

    fraction: Optional[float]
    positions: Mapping[str, Position]
    segment: int


class MotionRecord:
    """A MotionRecord is what a program knows about a motion."""

    def __init__(self, message: motion_pb2.Motion) -> None:
        self._message = message

    @property
    def name(self) -> str:
        """Name of the motion: "devices/stage/motions/12"."""
        return str(self._message.name)

    @property
    def id(self) -> int:
        """Number of the motion. Numbers ascend."""
        return int(self.name.rpartition("/")[2])

    @property
    def state(self) -> str:
        """State as last received: "QUEUED", "RUNNING", "STOPPING", "SUCCEEDED", "STOPPED", "FAILED" or "UNKNOWN"."""
        value = motion_pb2.MotionState.DESCRIPTOR.values_by_number.get(self._message.state)
        return f"STATE {self._message.state}" if value is None else str(value.name)[len("MOTION_STATE_"):]

    @property
    def request_id(self) -> str:
        """Id of the request that started the motion."""
        return str(self._message.request_id)

    def _result(self, timeout: Optional[float]) -> Result:
        """Returns the result, or raises what wait() raises. `timeout` is the time for which the program has waited."""
        if not is_over(self._message):
            raise TimeoutError(f"{self.name} has no outcome after {timeout} s, and continues")
        return outcome_of(self._message)

    def __repr__(self) -> str:
        return f"<Motion {self.name} {self.state}>"


class ProgressMeter:
    """A ProgressMeter computes the progress of a motion from the states of its device."""

    def __init__(self) -> None:
        self._first: Dict[int, int] = {}

    def take(self, motion: motion_pb2.Motion, device: device_pb2.Device) -> Progress:
        """Returns the progress. The first known position of an axis is that at the start."""
        positions = {axis.number: axis.position_pulses for axis in device.axes if axis.HasField("position_pulses")}
        self._first = {**positions, **self._first}
        return Progress(_fraction(motion, self._first, positions),
                        {axis.name: axis.position for axis in status_of(device).axes.values()
                         if axis.number in motion.axes}, motion.segments_done)


def _fraction(motion: motion_pb2.Motion, first: Mapping[int, int], now: Mapping[int, int]) -> Optional[float]:
    """Returns the least part of its distance that an axis has covered, or the part of a path's segments."""
    if motion.segments_total:
        return float(motion.segments_done / motion.segments_total)
    parts = [(now[one.axis] - first[one.axis]) / (one.target_pulses - first[one.axis]) for one in motion.results
             if one.HasField("target_pulses") and one.axis in now and one.target_pulses != first[one.axis]]
    return min(parts) if parts else None
