"""A store is used by one thread only, and a process opens a file only once."""

from __future__ import annotations

import threading
from typing import Any

import pytest

from ravestate.errors import PlatformError
from ravestate.modules.meta.ontology.worker import StoreWorker


class Recorder:
    """A store that records its calls and their threads."""

    def __init__(self, log: list[str]) -> None:
        self.log = log
        self.threads = {threading.get_ident()}
        log.append("open")

    def touch(self, what: str) -> str:
        self.threads.add(threading.get_ident())
        self.log.append(what)
        return what

    def close(self) -> None:
        self.touch("close")


def test_jobs_run_in_order_in_one_thread() -> None:
    log: list[str] = []
    worker = StoreWorker("here", lambda: Recorder(log))  # type: ignore[arg-type, return-value]
    replies = [worker.submit(lambda store, n=n: store.touch(str(n))) for n in range(50)]  # type: ignore[misc]
    threads = worker.submit(lambda store: store.threads)  # type: ignore[attr-defined]
    worker.release().result(20)
    assert [reply.result() for reply in replies] == [str(n) for n in range(50)]
    assert log == ["open", *map(str, range(50)), "close"]
    assert len(threads.result()) == 1 and threading.get_ident() not in threads.result()


def test_a_failing_job_does_not_affect_others() -> None:
    worker = StoreWorker("here", lambda: Recorder([]))  # type: ignore[arg-type, return-value]
    bad = worker.submit(lambda _: 1 / 0)
    good = worker.submit(lambda _: 3)
    with pytest.raises(ZeroDivisionError):
        bad.result(20)
    assert good.result(20) == 3
    worker.release().result(20)


def test_a_failed_opening_fails_every_job() -> None:
    def fail() -> Any:
        raise PlatformError("no such thing")

    worker = StoreWorker("here", fail)
    for _ in range(2):
        with pytest.raises(PlatformError, match="no such thing"):
            worker.submit(lambda _: 3).result(20)
    worker.release().result(20)


def test_a_shared_store_opens_once_closes_with_its_last_user_and_can_then_open_again() -> None:
    log: list[str] = []
    go_on = threading.Event()

    def share() -> StoreWorker:
        return StoreWorker.shared("/nowhere/at/all", lambda: Recorder(log))  # type: ignore[arg-type, return-value]

    first, second = share(), share()
    assert first is second
    first.release().result(20)
    second.submit(lambda store: store.touch("used")).result(20)  # type: ignore[attr-defined]
    second.submit(lambda _: go_on.wait(20))
    closing = second.release()
    third = share()
    assert third is not first
    opened = third.submit(lambda store: store.touch("again"))  # type: ignore[attr-defined]
    assert not opened.done()  # not before the first store is closed
    go_on.set()
    opened.result(20)
    assert closing.done() and log == ["open", "used", "close", "open", "again"]
    third.release().result(20)
