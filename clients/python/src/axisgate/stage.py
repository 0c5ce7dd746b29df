"""A stage of the daemon."""

from __future__ import annotations

from typing import Dict, Iterable, Iterator, List, Optional, Sequence, Tuple, Union

from axisgate import _requests, path
from axisgate._axes import find_axis, names_of, not_homed, targets_of
from axisgate._methods import CLEAR_ERRORS, EMERGENCY_STOP, HOME, LIST_MOTIONS, MOVE, SCAN, STOP
from axisgate.axis import Axis
from axisgate.commands import Executed, execute
from axisgate.device import Device
from axisgate.jog import Jog
from axisgate.motion import Motion
from axisgate.places import Places
from axisgate.points import Arc
from axisgate.results import Result, StopReport, report_of
from axisgate.samples import Samples, States
from axisgate.settings import Settings
from axisgate.state import Status, status_of
from axisgate.units import Distance, Speed
from axisgate.v1 import device_pb2, stage_pb2


class Stage(Device):
    """A Stage is the connection to one device that moves axes. All functions are thread safe.

    Axes are named as in the configuration, or by their numbers: ``stage["x"]``, ``stage[1]``. Every function raises
    Refused if the daemon refuses a request: nothing moved.
    """

    _capability = device_pb2.CAPABILITY_MOVE

    def _opened(self, device: device_pb2.Device) -> None:
        self._axes: Dict[str, Axis] = {name: Axis(self, state) for name, state in status_of(device).axes.items()}

    @property
    def axes(self) -> Tuple[Axis, ...]:
        """The axes that can be moved, in the order of their numbers."""
        return tuple(self._axes.values())

    @property
    def settings(self) -> Settings:
        """Settings of the stage."""
        return Settings(self._session)

    @property
    def places(self) -> Places:
        """Saved positions of the stage."""
        return Places(self._session)

    def __getitem__(self, axis: Union[str, int]) -> Axis:
        """Returns an axis by its name or number. Raises KeyError."""
        return find_axis(self._axes, axis)

    def status(self, max_age: Optional[float] = None) -> Status:
        """Returns the state of the device. It is read from the controller if it is older than `max_age` seconds."""
        return status_of(self._session.read(max_age))

    def watch(self, min_interval: float = 0.05) -> States:
        """Iterates over the newest state of the device, now and after every change. A slow reader skips states.

        `min_interval` is the minimum time between two states in seconds. Iteration continues after a broken connection.
        """
        return States(self._session, min_interval)

    def sample(self, interval: float = 0.05) -> Samples:
        """Returns a recording of the positions, which lasts as long as its block: ``with stage.sample() as samples:``.

        `interval` is the minimum time between two rows in seconds.
        """
        return Samples(self._session, interval)

    def check(self, *, relative: bool = False, speed: Optional[Speed] = None, **targets: Distance) -> None:
        """Checks a move as far as possible without moving. Raises Refused if it would be refused."""
        self._session.act(MOVE, self._move(targets, relative, speed, validate_only=True))

    def start(self, *, relative: bool = False, speed: Optional[Speed] = None, **targets: Distance) -> Motion:
        """Starts a move of some axes, all at once: ``stage.start(x=1.5 * mm, y=200 * um)``."""
        return self._session.start(MOVE, self._move(targets, relative, speed))

    def move_to(self, *, speed: Optional[Speed] = None, **targets: Distance) -> Result:
        """Moves axes to positions, and waits for the outcome. Ctrl-C cancels the move.

        Raises Refused, Stopped, MotionFailed or OutcomeUnknown.
        """
        return self._session.finish(MOVE, self._move(targets, False, speed))

    def move_by(self, *, speed: Optional[Speed] = None, **displacements: Distance) -> Result:
        """Does the same as move_to() with displacements from the present positions."""
        return self._session.finish(MOVE, self._move(displacements, True, speed))

    def home(self, *axes: str, if_needed: bool = False) -> Result:
        """Homes axes, without arguments all, and waits for the outcome. Ctrl-C cancels the motion.

        With `if_needed`, axes that the daemon has homed already are left out. The result has no positions if none is
        left.
        """
        chosen = list(axes)
        if if_needed:
            chosen = not_homed(self.status(), [self[axis].name for axis in axes])
            if not chosen:
                return Result("", {}, 0.0)
        return self._session.finish(HOME, self._home(chosen))

    def start_home(self, *axes: str) -> Motion:
        """Starts homing axes, without arguments all."""
        return self._session.start(HOME, self._home(axes))

    def path(self, points: Iterable[Union[Arc, Iterable[Distance]]], axes: Sequence[str], *,
             speed: Optional[Speed] = None) -> Motion:
        """Starts a path through points without a halt: ``stage.path(grid, "xy", speed=2 * mm / s)``.

        A point is an Arc, or has one position for each axis, in their order. All points are read first, so nothing
        moves if `points` raises an exception. `speed` is the speed along the path. None: the minimum speed of its
        axis with the lowest number, which is slow.
        """
        return path.start(self._session, points, names_of(axes, self._axes), speed)

    def visit(self, points: Iterable[Iterable[Distance]], axes: Sequence[str], *,
              speed: Optional[Speed] = None) -> Iterator[Result]:
        """Moves to one point after another, and yields the result once the axes are stationary at each point.

        Use it inside a lease, so that nobody moves the axes in between.
        """
        names = names_of(axes, self._axes)
        for point in points:
            yield self.move_to(speed=speed, **targets_of(names, point))

    def jog(self, **speeds: Speed) -> Jog:
        """Returns a jog, which runs axes while its block lasts: ``with stage.jog(x=200 * um / s):``. A negative speed
        is one in the minus direction."""
        return Jog(self._session, speeds)

    def execute(self, *lines: str, timeout: float = 20.0) -> Executed:
        """Sends lines in the controller's own language, as one transaction, and returns their answers.

        A motion that the lines started may continue: wait for it by ``stage.execute("M:1+P100", "G:1").motion.wait()``.
        Lines are never sent again. Raises Refused if nothing moved; otherwise Stopped, MotionFailed or OutcomeUnknown.
        """
        return execute(self._session, lines, timeout)

    def scan(self, axis: str, start: Distance, stop: Distance, *, every: Distance,
             speed: Optional[Speed] = None) -> Motion:
        """Starts a run of one axis at constant speed. The trigger output gives a pulse every `every` from `start` on.

        `Result.scan` has the expected and the observed number of pulses.
        """
        return self._session.start(SCAN, _requests.scan(self._session.device, axis, start, stop, every, speed))

    def stop(self, *axes: str) -> StopReport:
        """Slows down and stops axes, without arguments all of the stage. Needs no lease.

        Returns what was seen within 4 s. The stop is sent again for half of the Stage's timeout if no daemon answers.
        Not a safety function.
        """
        request = _requests.stop(self._session.device, axes, self._session.token())
        return report_of(self._session.connection.stop(STOP, request))

    def emergency_stop(self) -> StopReport:
        """Stops all axes at once without slowing down. Nothing moves until clear_errors(). Not a safety function."""
        request = _requests.emergency_stop(self._session.device, self._session.token())
        return report_of(self._session.connection.stop(EMERGENCY_STOP, request))

    def clear_errors(self, *axes: str) -> None:
        """Clears limit, overflow and emergency errors of axes, without arguments of all. Starts no motion."""
        self._session.act(CLEAR_ERRORS, device_pb2.ClearErrorsRequest(device=self._session.device, axes=axes))

    def motions(self) -> List[Motion]:
        """Returns the newest 100 motions, newest first, also those of other callers."""
        listed = self._session.connection.ask(LIST_MOTIONS, stage_pb2.ListMotionsRequest(device=self._session.device))
        return [Motion(self._session, one) for one in listed.motions]

    def _home(self, axes: Sequence[str]) -> stage_pb2.HomeRequest:
        return stage_pb2.HomeRequest(device=self._session.device, axes=axes)

    def _move(self, targets: Dict[str, Distance], relative: bool, speed: Optional[Speed],
              validate_only: bool = False) -> stage_pb2.MoveRequest:
        return _requests.move(self._session.device, targets, relative=relative, speed=speed,
                              validate_only=validate_only)
