"""Worker threads for rule functions that are plain functions.

All contexts of a process share them, and none may take them all. They are daemons: a function that hangs must not keep
the process from ending. (The standard library's pool joins its threads at exit.) But the end of the process waits a
while for those that are at work: a thread that the interpreter ends in the midst of a C++ library, loading a model for
instance, may take the whole process down with it.
"""

from __future__ import annotations

import atexit
import functools
import os
import threading
from collections import deque
from collections.abc import Callable

__all__ = ["CREW", "LAST_GRACE", "SHARE", "THREADS", "Crew", "Order", "Workers"]

Job = Callable[[], None]

LAST_GRACE = 5.0
"""Seconds for which the end of the process waits for functions at work."""

SHARE = 32
"""Functions of one context that are at work at once; further ones wait until one of them ends."""

THREADS = 256
"""Threads of the process; with all of them busy, whoever comes waits for one."""

IDLE = 30.0
"""Seconds after which a thread with nothing to do ends."""


class Crew:
    """The threads of the process: made when all others are busy, and kept for a while."""

    def __init__(self) -> None:
        self.begin()

    def begin(self) -> None:
        """Be without threads."""
        lock = threading.Lock()
        self.change = threading.Condition(lock)
        self.rest = threading.Condition(lock)
        self.at_work = 0
        self.contexts = 0
        self._jobs: deque[Job] = deque()
        self._idle = 0
        self._threads = 0
        self._number = 0

    def take(self, job: Job) -> None:
        """Have a job done soon; the caller holds `change`.

        Raises:
            RuntimeError: The system has no thread for it, and nobody is there who might do it later.
        """
        self._jobs.append(job)
        if self._idle >= len(self._jobs):
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

    def _live(self) -> None:
        while (job := self._next()) is not None:
            try:
                job()
            finally:
                del job  # and with it what it holds: a context, perhaps
                with self.change:
                    self.at_work -= 1
                    if not self.at_work:
                        self.rest.notify_all()

    def _next(self) -> Job | None:
        """Wait for a job; None if the thread is to end."""
        with self.change:
            while not self._jobs:
                self._idle += 1
                in_time = self.contexts > 0 and self.change.wait(IDLE)
                self._idle -= 1
                if not self._jobs and not (in_time and self.contexts):
                    self._threads -= 1
                    return None
            self.at_work += 1
            return self._jobs.popleft()


CREW = Crew()
if hasattr(os, "register_at_fork"):
    os.register_at_fork(after_in_child=CREW.begin)  # a forked process has none of the threads


@atexit.register
def _wait_for_work() -> None:
    with CREW.rest:
        CREW.rest.wait_for(lambda: not CREW.at_work, LAST_GRACE)


class Order:
    """A job that somebody waits for; told apart from others by what it is."""

    __slots__ = ("job",)

    def __init__(self, job: Job) -> None:
        self.job = job


class Workers:
    """One context's share of the threads, until `close`.

    Args:
        crew: The threads.
    """

    def __init__(self, crew: Crew = CREW) -> None:
        self._crew = crew
        self._at_work: set[Order] = set()
        self._line: deque[Order] = deque()
        self._open = True
        with self._crew.change:
            self._crew.contexts += 1

    def submit(self, job: Job) -> Order:
        """Have a job done soon. The job must not raise.

        Raises:
            RuntimeError: The system has no more threads.
        """
        order = Order(job)
        with self._crew.change:
            if len(self._at_work) < SHARE:
                self._begin(order)
            else:
                self._line.append(order)
        return order

    def let_go(self, order: Order) -> None:
        """Nobody waits for a job any more: if it hangs, another has its place."""
        with self._crew.change:
            if order in self._line:
                self._line.remove(order)
            elif order in self._at_work:
                self._at_work.remove(order)
                if self._line:
                    self._begin(self._line.popleft())

    def close(self) -> None:
        """Do nothing more; what is being done goes on. If no other context is there, idle threads end."""
        with self._crew.change:
            self._line.clear()
            if self._open:
                self._open = False
                self._crew.contexts -= 1
                if not self._crew.contexts:
                    self._crew.change.notify_all()

    def _begin(self, order: Order) -> None:
        self._crew.take(functools.partial(self._work, order))
        self._at_work.add(order)

    def _work(self, order: Order) -> None:
        following: Order | None = order
        while following is not None:
            order, following = following, None
            try:
                order.job()
            finally:
                with self._crew.change:
                    if order in self._at_work:  # else another has its place already
                        self._at_work.remove(order)
                        if self._line:
                            following = self._line.popleft()
                            self._at_work.add(following)
