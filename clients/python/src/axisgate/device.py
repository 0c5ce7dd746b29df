"""What stages and mills have in common: the connection, the caller, leases and events."""

from __future__ import annotations

from types import TracebackType
from typing import Any, List, Optional, Tuple, Type, TypeVar, Union

from axisgate import _target, lease
from axisgate._connection import Connection
from axisgate._devices import choose
from axisgate._methods import GET_CALLER, REARM
from axisgate._session import DeviceSession
from axisgate.events import Event, Events
from axisgate.lease import Lease
from axisgate.v1 import access_pb2, control_pb2, device_pb2

_Self = TypeVar("_Self", bound="Device")


class Device:
    """A Device is the connection to one device of a daemon. All functions are thread safe.

    Every function raises Refused if the daemon refuses a request: nothing moved.
    """

    _capability: int

    def __init__(self, target: Optional[str] = None, *, device: Optional[str] = None, token: Optional[str] = None,
                 ca: Optional[str] = None, certificate: Optional[str] = None, key: Optional[str] = None,
                 timeout: float = 10.0) -> None:
        """Connects to the daemon.

        `target` is the path of a Unix socket, or HOST[:PORT]. None: $AXISGATE_TARGET, or the local daemon. `device` is
        the name of the device. None: the only one of its kind. `token` is the caller's token, or $AXISGATE_TOKEN. `ca`,
        `certificate` and `key` are files for TLS, or $AXISGATE_CA, $AXISGATE_CERTIFICATE and $AXISGATE_KEY. `timeout`
        is the time limit of each call in seconds. While it is in its first half, a request whose answer is lost is sent
        again; the daemon acts once.

        Raises Unavailable if no daemon answers, LookupError if there is no such device, and ValueError if the arguments
        contradict each other.
        """
        connection = Connection(_target.resolve(target, token, ca, certificate, key), timeout)
        try:
            found = choose(connection.open(), device, self._capability)
            self._session = DeviceSession(connection, found.name)
            self._opened(found)
        except BaseException:
            connection.close()
            raise

    def _opened(self, device: device_pb2.Device) -> None:
        """Takes the state of the device when the connection was opened."""

    @classmethod
    def find(cls, target: Optional[str] = None, *, token: Optional[str] = None, ca: Optional[str] = None,
             certificate: Optional[str] = None, key: Optional[str] = None, timeout: float = 10.0) -> List[str]:
        """Returns the names of the daemon's devices of this kind. The arguments are those of the class."""
        connection = Connection(_target.resolve(target, token, ca, certificate, key), timeout)
        try:
            return [device.name[len("devices/"):] for device in connection.open().devices
                    if cls._capability in device.capabilities]
        finally:
            connection.close()

    def close(self) -> None:
        """Closes the connection. Motions and jobs continue."""
        self._session.connection.close()

    def __enter__(self: _Self) -> _Self:
        return self

    def __exit__(self, kind: Optional[Type[BaseException]], error: Optional[BaseException],
                 trace: Optional[TracebackType]) -> None:
        self.close()

    def __repr__(self) -> str:
        return f"<{type(self).__name__} {self.name}>"

    @property
    def name(self) -> str:
        """Name of the device."""
        return self._session.device[len("devices/"):]

    def whoami(self) -> Tuple[str, str]:
        """Returns the caller's name and role, as the daemon identifies this program."""
        answer: Any = self._session.connection.ask(GET_CALLER, access_pb2.GetCallerRequest())
        return answer.caller.name, access_pb2.Role.Name(answer.role)[len("ROLE_"):].lower()

    def events(self, since: Union[None, int, Event] = None) -> Events:
        """Watches every event from now on, each once and in order, also over broken connections and restarts.

        With an event or a revision as `since`, the iterator begins after it; with 0 it begins at the oldest kept event.
        A Gap in the series means that events were missed.
        """
        return Events(self._session, since)

    def rearm(self) -> Tuple[int, ...]:
        """Allows motion after a stop by another caller. Returns the numbers of the axes that may move again."""
        answer = self._session.act(REARM, control_pb2.RearmRequest(device=self._session.device))
        return tuple(answer.axes)

    def lease(self, *axes: str, wait: float = 0.0, ttl: float = 10.0, at_loss: str = "stop",
              purpose: str = "") -> Lease:
        """Acquires the exclusive right to axes of a stage, or without arguments to the device: ``with
        stage.lease("x"):``.

        Waits at most `wait` seconds. The lease ends `ttl` seconds after the program or the connection has failed; a
        running motion is then stopped, or with `at_loss` "finish" ends first. Others see the `purpose`.

        Raises LeaseHeld if the axes are not free.
        """
        return lease.acquire(self._session, axes, wait, ttl, at_loss, purpose)
