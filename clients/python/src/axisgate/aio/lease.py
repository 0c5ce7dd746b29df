"""Leases in the asyncio form."""

from __future__ import annotations

import asyncio
import logging
import time
from types import TracebackType
from typing import Callable, List, Optional, Tuple, Type

from axisgate._keeping import Keeping
from axisgate._methods import ACQUIRE_LEASE, HAND_OVER_LEASE, RELEASE_LEASE, RENEW_LEASE
from axisgate.aio._session import DeviceSession
from axisgate.errors import AxisgateError
from axisgate.v1 import control_pb2

_log = logging.getLogger("axisgate")


class Lease:
    """A Lease is acquired when its block begins, and kept alive by a task until it ends::

        async with stage.lease("x", "y", purpose="scan of sample 12") as lease:
            await stage.move_to(x=1 * mm)

    The calls of the stage inside the block carry the lease, in the task that entered the block and in the tasks that it
    starts there. A lease is lost if it cannot be kept alive, or if an administrator takes the axes over. Motion inside
    the block then fails with LeaseLost. ``lease = await stage.lease("x").acquire()`` is the form without a block; its
    calls do not carry the lease.
    """

    def __init__(self, session: DeviceSession, request: control_pb2.AcquireLeaseRequest, wait: float,
                 ttl: float) -> None:
        self._session = session
        self._request = request
        self._wait = wait
        self._ttl = ttl
        self.token = b""
        """Token of the lease. It is a secret: every program that has it can use the lease. Empty before acquire()."""
        self.axes: Tuple[int, ...] = ()
        """Numbers of the axes. Empty before acquire()."""
        self._keeper: Optional[asyncio.Task[None]] = None
        self._problem: Optional[AxisgateError] = None
        self._callbacks: List[Callable[[Lease], object]] = []

    @property
    def lost(self) -> bool:
        """True if the lease was lost."""
        return self._problem is not None

    @property
    def problem(self) -> Optional[AxisgateError]:
        """Reason why the lease was lost. None: it was not lost."""
        return self._problem

    async def acquire(self) -> Lease:
        """Acquires the lease. Raises LeaseHeld if the axes are not free."""
        if self.token:
            raise RuntimeError("this lease was acquired before: call stage.lease() again")
        lease = (await self._session.act(ACQUIRE_LEASE, self._request, self._wait)).lease
        self.token, self.axes = lease.token, tuple(lease.axes)
        keeping = Keeping(self._session.device, self.token, self._ttl, time.monotonic())
        self._keeper = self._session.connection.tasks.start(self._keep(keeping), "lease")
        return self

    def on_lost(self, function: Callable[[Lease], object]) -> None:
        """Calls `function(lease)` once the lease is lost; at once, if it is lost already."""
        if self._problem is None:
            self._callbacks.append(function)
        else:
            function(self)

    async def hand_over(self, who: str) -> None:
        """Gives the axes to a waiting caller, such as "unix anna". The lease ends.

        Raises Refused if this caller does not wait for exactly these axes, or while a motion runs under the lease.
        """
        await self._send(HAND_OVER_LEASE, control_pb2.HandOverLeaseRequest(device=self._session.device, caller=who))
        await self._end()

    async def release(self) -> None:
        """Ends the lease. A motion that runs under it continues."""
        if await self._end() and not self.lost:
            await self._send(RELEASE_LEASE, control_pb2.ReleaseLeaseRequest(device=self._session.device))

    async def __aenter__(self) -> Lease:
        await self.acquire()
        self._session.enter_lease(self.token)
        return self

    async def __aexit__(self, kind: Optional[Type[BaseException]], error: Optional[BaseException],
                        trace: Optional[TracebackType]) -> None:
        self._session.leave_lease(self.token)
        await self._session.connection.tasks.finish(self._release_quietly(), "release")

    async def _release_quietly(self) -> None:
        try:
            await self.release()
        except (AxisgateError, RuntimeError) as failure:  # the lease ends when it expires
            _log.warning("the lease was not released: %s", failure)

    async def _send(self, method: object, request: object) -> None:
        await self._session.connection.act(method, request, self.token)  # type: ignore[arg-type]

    async def _end(self) -> bool:
        """Ends the keeper. Returns False if it had ended."""
        keeper, self._keeper = self._keeper, None
        if keeper is None:
            return False
        keeper.cancel()
        await asyncio.wait([keeper])
        return True

    async def _keep(self, keeping: Keeping) -> None:
        while self._problem is None:
            await asyncio.sleep(keeping.every_s)
            try:
                await self._session.connection.ask(RENEW_LEASE, keeping.request, patience=0.0)
                keeping.renewed(time.monotonic())
            except (AxisgateError, RuntimeError) as error:
                problem = keeping.loss_after(error, time.monotonic())
                if problem is not None:
                    self._lose(problem)

    def _lose(self, error: AxisgateError) -> None:
        _log.warning("the lease was lost: %s", error)
        self._problem = error
        callbacks, self._callbacks = self._callbacks, []
        for function in callbacks:
            function(self)
