"""The newest state of a device, again and again, and recordings of positions."""

from __future__ import annotations

import csv
import threading
from decimal import Decimal
from types import TracebackType
from typing import Any, List, Optional, Tuple, Type

from axisgate._methods import WATCH_DEVICE
from axisgate._requests import duration
from axisgate._session import DeviceSession
from axisgate._stream import ResumingStream
from axisgate.state import Status, status_of
from axisgate.v1 import device_pb2

Row = Tuple[Optional[Decimal], ...]


class States(ResumingStream[Status]):
    """States is the iterator of Stage.watch(). Iterate in one thread; close() may be called from any thread."""

    def __init__(self, session: DeviceSession, min_interval: float) -> None:
        self._watch = device_pb2.WatchDeviceRequest(device=session.device, min_interval=duration(min_interval))
        super().__init__(session.connection, WATCH_DEVICE)

    def _request(self) -> device_pb2.WatchDeviceRequest:
        return self._watch

    def _take(self, answer: device_pb2.WatchDeviceResponse) -> Status:
        return status_of(answer.device)


class Samples:
    """Samples are positions that were recorded while their block lasted::

        with stage.sample() as samples:
            stage["x"].move_to(1 * mm)
        samples.to_csv("move.csv")

    Each row has the time of a reading in seconds since the first, and the positions of the axes in their units. The
    daemon reads about ten times a second during motion. Read the rows after the block.
    """

    def __init__(self, session: DeviceSession, interval: float) -> None:
        self._session = session
        self._interval = interval
        self._first_ns: Optional[int] = None
        self.axes: Tuple[str, ...] = ()
        """Names of the axes."""
        self.times: List[float] = []
        """Times of the rows in seconds."""
        self.positions: List[Row] = []
        """Positions of the rows, one for each axis. None: unknown."""

    def __enter__(self) -> Samples:
        self._states = States(self._session, self._interval)
        self._recorder = threading.Thread(target=self._record, name="axisgate samples", daemon=True)
        self._recorder.start()
        return self

    def __exit__(self, kind: Optional[Type[BaseException]], error: Optional[BaseException],
                 trace: Optional[TracebackType]) -> None:
        self._states.close()
        self._recorder.join()

    def __len__(self) -> int:
        return len(self.times)

    def __array__(self, dtype: Any = None, copy: Any = None) -> Any:
        """Returns a NumPy array: a column of times, then a column for each axis."""
        import numpy
        rows = [[time, *(float("nan") if value is None else float(value) for value in row)]
                for time, row in zip(self.times, self.positions)]
        return numpy.array(rows, dtype=dtype or float)

    def to_csv(self, path: str) -> None:
        """Writes the rows to a file, with the names of the columns in its first line."""
        with open(path, "w", encoding="utf-8", newline="") as file:
            writer = csv.writer(file)
            writer.writerow(("time", *self.axes))
            writer.writerows((time, *row) for time, row in zip(self.times, self.positions))

    def _record(self) -> None:
        for state in self._states:
            if state.message.HasField("read_time"):
                self._add(state, state.message.read_time.ToNanoseconds())

    def _add(self, state: Status, read_ns: int) -> None:
        if self._first_ns is None:
            self._first_ns = read_ns
            self.axes = tuple(state.axes)
        time = (read_ns - self._first_ns) / 1e9
        if not self.times or time > self.times[-1]:
            self.times.append(time)
            self.positions.append(tuple(axis.position.value for axis in state.axes.values()))
