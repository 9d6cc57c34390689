"""Who keeps a store: the one thread that touches it, and how many share it."""

from __future__ import annotations

import threading
from collections.abc import Callable
from concurrent.futures import Future
from queue import SimpleQueue
from typing import TypeVar

from .store import Store

__all__ = ["StoreWorker"]

T = TypeVar("T")

_shared: dict[str, StoreWorker] = {}
_closing: dict[str, Future[None]] = {}
"""Stores that are being closed; the next who opens one waits for that."""
_lock = threading.Lock()


class StoreWorker:
    """Does jobs on a store, one after the other, in a thread of its own.

    A file is kept once in a process, whoever uses it: a second opening of it would not be refused, and ruin it.
    The thread is a daemon, so that a server that hangs cannot keep the process from ending.
    """

    def __init__(self, place: str, make: Callable[[], Store]) -> None:
        """Begin to open a store, in the thread.

        Args:
            place: Where it is, for messages.
            make: Opens the store. What it raises, every job will.
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
        """The worker of a store that is known in this process by `key`, which is its place, or a new one."""
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
        """Have a job done after all those before it."""
        future: Future[T] = Future()

        def do() -> None:
            try:
                if self._store is None:
                    raise self._failure or RuntimeError("the store was not opened")
                future.set_result(job(self._store))
            except BaseException as error:  # whoever waits gets it
                future.set_exception(error)

        self._jobs.put(do)
        return future

    def release(self) -> Future[None]:
        """Let go of one use; the last one closes the store, after all jobs before."""
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
        except BaseException as error:  # whoever asks for something gets it
            self._failure = error

    def _close(self, done: Future[None]) -> None:
        try:
            if self._store is not None:
                self._store.close()
            done.set_result(None)
        except BaseException as error:  # whoever waits gets it
            done.set_exception(error)
