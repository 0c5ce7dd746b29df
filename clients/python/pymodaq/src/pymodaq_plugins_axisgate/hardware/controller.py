"""The stage, as the actuators of this plugin use it. All functions are thread safe."""

from __future__ import annotations

from typing import List, Optional

from axisgate import Motion, Stage, StopReport, s
from axisgate._readings import pulse_of, reading_of

_PULSES = "pulses"


class Controller:
    """A Controller is one stage. The actuators of its axes share it."""

    def __init__(self, target: str = "", device: str = "") -> None:
        """Connects to the daemon. Raises Unavailable if no daemon answers, and LookupError if it has no such stage."""
        self._stage = Stage(target or None, device=device or None)
        self.axes: List[str] = [axis.name for axis in self._stage.axes]
        """Names of the axes, in the order of their numbers."""

    @property
    def name(self) -> str:
        """Name of the stage."""
        return self._stage.name

    def name_of(self, axis: str) -> Optional[str]:
        """Returns the name of an axis that is given by its name or number. None: there is no such axis."""
        if axis in self.axes:
            return axis
        return next((one.name for one in self._stage.axes if str(one.number) == axis), None)

    def unit(self, axis: str) -> str:
        """Returns the unit of an axis as PyMoDAQ names it. Empty: pulses."""
        symbol = str(self._stage[axis].unit)
        return "" if symbol == _PULSES else symbol

    def pulse(self, axis: str) -> float:
        """Returns the size of a drive pulse in the unit of the axis."""
        chosen = self._stage[axis]
        pulse = pulse_of(reading_of(self._stage.status(), chosen), chosen)
        if pulse is None:
            raise LookupError(f"the size of a pulse of axis {axis} is unknown")
        return float(pulse)

    def position(self, axis: str) -> float:
        """Reads the position from the controller, in the unit of the axis."""
        value = self._stage[axis].position.value
        if value is None:
            raise RuntimeError(f"the position of axis {axis} is unknown")
        return float(value)

    def start(self, axis: str, value: float, relative: bool, speed: float) -> Motion:
        """Starts a move. `speed` is in the unit of the axis per second; 0: as the axis is set. Raises Refused."""
        chosen = self._stage[axis]
        return chosen.start(value * chosen.unit, relative=relative, speed=speed * (chosen.unit / s) if speed else None)

    def home(self, axis: str) -> Motion:
        """Starts homing an axis. Raises Refused."""
        return self._stage.start_home(axis)

    def stop(self, axis: str) -> StopReport:
        """Stops an axis, and returns once it was seen stationary, or after 4 s. Raises Unavailable."""
        return self._stage[axis].stop()

    def rearm(self) -> None:
        """Allows motion after a stop by another program."""
        self._stage.rearm()

    def close(self) -> None:
        """Closes the connection. Motions continue."""
        self._stage.close()
