"""Worker threads for rule functions that are plain functions.

They are daemons: a function that hangs must not keep the process from ending. (The standard library's
pool joins its threads at exit.) But the end of the process waits a while for those that are at work: a thread that the
interpreter ends in the midst of a C++ library, loading a model for instance, may take the whole process down with it.
"""

from __future__ import annotations

import atexit
import threading
from collections.abc import Callable
from queue import SimpleQueue

__all__ = ["LAST_GRACE", "Workers"]

Job = Callable[[], None]

LAST_GRACE = 5.0
"""Seconds for which the end of the process waits for functions at work."""

_at_work = 0
_change = threading.Condition()


@atexit.register
def _wait_for_work() -> None:
    with _change:
        _change.wait_for(lambda: not _at_work, LAST_GRACE)


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
        global _at_work
        while (job := self._jobs.get()) is not None:
            with _change:
                _at_work += 1
            try:
                job()
            finally:
                with _change:
                    _at_work -= 1
                    _change.notify_all()
            self._idle.release()
