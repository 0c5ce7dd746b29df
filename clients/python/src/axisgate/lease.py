"""Leases: the right to move some axes, until it is released, expires or is lost."""

from __future__ import annotations

import logging
import threading
import time
from types import TracebackType
from typing import Callable, List, Optional, Sequence, Tuple, Type

from axisgate._keeping import Keeping
from axisgate._methods import ACQUIRE_LEASE, HAND_OVER_LEASE, RELEASE_LEASE, RENEW_LEASE
from axisgate._requests import acquire_lease
from axisgate._session import DeviceSession
from axisgate.errors import AxisgateError
from axisgate.v1 import control_pb2

_log = logging.getLogger("axisgate")


class Lease:
    """A Lease is kept alive by a thread of its own until its block ends::

        with stage.lease("x", "y", purpose="scan of sample 12") as lease:
            stage.move_to(x=1 * mm)

    The calls of the stage inside the block carry the lease, in the thread or task that entered the block. A lease is
    lost if it cannot be kept alive, or if an administrator takes the axes over. Motion inside the block then fails with
    LeaseLost. All functions are thread safe.
    """

    def __init__(self, session: DeviceSession, lease: control_pb2.Lease, ttl: float) -> None:
        self._session = session
        self._keeping = Keeping(session.device, lease.token, ttl, time.monotonic())
        self.token: bytes = lease.token
        """Token of the lease. It is a secret: every program that has it can use the lease."""
        self.axes: Tuple[int, ...] = tuple(lease.axes)
        """Numbers of the axes."""
        self._ended = threading.Event()
        self._lock = threading.Lock()
        self._problem: Optional[AxisgateError] = None
        self._callbacks: List[Callable[[Lease], object]] = []
        self._keeper = threading.Thread(target=self._keep, name="axisgate lease", daemon=True)
        self._keeper.start()

    @property
    def lost(self) -> bool:
        """True if the lease was lost."""
        return self._problem is not None

    @property
    def problem(self) -> Optional[AxisgateError]:
        """Reason why the lease was lost. None: it was not lost."""
        return self._problem

    def on_lost(self, function: Callable[[Lease], object]) -> None:
        """Calls `function(lease)` from another thread once the lease is lost; at once, if it is lost already."""
        with self._lock:
            if self._problem is None:
                return self._callbacks.append(function)
        function(self)

    def hand_over(self, who: str) -> None:
        """Gives the axes to a waiting caller, such as "unix anna". The lease ends.

        Raises Refused if this caller does not wait for exactly these axes, or while a motion runs under the lease.
        """
        self._send(HAND_OVER_LEASE, control_pb2.HandOverLeaseRequest(device=self._session.device, caller=who))
        self._end()

    def release(self) -> None:
        """Ends the lease. A motion that runs under it continues."""
        if self._end() and not self.lost:
            self._send(RELEASE_LEASE, control_pb2.ReleaseLeaseRequest(device=self._session.device))

    def __enter__(self) -> Lease:
        self._session.enter_lease(self.token)
        return self

    def __exit__(self, kind: Optional[Type[BaseException]], error: Optional[BaseException],
                 trace: Optional[TracebackType]) -> None:
        self._session.leave_lease(self.token)
        try:
            self.release()
        except AxisgateError as failure:  # the lease ends when it expires
            _log.warning("the lease was not released: %s", failure)

    def _send(self, method: object, request: object) -> None:
        self._session.connection.act(method, request, self.token)  # type: ignore[arg-type]

    def _end(self) -> bool:
        """Ends the keeper. Returns False if it had ended."""
        was_ended = self._ended.is_set()
        self._ended.set()
        self._keeper.join()
        return not was_ended

    def _keep(self) -> None:
        while not self._ended.wait(self._keeping.every_s):
            try:
                self._session.connection.ask(RENEW_LEASE, self._keeping.request, patience=0.0)
                self._keeping.renewed(time.monotonic())
            except (AxisgateError, RuntimeError) as error:
                problem = self._keeping.loss_after(error, time.monotonic())
                if problem is not None:
                    return self._lose(problem)

    def _lose(self, error: AxisgateError) -> None:
        _log.warning("the lease was lost: %s", error)
        with self._lock:
            self._problem = error
            callbacks, self._callbacks = self._callbacks, []
        for function in callbacks:
            function(self)


def acquire(session: DeviceSession, axes: Sequence[str], wait: float, ttl: float, at_loss: str, purpose: str) -> Lease:
    """Acquires a lease. See Stage.lease()."""
    request = acquire_lease(session.device, axes, wait, ttl, at_loss, purpose)
    return Lease(session, session.act(ACQUIRE_LEASE, request, wait).lease, ttl)
