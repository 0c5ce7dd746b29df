"""The place in the series of events from which a watcher resumes. Nothing here sends."""

from __future__ import annotations

from typing import Optional

from axisgate._outcomes import Failure
from axisgate.v1 import event_pb2


class Cursor:
    """A Cursor knows the first event that a watcher has not received yet.

    `first` is its revision. 0: all kept events. `run` is the run of the event before it, or empty.
    """

    def __init__(self, device: str, first: int, run: str) -> None:
        self._device = device
        self.first = first
        self._run = run

    def request(self) -> event_pb2.WatchRequest:
        """Returns the request for all events from here on."""
        return event_pb2.WatchRequest(device=self._device, from_revision=self.first, run=self._run)

    def take(self, event: event_pb2.Event) -> None:
        """Moves past an event."""
        self.first, self._run = event.revision + 1, event.run

    def gap_after(self, failure: Failure) -> Optional[int]:
        """Returns the revision at which watching continues because earlier events are no longer kept. None: no gap."""
        if failure.reason != "COMPACTED" or failure.problem is None:
            return None
        self.first, self._run = int(failure.problem.metadata["resume_revision"]), ""
        return self.first
