"""Outcomes of actions as bluesky's plans await them."""

from __future__ import annotations

import contextlib
import logging
import threading
import time
from typing import Callable, Iterator, List, Optional

from axisgate.axis import Axis
from axisgate.errors import AxisgateError, Stopped
from axisgate.motion import Motion
from axisgate.results import Result

_log = logging.getLogger("axisgate")
_WATCH_EVERY_S = 0.1


class Status:
    """A Status tells bluesky when an action has ended, and how. All functions are thread safe."""

    def __init__(self, device: str) -> None:
        self._device = device
        self._ended = threading.Event()
        self._lock = threading.Lock()
        self._error: Optional[BaseException] = None
        self._callbacks: List[Callable[[Status], None]] = []

    @property
    def done(self) -> bool:
        """True once the action has ended."""
        return self._ended.is_set()

    @property
    def success(self) -> bool:
        """True once the action has ended without an error."""
        return self.done and self._error is None

    def exception(self, timeout: Optional[float] = 0.0) -> Optional[BaseException]:
        """Returns the error, or None after success. Raises TimeoutError if the action does not end within `timeout`
        seconds."""
        if not self._ended.wait(timeout):
            raise TimeoutError(f"{self._device} has not ended after {timeout} s")
        return self._error

    def wait(self, timeout: Optional[float] = None) -> None:
        """Waits for the end, and raises its error."""
        error = self.exception(timeout)
        if error is not None:
            raise error

    def add_callback(self, function: Callable[[Status], None]) -> None:
        """Calls `function(status)` from another thread once the action has ended; at once, if it has ended already."""
        with self._lock:
            if not self.done:
                return self._callbacks.append(function)
        function(self)

    def watch(self, function: Callable[..., object]) -> None:
        """Calls `function` with the progress about ten times a second, as a progress bar of bluesky needs it."""

    def finish(self, error: Optional[BaseException] = None) -> None:
        """Ends the action with an error, or with success."""
        with self._lock:
            self._error = error
            self._ended.set()
            callbacks, self._callbacks = self._callbacks, []
        for function in callbacks:
            function(self)

    def __repr__(self) -> str:
        state = "in progress" if not self.done else "done" if self._error is None else f"failed: {self._error}"
        return f"<Status of {self._device}: {state}>"


class MotionStatus(Status):
    """A MotionStatus is the outcome of a motion. `result` is its result after success."""

    def __init__(self, device: str, axis: Axis, motion: Motion, target: Optional[float] = None) -> None:
        super().__init__(device)
        self.result: Optional[Result] = None
        self._axis = axis
        self._motion = motion
        self._target = target
        self._watchers: List[Callable[..., object]] = []
        self._stop_succeeds = False
        in_thread(self._follow, device)

    def expect_stop(self, success: bool) -> None:
        """Decides whether a stop counts as success from now on."""
        self._stop_succeeds = success

    def watch(self, function: Callable[..., object]) -> None:
        with self._lock:
            self._watchers.append(function)
            first = len(self._watchers) == 1
        if first:
            in_thread(self._watch, self._device)

    def _follow(self) -> None:
        error: Optional[BaseException] = None
        try:
            self.result = self._motion.wait()
        except Stopped as stopped:
            error = None if self._stop_succeeds else stopped
        except Exception as failure:  # the plan raises it
            error = failure
        self.finish(error)

    def _watch(self) -> None:
        begun, initial = time.monotonic(), None
        with until_it_fails(self._device):
            for progress in self._motion.progress(_WATCH_EVERY_S):
                position = progress.positions.get(self._axis.name)
                if position is None or position.value is None:
                    continue
                current = float(position.value)
                initial = current if initial is None else initial
                for function in list(self._watchers):
                    function(name=self._device, current=current, initial=initial, target=self._target,
                             unit=str(self._axis.unit), time_elapsed=time.monotonic() - begun)


def succeeded(device: str) -> Status:
    """Returns a status that has ended with success."""
    status = Status(device)
    status.finish()
    return status


def in_thread(work: Callable[[], None], name: str) -> None:
    """Does the work in a thread that does not keep the program alive."""
    threading.Thread(target=work, name=f"axisgate {name}", daemon=True).start()


@contextlib.contextmanager
def until_it_fails(device: str) -> Iterator[None]:
    """Ends the block without an exception if the daemon or the Stage fails it."""
    try:
        yield
    except (AxisgateError, RuntimeError) as error:
        _log.debug("%s is not watched: %s", device, error)
