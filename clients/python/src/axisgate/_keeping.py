"""The policy by which a lease is kept alive, as a state machine without a clock or a connection."""

from __future__ import annotations

from typing import Optional

from axisgate.errors import AxisgateError, LeaseLost, Unavailable
from axisgate.v1 import common_pb2, control_pb2


class Keeping:
    """A Keeping decides after each failed renewal whether the lease is lost. `now` is the time of its last renewal."""

    def __init__(self, device: str, token: bytes, ttl_s: float, now: float) -> None:
        self._ttl_s = ttl_s
        self._kept = now
        self.every_s = ttl_s / 3
        """Time between two renewals in seconds."""
        self.request = control_pb2.RenewLeaseRequest(device=device, context=common_pb2.CallContext(lease_token=token))
        """Request that renews the lease."""

    def renewed(self, now: float) -> None:
        """Takes the answer to a renewal."""
        self._kept = now

    def loss_after(self, error: Exception, now: float) -> Optional[AxisgateError]:
        """Returns the reason why the lease is lost after a failed renewal. None: it may still be renewed."""
        if isinstance(error, Unavailable) or (isinstance(error, AxisgateError) and error.reason == "QUEUE_FULL"):
            if now - self._kept <= self._ttl_s:
                return None
            return LeaseLost("LEASE_LOST", f"the lease has expired: {error.message}", error.hint)
        return error if isinstance(error, AxisgateError) else LeaseLost("LEASE_LOST", str(error))
