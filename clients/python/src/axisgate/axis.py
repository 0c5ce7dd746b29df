"""One axis of a stage."""

from __future__ import annotations

from typing import TYPE_CHECKING, Optional, Tuple

from axisgate._methods import MOVE
from axisgate._requests import axis_move
from axisgate.motion import Motion
from axisgate.results import Position, Result, StopReport
from axisgate.state import AxisState, axis_in
from axisgate.units import Distance, Speed, Unit
from axisgate.v1 import stage_pb2

if TYPE_CHECKING:
    from axisgate.stage import Stage


class Axis:
    """An Axis of a stage. Its properties that change are read from the controller each time. All functions are thread
    safe, and raise Refused if the daemon refuses a request."""

    def __init__(self, stage: Stage, state: AxisState) -> None:
        self._stage = stage
        self.name: str = state.name
        """Name from the configuration, or the number as text."""
        self.number: int = state.number
        """Number, from 1."""
        self.unit: Unit = state.unit
        """Unit in which positions are shown."""

    @property
    def position(self) -> Position:
        """Present position."""
        return self._state().position

    @property
    def pulses(self) -> Optional[int]:
        """Present position in drive pulses. None if unknown."""
        return self._state().position.pulses

    @property
    def limits(self) -> Tuple[Optional[Distance], Optional[Distance]]:
        """Lowest and highest position that the configuration allows. None: no limit."""
        state = self._state()
        return state.minimum, state.maximum

    def start(self, target: Distance, *, relative: bool = False, speed: Optional[Speed] = None,
              approach: Optional[Distance] = None) -> Motion:
        """Starts a move to a position, or if `relative` by a displacement.

        `speed` is the highest speed; None: as the axis is set. `approach` is the displacement of the last part of the
        move, whose direction is then always the same, so that backlash does not matter; None: the axis moves directly.
        """
        return self._stage._session.start(MOVE, self._request(target, relative, speed, approach))

    def move_to(self, target: Distance, *, speed: Optional[Speed] = None,
                approach: Optional[Distance] = None) -> Result:
        """Moves to a position, and waits for the outcome. Ctrl-C cancels the move. The arguments are those of start().

        Raises Refused, Stopped, MotionFailed or OutcomeUnknown.
        """
        return self._stage._session.finish(MOVE, self._request(target, False, speed, approach))

    def move_by(self, displacement: Distance, *, speed: Optional[Speed] = None,
                approach: Optional[Distance] = None) -> Result:
        """Does the same as move_to() with a displacement from the present position."""
        return self._stage._session.finish(MOVE, self._request(displacement, True, speed, approach))

    def home(self, *, if_needed: bool = False) -> Result:
        """Homes the axis, and waits for the outcome. See Stage.home()."""
        return self._stage.home(self.name, if_needed=if_needed)

    def stop(self) -> StopReport:
        """Stops the axis. See Stage.stop()."""
        return self._stage.stop(self.name)

    def __repr__(self) -> str:
        return f"<Axis {self.name} of {self._stage.name}>"

    def _state(self) -> AxisState:
        return axis_in(self._stage.status(max_age=0.0), self.name)

    def _request(self, target: Distance, relative: bool, speed: Optional[Speed],
                 approach: Optional[Distance]) -> stage_pb2.MoveRequest:
        return axis_move(self._stage._session.device, self.number, target, relative, speed, approach)
