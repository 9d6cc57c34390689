"""The worker thread of a store, shared by all contexts of the process."""

from __future__ import annotations

import threading
from collections.abc import Callable
from concurrent.futures import Future
from queue import SimpleQueue
from typing import TypeVar

from .store import Store

T = TypeVar("T")

_shared: dict[str, StoreWorker] = {}
_closing: dict[str, Future[None]] = {}
"""Key of a store that is closing → the end of the closing; the next opening of the store waits for it."""
_lock = threading.Lock()


class StoreWorker:
    """A thread that runs jobs on a store, one after the other.

    A process opens a file once for all contexts: a second opening would succeed and ruin the file. The thread is a
    daemon, so a server that hangs cannot keep the process alive.
    """

    def __init__(self, place: str, make: Callable[[], Store]) -> None:
        """Start the thread, which first opens the store.

        Args:
            place: The path or address of the store, for messages.
            make: A function that opens the store. If it raises an exception, every job raises the same one.
        """
        self.place = place
        self._jobs: SimpleQueue[Callable[[], None] | None] = SimpleQueue()
        self._users = 1
        self._key = ""
        self._store: Store | None = None
        self._failure: BaseException | None = None
        self._jobs.put(lambda: self._open(make))
        threading.Thread(target=self._work, name="ravestate-memory", daemon=True).start()

    @classmethod
    def shared(cls, key: str, make: Callable[[], Store]) -> StoreWorker:
        """Return the process's worker for the store at `key`, or start one; each call needs a `release`."""
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

        def do() -> None:
            try:
                if self._store is None:
                    raise self._failure or RuntimeError("the store was not opened")
                future.set_result(job(self._store))
            except BaseException as error:  # the caller gets it
                future.set_exception(error)

        self._jobs.put(do)
        return future

    def release(self) -> Future[None]:
        """Release the worker for one user. The last release closes the store after all queued jobs."""
        done: Future[None] = Future()
        with _lock:
            self._users -= 1
            if self._users:
                self._jobs.put(lambda: done.set_result(None))
                return done
            if self._key:
                del _shared[self._key]
                _closing[self._key] = done
            self._jobs.put(lambda: self._close(done))
            self._jobs.put(None)
        done.add_done_callback(self._closed)
        return done

    def _closed(self, done: Future[None]) -> None:
        with _lock:
            if _closing.get(self._key) is done:
                del _closing[self._key]

    # ------------------------------------------------------------------------------- in the thread

    def _work(self) -> None:
        while (job := self._jobs.get()) is not None:
            job()

    def _open(self, make: Callable[[], Store]) -> None:
        try:
            self._store = make()
        except BaseException as error:  # every job will raise it
            self._failure = error

    def _close(self, done: Future[None]) -> None:
        try:
            if self._store is not None:
                self._store.close()
            done.set_result(None)
        except BaseException as error:  # the caller gets it
            done.set_exception(error)
