"""The worker thread of a store, shared by all contexts of the process."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable
from concurrent.futures import Future
from queue import Empty, SimpleQueue
from typing import TypeVar

from .store import Store

T = TypeVar("T")

PAUSE = 0.5
"""After this many seconds without a job, the store does its postponed work."""

LONGEST = 10.0
"""Postponed work waits at most this many seconds if the jobs follow each other without a pause."""

_shared: dict[str, StoreWorker] = {}
_closing: dict[str, Future[None]] = {}
"""Key of a store that is closing → a future that is done when the store is closed. The next opening waits for it."""
_lock = threading.Lock()


class StoreWorker:
    """A thread that runs jobs on a store, one at a time. In a pause, the store does its postponed work.

    A process opens a memory file only once, for all of its contexts. A second opening would succeed, and ruin the file.
    A store may also be on a database server. The thread is a daemon, so the process can end even if that server hangs.
    """

    def __init__(self, place: str, make: Callable[[], Store]) -> None:
        """Start the thread, which first opens the store.

        Args:
            place: The path or address of the store, for messages.
            make: A function that opens the store. If it raises an exception, every job raises the same exception.
        """
        self.place = place
        self._jobs: SimpleQueue[Callable[[], None] | None] = SimpleQueue()
        self._users = 1
        self._key = ""
        self._store: Future[Store] = Future()
        self._jobs.put(lambda: _settle(self._store, make))
        threading.Thread(target=self._work, name="ravestate-memory", daemon=True).start()

    @classmethod
    def shared(cls, key: str, make: Callable[[], Store]) -> StoreWorker:
        """Return the process's worker for the store at `key`, or start a worker. Each call needs its own `release`."""
        with _lock:
            worker = _shared.get(key)
            if worker is not None:
                worker._users += 1
                return worker
            before = _closing.get(key)

            def make_after() -> Store:
                if before is not None:
                    before.exception()
                return make()

            worker = _shared[key] = cls(key, make_after)
            worker._key = key
            return worker

    def submit(self, job: Callable[[Store], T]) -> Future[T]:
        """Queue a job for the thread; return its future result."""
        future: Future[T] = Future()
        self._jobs.put(lambda: _settle(future, lambda: job(self._store.result())))
        return future

    def release(self) -> Future[None]:
        """End one use of the worker. The end of the last use closes the store after all queued jobs."""
        done: Future[None] = Future()
        with _lock:
            self._users -= 1
            if self._users:
                self._jobs.put(lambda: done.set_result(None))
                return done
            if self._key:
                del _shared[self._key]
                _closing[self._key] = done
            self._jobs.put(lambda: _settle(done, self._close))
            self._jobs.put(None)
        done.add_done_callback(self._closed)
        return done

    def _closed(self, done: Future[None]) -> None:
        with _lock:
            if _closing.get(self._key) is done:
                del _closing[self._key]

    def _work(self) -> None:
        since: float | None = None  # the time of the first job after the last rest
        while True:
            try:
                job = self._jobs.get(timeout=None if since is None else PAUSE)
            except Empty:
                since = self._rest()
                continue
            if job is None:
                return
            job()
            since = since or time.monotonic()
            if time.monotonic() - since > LONGEST:
                since = self._rest()

    def _rest(self) -> None:
        if self._store.exception() is None:
            self._store.result().rest()

    def _close(self) -> None:
        if self._store.exception() is None:
            self._store.result().close()


def _settle(future: Future[T], work: Callable[[], T]) -> None:
    """Run `work`, and give its result or its exception to the future."""
    try:
        future.set_result(work())
    except BaseException as error:
        future.set_exception(error)
