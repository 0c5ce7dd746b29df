"""The tasks that a Stage has started."""

from __future__ import annotations

import asyncio
from typing import Any, Coroutine, Set


class Tasks:
    """Tasks are what runs in the background until it ends, or until end()."""

    def __init__(self) -> None:
        self._to_cancel: Set[asyncio.Task[None]] = set()
        self._to_finish: Set[asyncio.Task[None]] = set()

    def start(self, work: Coroutine[Any, Any, None], name: str) -> asyncio.Task[None]:
        """Starts a task that end() cancels."""
        return _start(work, name, self._to_cancel)

    async def finish(self, work: Coroutine[Any, Any, None], name: str) -> None:
        """Waits for a task that is not cancelled when the caller is. end() waits for it."""
        await asyncio.shield(_start(work, name, self._to_finish))

    async def end(self) -> None:
        """Ends all tasks."""
        own = {asyncio.current_task()}
        for task in self._to_cancel - own:
            task.cancel()
        ending = (self._to_cancel | self._to_finish) - own
        if ending:
            await asyncio.wait(ending)


def _start(work: Coroutine[Any, Any, None], name: str, tasks: Set[asyncio.Task[None]]) -> asyncio.Task[None]:
    task = asyncio.get_running_loop().create_task(work, name=f"axisgate {name}")
    tasks.add(task)
    task.add_done_callback(tasks.discard)
    return task


def is_being_cancelled() -> bool:
    """Reports whether somebody cancelled the present task. False before Python 3.11, which does not know."""
    task: Any = asyncio.current_task()
    return bool(getattr(task, "cancelling", int)())
