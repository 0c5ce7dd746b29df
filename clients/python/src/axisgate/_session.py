"""One device as a program uses it: its connection, its name, and the lease that the calls carry."""

from __future__ import annotations

import contextlib
import contextvars
import logging
import os
import time
from typing import Any, Callable, Iterator, List, Optional, Tuple

from axisgate._connection import Connection
from axisgate._methods import GET_DEVICE, LIST_MOTIONS
from axisgate._requests import duration
from axisgate.errors import AxisgateError
from axisgate.motion import Motion
from axisgate.results import Result
from axisgate.v1 import device_pb2, motion_pb2, stage_pb2

_log = logging.getLogger("axisgate")
_LEASE_VARIABLE = "AXISGATE_LEASE"
_TOKEN_BYTES = 24
FIND_ATTEMPTS = 3
"""Attempts to find a motion whose start was interrupted."""
FIND_PAUSE_S = 0.1
"""Time between these attempts in seconds."""


class LeaseScope:
    """A LeaseScope knows the lease that the calls of a thread or task carry. All functions are thread safe."""

    def __init__(self) -> None:
        self._leases: contextvars.ContextVar[Tuple[bytes, ...]] = contextvars.ContextVar("leases", default=())
        self._inherited = _inherited_token()

    def token(self) -> bytes:
        """Returns the token of the innermost lease of this thread or task, or that of `axisctl lease run`. Empty: no
        lease."""
        leases = self._leases.get()
        return leases[-1] if leases else self._inherited

    def enter_lease(self, token: bytes) -> None:
        """Makes the calls of this thread or task carry the token."""
        self._leases.set((*self._leases.get(), token))

    def leave_lease(self, token: bytes) -> None:
        """Ends enter_lease()."""
        self._leases.set(tuple(one for one in self._leases.get() if one != token))

    @contextlib.contextmanager
    def carrying(self, token: bytes) -> Iterator[None]:
        """Makes the calls of a block carry the token. An empty token changes nothing."""
        before = self._leases.get()
        if token:
            self.enter_lease(token)
        try:
            yield
        finally:
            self._leases.set(before)


class DeviceSession(LeaseScope):
    """A DeviceSession sends the requests for one device. All functions are thread safe."""

    def __init__(self, connection: Connection, device: str) -> None:
        super().__init__()
        self.connection = connection
        self.device = device

    def act(self, method: Any, request: Any, patience: float = 0.0) -> Any:
        """Sends a request that changes something, and returns its answer."""
        return self.connection.act(method, request, self.token(), patience)

    def read(self, max_age: Optional[float] = None) -> device_pb2.Device:
        """Returns the state of the device, which is read again if it is older than `max_age` seconds."""
        request = device_pb2.GetDeviceRequest(device=self.device,
                                              max_age=None if max_age is None else duration(max_age))
        answer: Any = self.connection.ask(GET_DEVICE, request)
        return answer.device  # type: ignore[no-any-return]

    def start(self, method: Any, request: Any) -> Motion:
        """Starts a motion."""
        return Motion(self, self.act(method, request).motion)

    def finish(self, method: Any, request: Any) -> Result:
        """Starts a motion and waits for its outcome. An interruption, such as Ctrl-C, cancels the motion."""
        ids: List[str] = []
        def start() -> motion_pb2.Motion:
            answer: Any = self.connection.act(method, request, self.token(), started=ids.append)
            return answer.motion  # type: ignore[no-any-return]
        return self._finish(start, ids)

    def _finish(self, start: Callable[[], motion_pb2.Motion], ids: List[str]) -> Result:
        motion: Optional[Motion] = None
        try:
            motion = Motion(self, start())
            return motion.wait()
        except Exception:
            raise
        except BaseException:
            self._cancel(motion, ids)
            raise

    def _cancel(self, motion: Optional[Motion], ids: List[str]) -> None:
        try:
            motion = motion or self._find(ids)
            if motion is not None:
                motion.cancel()
        except AxisgateError as failure:  # the interruption is raised
            _log.warning("the motion was not cancelled: %s", failure)

    def _find(self, ids: List[str]) -> Optional[Motion]:
        """Returns the motion of a request whose answer did not arrive, if there is one."""
        if not ids:
            return None
        for _ in range(FIND_ATTEMPTS):
            request = stage_pb2.ListMotionsRequest(device=self.device, request_id=ids[0])
            for one in self.connection.ask(LIST_MOTIONS, request).motions:
                return Motion(self, one)
            time.sleep(FIND_PAUSE_S)
        return None


def _inherited_token() -> bytes:
    text = os.environ.get(_LEASE_VARIABLE, "")
    try:
        token = bytes.fromhex(text)
    except ValueError:
        token = b"?"
    if token and len(token) != _TOKEN_BYTES:
        raise ValueError(f"{_LEASE_VARIABLE} is not the token of a lease: unset it, or use `axisctl lease run`")
    return token
