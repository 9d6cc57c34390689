"""Worker threads for rules that are plain functions.

All contexts of a process share one pool of threads, and no context may take them all. The threads are daemons, so
that the process can end even if a function hangs. (The standard library's pool joins its threads at exit.)

When the process ends, it still waits up to `LAST_GRACE` seconds for running functions. A thread may be inside a C++
library, for instance to load a model. If the interpreter ended such a thread, the whole process might crash.
"""

from __future__ import annotations

import atexit
import os
import threading
from collections import deque
from collections.abc import Callable
from dataclasses import dataclass, field
from time import monotonic

LAST_GRACE = 5.0  # when the process ends, it waits this many seconds for running functions

SHARE = 32
"""The maximum number of functions of one context that run at a time; further functions wait until one of them ends.

An abandoned function (`JobQueue.abandon`) does not count, even while it runs on.
"""

THREADS = 256  # the maximum number of worker threads in the process; if all are busy, further jobs wait
IDLE = 30.0  # a worker thread ends if it has had no job for this many seconds


@dataclass(slots=True, eq=False)
class Job:
    """A function to call in a worker thread, for the rule `name`; the function must not raise.

    `made` is the time of the job's submission, and `began` the time when a thread took it (seconds on the monotonic
    clock).
    """

    queue: JobQueue
    call: Callable[[], None]
    name: str
    made: float = field(init=False, default_factory=lambda: monotonic())
    began: float | None = field(init=False, default=None)


class ThreadPool:
    """The worker threads of the process. If all are busy, a new job gets a new thread, up to `THREADS` threads."""

    def __init__(self) -> None:
        self.reset()

    def reset(self) -> None:
        """Set the pool to its initial state, without threads and jobs."""
        lock = threading.Lock()
        self.change = threading.Condition(lock)  # wakes idle threads for a job, or because the last context ends
        self.rest = threading.Condition(lock)  # wakes the ending process when no job runs
        self.contexts = 0  # the number of contexts with an open queue
        self.at_work: set[Job] = set()
        self._jobs: deque[Job] = deque()
        self._free = 0
        self._threads = 0
        self._number = 0

    def take(self, job: Job) -> None:
        """Queue a job for the threads. The caller must hold the lock of `change`.

        Raises:
            RuntimeError: The system refuses a new thread, and the pool has no thread that could do the job later.
        """
        self._jobs.append(job)
        if self._free >= len(self._jobs):
            self.change.notify()
        elif self._threads < THREADS:
            self._number += 1
            thread = threading.Thread(target=self._live, name=f"ravestate-{self._number}", daemon=True)
            try:
                thread.start()
            except RuntimeError:
                if not self._threads:
                    self._jobs.pop()
                    raise
            else:
                self._threads += 1
                self._free += 1

    def is_full(self) -> bool:
        """Return whether there are more jobs than free threads. The caller must hold the lock of `change`."""
        return len(self._jobs) > self._free

    def _live(self) -> None:
        while (job := self._next()) is not None:
            try:
                job.call()
            finally:
                with self.change:
                    self._free += 1
                    self.at_work.remove(job)
                    self._jobs.extend(job.queue.done(job))  # this thread is free for the next job
                    if not self.at_work:
                        self.rest.notify_all()
                del job  # a reference to the job might keep a whole context alive

    def _next(self) -> Job | None:
        """Wait for a job, and return it; return None if the thread must end."""
        with self.change:
            while not self._jobs:
                in_time = self.contexts > 0 and self.change.wait(IDLE)
                if not self._jobs and not (in_time and self.contexts):
                    self._threads -= 1
                    self._free -= 1
                    return None
            self._free -= 1
            job = self._jobs.popleft()
            job.began = monotonic()
            self.at_work.add(job)
            return job


POOL = ThreadPool()
if hasattr(os, "register_at_fork"):
    os.register_at_fork(after_in_child=POOL.reset)  # a forked process has none of its parent's threads


@atexit.register
def _wait_for_work() -> None:
    with POOL.rest:
        POOL.rest.wait_for(lambda: not POOL.at_work, LAST_GRACE)


class JobQueue:
    """The jobs of one context. At most `SHARE` of them are in the pool at a time; the others wait in this queue."""

    def __init__(self, pool: ThreadPool = POOL) -> None:
        self._pool = pool
        self._begun: set[Job] = set()
        self._waiting: deque[Job] = deque()
        self._open = True
        with self._pool.change:
            self._pool.contexts += 1

    def submit(self, call: Callable[[], None], name: str = "") -> Job:
        """Queue a job that calls `call` for the rule `name`, and return the job.

        Raises:
            RuntimeError: The system refuses a new thread, and the pool has no thread.
        """
        job = Job(self, call, name)
        with self._pool.change:
            if len(self._begun) < SHARE:
                self._pool.take(job)
                self._begun.add(job)
            else:
                self._waiting.append(job)
        return job

    def abandon(self, job: Job) -> None:
        """Drop a job that waits in this queue. A job in the pool may run on, but the next job gets its place."""
        with self._pool.change:
            if job in self._waiting:
                self._waiting.remove(job)
            else:
                for following in self.done(job):
                    self._pool.take(following)

    def done(self, job: Job) -> list[Job]:
        """Give a job's place in the pool to the next job. Return a list with that job, or an empty list.

        The caller must hold the lock of the pool's `change`.
        """
        if job not in self._begun:  # the job was abandoned, so another job has its place already
            return []
        self._begun.remove(job)
        following = [self._waiting.popleft()] if self._waiting else []
        self._begun.update(following)
        return following

    def is_full(self) -> bool:
        """Return whether a job has to wait until another job ends."""
        with self._pool.change:
            return bool(self._waiting) or self._pool.is_full()

    def holders(self) -> list[Job]:
        """Return the running jobs that make other jobs wait.

        If this context's share is full, these are its running jobs. Otherwise, they are those of all contexts.
        """
        with self._pool.change:
            full = len(self._begun) >= SHARE
            return [job for job in self._pool.at_work if not full or job in self._begun]

    def close(self) -> None:
        """Drop the jobs that wait in this queue. If no other context has an open queue, idle threads end."""
        with self._pool.change:
            self._waiting.clear()
            if self._open:
                self._open = False
                self._pool.contexts -= 1
                if not self._pool.contexts:
                    self._pool.change.notify_all()
