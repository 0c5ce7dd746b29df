"""One device as an asyncio program uses it: its connection, its name, and the lease that the calls carry."""

from __future__ import annotations

import asyncio
import logging
from typing import Any, List, Optional

from axisgate._methods import GET_DEVICE, LIST_MOTIONS
from axisgate._requests import duration
from axisgate._session import FIND_ATTEMPTS, FIND_PAUSE_S, LeaseScope
from axisgate.aio._connection import Connection
from axisgate.aio.motion import Motion
from axisgate.errors import AxisgateError
from axisgate.results import Result
from axisgate.v1 import device_pb2, stage_pb2

_log = logging.getLogger("axisgate")


class DeviceSession(LeaseScope):
    """A DeviceSession sends the requests for one device."""

    def __init__(self, connection: Connection, device: str) -> None:
        super().__init__()
        self.connection = connection
        self.device = device

    async def act(self, method: Any, request: Any, patience: float = 0.0) -> Any:
        """Sends a request that changes something, and returns its answer."""
        return await self.connection.act(method, request, self.token(), patience)

    async def read(self, max_age: Optional[float] = None) -> device_pb2.Device:
        """Returns the state of the device, which is read again if it is older than `max_age` seconds."""
        request = device_pb2.GetDeviceRequest(device=self.device,
                                              max_age=None if max_age is None else duration(max_age))
        answer = await self.connection.ask(GET_DEVICE, request)
        return answer.device  # type: ignore[no-any-return]

    async def start(self, method: Any, request: Any) -> Motion:
        """Starts a motion."""
        return Motion(self, (await self.act(method, request)).motion)

    async def finish(self, method: Any, request: Any) -> Result:
        """Starts a motion and waits for its outcome. The motion is cancelled if the task is."""
        ids: List[str] = []
        motion: Optional[Motion] = None
        try:
            answer = await self.connection.act(method, request, self.token(), started=ids.append)
            motion = Motion(self, answer.motion)
            return await motion.wait()
        except asyncio.CancelledError:
            await self.connection.tasks.finish(self._cancel(motion, ids), "cancel")
            raise

    async def _cancel(self, motion: Optional[Motion], ids: List[str]) -> None:
        try:
            motion = motion or await self._find(ids)
            if motion is not None:
                await motion.cancel()
        except (AxisgateError, RuntimeError) as failure:  # the cancellation is raised
            _log.warning("the motion was not cancelled: %s", failure)

    async def _find(self, ids: List[str]) -> Optional[Motion]:
        """Returns the motion of a request whose answer did not arrive, if there is one."""
        if not ids:
            return None
        for _ in range(FIND_ATTEMPTS):
            request = stage_pb2.ListMotionsRequest(device=self.device, request_id=ids[0])
            for one in (await self.connection.ask(LIST_MOTIONS, request)).motions:
                return Motion(self, one)
            await asyncio.sleep(FIND_PAUSE_S)
        return None
