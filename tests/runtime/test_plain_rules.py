"""When plain functions must wait for a worker thread, one warning names the rules that occupy the threads."""

import asyncio
import functools
import logging
import re
import threading

import pytest

import ravestate as rs
from ravestate.runtime import plain_rules, workers
from ravestate.runtime.workers import JobQueue, ThreadPool
from runtime.on_loop import on_loop

LIMIT = 20.0


class Crowd:
    """A module with functions that hang until `release` is set, and a function that answers."""

    def __init__(self) -> None:
        self.module = rs.Module("m")
        self.begun = threading.Semaphore(0)
        self.release = threading.Event()
        self.hang = self.module.signal("hang", payload=int)
        self.ask = self.module.signal("ask")
        self.answered = self.module.signal("answered")

        @self.module.rule(when=self.hang, name="hangs")
        def hangs(ctx: rs.RuleContext) -> None:
            self.begun.release()
            self.release.wait(LIMIT)

        @self.module.rule(when=self.ask, emits=self.answered)
        def answer(ctx: rs.RuleContext) -> None:
            ctx.emit(self.answered)


class Warnings(logging.Handler):
    """Collects the messages that ravestate logs within a ``with`` block. They go to a queue."""

    def __init__(self) -> None:
        super().__init__()
        self.texts: asyncio.Queue[str] = asyncio.Queue()

    def emit(self, record: logging.LogRecord) -> None:
        self.texts.put_nowait(record.getMessage())

    def __enter__(self) -> "Warnings":
        logging.getLogger("ravestate").addHandler(self)
        return self

    def __exit__(self, *_: object) -> None:
        logging.getLogger("ravestate").removeHandler(self)


@pytest.mark.parametrize("full", ["the share of the context", "the threads of the process"])
@on_loop
async def test_one_warning_names_the_hanging_functions_that_occupy_all_workers(full: str) -> None:
    crowd = Crowd()
    with pytest.MonkeyPatch.context() as patch, Warnings() as log:
        patch.setattr(plain_rules, "JobQueue", functools.partial(JobQueue, ThreadPool()))
        patch.setattr(workers, "SHARE" if full.startswith("the share") else "THREADS", 2)
        patch.setattr(workers, "monotonic", lambda: 0.0)
        patch.setattr(plain_rules, "monotonic", lambda: 60.0)
        async with rs.Context(crowd.module) as context:
            for number in range(2):
                context.emit(crowd.hang, number)
                await asyncio.to_thread(crowd.begun.acquire)
            patch.setattr(plain_rules, "STARVED", 0.0)
            for _ in range(3):
                context.emit(crowd.ask)
            text = await log.texts.get()
            crowd.release.set()
            await context.quiet()
            assert log.texts.empty()
    assert re.fullmatch(
        r"plain functions wait for a worker thread: m:answer \(3 runs, up to 60 s\)\. All 2 threads are taken by "
        r"m:hangs \(2 runs, up to 60 s\)\. If a rule may hang, write timeout=seconds or async def",
        text,
    )


@on_loop
async def test_many_functions_that_take_turns_cause_no_warning() -> None:
    crowd = Crowd()
    crowd.release.set()
    with pytest.MonkeyPatch.context() as patch, Warnings() as log:
        patch.setattr(workers, "SHARE", 2)
        async with rs.Context(crowd.module) as context:
            for number in range(50):
                context.emit(crowd.hang, number)
            await context.quiet()
            assert log.texts.empty()
