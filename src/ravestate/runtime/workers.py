"""Worker threads for rule functions that are plain functions.

They are daemons: a function that hangs must not keep the process from ending. (The standard library's
pool joins its threads at exit.)
"""

from __future__ import annotations

import threading
from collections.abc import Callable
from queue import SimpleQueue

__all__ = ["Workers"]

Job = Callable[[], None]


class Workers:
    """Threads that are made when all others are busy, and kept until `close`."""

    def __init__(self) -> None:
        self._jobs: SimpleQueue[Job | None] = SimpleQueue()
        self._idle = threading.Semaphore(0)
        self._count = 0

    def submit(self, job: Job) -> None:
        """Have a job done soon. The job must not raise."""
        self._jobs.put(job)
        if not self._idle.acquire(blocking=False):
            self._count += 1
            threading.Thread(target=self._work, name=f"ravestate-{self._count}", daemon=True).start()

    def close(self) -> None:
        """Let every thread end after what it is doing."""
        for _ in range(self._count):
            self._jobs.put(None)

    def _work(self) -> None:
        while (job := self._jobs.get()) is not None:
            job()
            self._idle.release()
