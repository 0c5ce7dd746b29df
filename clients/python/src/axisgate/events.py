"""Events: every change of a device, each once and in order."""

from __future__ import annotations

from dataclasses import dataclass
from datetime import datetime, timezone
from typing import Any, Optional, Union

from axisgate._cursor import Cursor
from axisgate._methods import LIST_DEVICES, WATCH_EVENTS
from axisgate._outcomes import Failure
from axisgate._session import DeviceSession
from axisgate._stream import ResumingStream
from axisgate.v1 import device_pb2, event_pb2


@dataclass(frozen=True)
class Event:
    """One event. `kind` is the name of the fact, such as "motion", "stop_requested" or "condition"; it is empty for a
    fact of a newer daemon. `fact` is the API's message of it. `device` is empty for an event of the daemon itself."""

    revision: int
    time: datetime
    device: str
    kind: str
    fact: Any
    run: str


@dataclass(frozen=True)
class Gap:
    """Events were missed, because they are no longer kept. Watching continues at the event `resume_revision`."""

    resume_revision: int


class Events(ResumingStream[Union[Event, Gap]]):
    """Events is the iterator of Stage.events(). Iterate in one thread; close() may be called from any thread."""

    def __init__(self, session: DeviceSession, since: Union[None, int, Event]) -> None:
        self._cursor = _cursor_after(session, since)
        super().__init__(session.connection, WATCH_EVENTS)

    def _request(self) -> event_pb2.WatchRequest:
        return self._cursor.request()

    def _take(self, answer: event_pb2.WatchResponse) -> Event:
        self._cursor.take(answer.event)
        return event_of(answer.event)

    def _skip(self, failure: Failure) -> Optional[Gap]:
        resume = self._cursor.gap_after(failure)
        return None if resume is None else Gap(resume)


def _cursor_after(session: DeviceSession, since: Union[None, int, Event]) -> Cursor:
    if since is not None:
        return cursor_since(session.device, since)
    return cursor_now(session.device, session.connection.ask(LIST_DEVICES, device_pb2.ListDevicesRequest()))


def cursor_since(device: str, since: Union[int, Event]) -> Cursor:
    """Returns the place after an event or a revision. After 0, all kept events follow."""
    if isinstance(since, Event):
        return Cursor(device, since.revision + 1, since.run)
    return Cursor(device, since + 1 if since > 0 else 0, "")


def cursor_now(device: str, listed: device_pb2.ListDevicesResponse) -> Cursor:
    """Returns the place after all events until the answer `listed`."""
    return Cursor(device, listed.next_revision, listed.run)


def event_of(event: event_pb2.Event) -> Event:
    """Returns the event of a message."""
    kind = event.WhichOneof("fact") or ""
    time = datetime.fromtimestamp(event.time.ToNanoseconds() / 1e9, timezone.utc)
    return Event(event.revision, time, event.device[len("devices/"):], kind, getattr(event, kind) if kind else None,
                 event.run)
