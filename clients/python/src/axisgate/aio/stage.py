"""A stage of the daemon in the asyncio form."""

from __future__ import annotations

from types import TracebackType
from typing import AsyncIterator, Dict, Iterable, List, Optional, Sequence, Tuple, Type, Union

from axisgate import _requests, _target
from axisgate._axes import find_axis, names_of, not_homed, targets_of
from axisgate._devices import choose
from axisgate._methods import (CLEAR_ERRORS, EMERGENCY_STOP, GET_CALLER, HOME, LIST_MOTIONS, MOVE, REARM, SCAN, STOP)
from axisgate.aio import path
from axisgate.aio._connection import Connection
from axisgate.aio._session import DeviceSession
from axisgate.aio.axis import Axis
from axisgate.aio.events import Events, States
from axisgate.aio.jog import Jog
from axisgate.aio.lease import Lease
from axisgate.aio.motion import Motion
from axisgate.events import Event
from axisgate.points import Arc
from axisgate.results import Result, StopReport, report_of
from axisgate.state import Status, status_of
from axisgate.units import Distance, Speed
from axisgate.v1 import access_pb2, control_pb2, device_pb2, stage_pb2


class Stage:
    """A Stage is the connection of one event loop to one device that moves axes::

        async with Stage() as stage:
            await stage["x"].move_to(1.5 * mm)

    The arguments and the functions are those of axisgate.Stage. `connect` and `close` are the form without a block.
    Every function raises Refused if the daemon refuses a request, and RuntimeError in another event loop.
    """

    def __init__(self, target: Optional[str] = None, *, device: Optional[str] = None, token: Optional[str] = None,
                 ca: Optional[str] = None, certificate: Optional[str] = None, key: Optional[str] = None,
                 timeout: float = 10.0) -> None:
        """Does not connect yet. Raises ValueError if the arguments contradict each other."""
        self._connection = Connection(_target.resolve(target, token, ca, certificate, key), timeout)
        self._wanted = device
        self._axes: Dict[str, Axis] = {}
        self._connected: Optional[DeviceSession] = None

    async def connect(self) -> Stage:
        """Connects to the daemon. Raises Unavailable if no daemon answers, and LookupError if there is no such device.
        """
        try:
            found = choose(await self._connection.open(), self._wanted, device_pb2.CAPABILITY_MOVE)
        except BaseException:
            await self.close()
            raise
        self._connected = DeviceSession(self._connection, found.name)
        self._axes = {name: Axis(self, state) for name, state in status_of(found).axes.items()}
        return self

    @classmethod
    async def find(cls, target: Optional[str] = None, *, token: Optional[str] = None, ca: Optional[str] = None,
                   certificate: Optional[str] = None, key: Optional[str] = None, timeout: float = 10.0) -> List[str]:
        """Returns the names of the daemon's stages. The arguments are those of the class."""
        connection = Connection(_target.resolve(target, token, ca, certificate, key), timeout)
        try:
            return [device.name[len("devices/"):] for device in (await connection.open()).devices
                    if device_pb2.CAPABILITY_MOVE in device.capabilities]
        finally:
            await connection.close()

    async def close(self) -> None:
        """Closes the connection and ends all tasks of the Stage. Motions continue."""
        await self._connection.close()

    async def __aenter__(self) -> Stage:
        return await self.connect()

    async def __aexit__(self, kind: Optional[Type[BaseException]], error: Optional[BaseException],
                        trace: Optional[TracebackType]) -> None:
        await self.close()

    def __repr__(self) -> str:
        return f"<Stage {self.name}>" if self._connected else "<Stage, not open>"

    @property
    def _session(self) -> DeviceSession:
        if self._connected is None:
            raise RuntimeError("this Stage is not open: use it by `async with Stage() as stage:`")
        return self._connected

    @property
    def name(self) -> str:
        """Name of the device."""
        return self._session.device[len("devices/"):]

    @property
    def axes(self) -> Tuple[Axis, ...]:
        """The axes that can be moved, in the order of their numbers."""
        return tuple(self._axes.values())

    def __getitem__(self, axis: Union[str, int]) -> Axis:
        """Returns an axis by its name or number. Raises KeyError."""
        return find_axis(self._axes, axis)

    async def whoami(self) -> Tuple[str, str]:
        """Returns the caller's name and role, as the daemon identifies this program."""
        answer = await self._session.connection.ask(GET_CALLER, access_pb2.GetCallerRequest())
        return answer.caller.name, access_pb2.Role.Name(answer.role)[len("ROLE_"):].lower()

    async def status(self, max_age: Optional[float] = None) -> Status:
        """Returns the state of the device. It is read from the controller if it is older than `max_age` seconds."""
        return status_of(await self._session.read(max_age))

    def watch(self, min_interval: float = 0.05) -> States:
        """Iterates over the newest state of the device, now and after every change. A slow reader skips states.

        `min_interval` is the minimum time between two states in seconds. Iteration continues after a broken connection.
        """
        return States(self._session, min_interval)

    def events(self, since: Union[None, int, Event] = None) -> Events:
        """Watches every event, each once and in order, also over broken connections and restarts.

        It begins with its block, ``async with stage.events() as events:``, or with the first iteration. With an event
        or a revision as `since`, the iterator begins after it; with 0 it begins at the oldest kept event. A Gap in the
        series means that events were missed.
        """
        return Events(self._session, since)

    async def check(self, *, relative: bool = False, speed: Optional[Speed] = None, **targets: Distance) -> None:
        """Checks a move as far as possible without moving. Raises Refused if it would be refused."""
        await self._session.act(MOVE, self._move(targets, relative, speed, validate_only=True))

    async def start(self, *, relative: bool = False, speed: Optional[Speed] = None, **targets: Distance) -> Motion:
        """Starts a move of some axes, all at once: ``await stage.start(x=1.5 * mm, y=200 * um)``."""
        return await self._session.start(MOVE, self._move(targets, relative, speed))

    async def move_to(self, *, speed: Optional[Speed] = None, **targets: Distance) -> Result:
        """Moves axes to positions, and waits for the outcome. The motion is cancelled if the task is.

        Raises Refused, Stopped, MotionFailed or OutcomeUnknown.
        """
        return await self._session.finish(MOVE, self._move(targets, False, speed))

    async def move_by(self, *, speed: Optional[Speed] = None, **displacements: Distance) -> Result:
        """Does the same as move_to() with displacements from the present positions."""
        return await self._session.finish(MOVE, self._move(displacements, True, speed))

    async def home(self, *axes: str, if_needed: bool = False) -> Result:
        """Homes axes, without arguments all, and waits for the outcome. The motion is cancelled if the task is.

        With `if_needed`, axes that the daemon has homed already are left out. The result has no positions if none is
        left.
        """
        chosen = list(axes)
        if if_needed:
            chosen = not_homed(await self.status(), [self[axis].name for axis in axes])
            if not chosen:
                return Result("", {}, 0.0)
        return await self._session.finish(HOME, self._home(chosen))

    async def start_home(self, *axes: str) -> Motion:
        """Starts homing axes, without arguments all."""
        return await self._session.start(HOME, self._home(axes))

    async def path(self, points: Iterable[Union[Arc, Iterable[Distance]]], axes: Sequence[str], *,
                   speed: Optional[Speed] = None) -> Motion:
        """Starts a path through points without a halt: ``await stage.path(grid, "xy", speed=2 * mm / s)``.

        A point is an Arc, or has one position for each axis, in their order. All points are read first, so nothing
        moves if `points` raises an exception. `speed` is the speed along the path. None: the minimum speed of its
        axis with the lowest number, which is slow.
        """
        return await path.start(self._session, points, names_of(axes, self._axes), speed)

    async def visit(self, points: Iterable[Iterable[Distance]], axes: Sequence[str], *,
                    speed: Optional[Speed] = None) -> AsyncIterator[Result]:
        """Moves to one point after another, and yields the result once the axes are stationary at each point.

        Use it inside a lease, so that nobody moves the axes in between.
        """
        names = names_of(axes, self._axes)
        for point in points:
            yield await self.move_to(speed=speed, **targets_of(names, point))

    def jog(self, **speeds: Speed) -> Jog:
        """Returns a jog, which runs axes while its block lasts: ``async with stage.jog(x=200 * um / s):``. A negative
        speed is one in the minus direction."""
        return Jog(self._session, speeds)

    async def scan(self, axis: str, start: Distance, stop: Distance, *, every: Distance,
                   speed: Optional[Speed] = None) -> Motion:
        """Starts a run of one axis at constant speed. The trigger output gives a pulse every `every` from `start` on.

        `Result.scan` has the expected and the observed number of pulses.
        """
        return await self._session.start(SCAN, _requests.scan(self._session.device, axis, start, stop, every, speed))

    async def stop(self, *axes: str) -> StopReport:
        """Slows down and stops axes, without arguments all of the stage. Needs no lease.

        Returns what was seen within 4 s. The stop is sent again for half of the Stage's timeout if no daemon answers.
        Not a safety function.
        """
        request = _requests.stop(self._session.device, axes, self._session.token())
        return report_of(await self._session.connection.stop(STOP, request))

    async def emergency_stop(self) -> StopReport:
        """Stops all axes at once without slowing down. Nothing moves until clear_errors(). Not a safety function."""
        request = _requests.emergency_stop(self._session.device, self._session.token())
        return report_of(await self._session.connection.stop(EMERGENCY_STOP, request))

    async def clear_errors(self, *axes: str) -> None:
        """Clears limit, overflow and emergency errors of axes, without arguments of all. Starts no motion."""
        await self._session.act(CLEAR_ERRORS, device_pb2.ClearErrorsRequest(device=self._session.device, axes=axes))

    async def rearm(self) -> Tuple[int, ...]:
        """Allows motion after a stop by another caller. Returns the numbers of the axes that may move again."""
        answer = await self._session.act(REARM, control_pb2.RearmRequest(device=self._session.device))
        return tuple(answer.axes)

    async def motions(self) -> List[Motion]:
        """Returns the newest 100 motions, newest first, also those of other callers."""
        listed = await self._session.connection.ask(LIST_MOTIONS,
                                                    stage_pb2.ListMotionsRequest(device=self._session.device))
        return [Motion(self._session, one) for one in listed.motions]

    def lease(self, *axes: str, wait: float = 0.0, ttl: float = 10.0, at_loss: str = "stop",
              purpose: str = "") -> Lease:
        """Returns a lease, the exclusive right to axes, or without arguments to the stage, while its block lasts:
        ``async with stage.lease("x"):``.

        Waits at most `wait` seconds. The lease ends `ttl` seconds after the program or the connection has failed; a
        running motion is then stopped, or with `at_loss` "finish" ends first. Others see the `purpose`.

        Entering the block raises LeaseHeld if the axes are not free.
        """
        request = _requests.acquire_lease(self._session.device, axes, wait, ttl, at_loss, purpose)
        return Lease(self._session, request, wait, ttl)

    def _home(self, axes: Sequence[str]) -> stage_pb2.HomeRequest:
        return stage_pb2.HomeRequest(device=self._session.device, axes=axes)

    def _move(self, targets: Dict[str, Distance], relative: bool, speed: Optional[Speed],
              validate_only: bool = False) -> stage_pb2.MoveRequest:
        return _requests.move(self._session.device, targets, relative=relative, speed=speed,
                              validate_only=validate_only)
