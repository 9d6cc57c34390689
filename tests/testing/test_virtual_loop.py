"""The event loop in virtual time."""

import asyncio
import threading
from asyncio import sleep  # in these tests, `sleep` takes only virtual time
from collections.abc import Iterator

import pytest

from ravestate.testing import virtual_loop
from ravestate.testing.virtual_loop import VirtualLoop


@pytest.fixture
def loop() -> Iterator[VirtualLoop]:
    loop = VirtualLoop()
    yield loop
    loop.close()


def test_the_loop_jumps_from_timer_to_timer(loop: VirtualLoop) -> None:
    seen: list[tuple[str, float]] = []
    for name, delay in (("b", 5), ("a", 2), ("c", 5)):
        loop.call_later(delay, lambda name=name: seen.append((name, loop.time())))
    loop.run_to(4)
    assert seen == [("a", 2.0)] and loop.time() == 4.0
    loop.run_to(5)
    assert seen == [("a", 2.0), ("b", 5.0), ("c", 5.0)] and loop.time() == 5.0


def test_all_ready_callbacks_run_before_time_passes(loop: VirtualLoop) -> None:
    seen: list[float] = []

    async def steps() -> None:
        for _ in range(20):
            await sleep(0)
        seen.append(loop.time())

    task = loop.create_task(steps())
    loop.run_to(0)
    assert seen == [0.0] and task.done()


def test_the_loop_skips_cancelled_timers(loop: VirtualLoop) -> None:
    loop.call_later(1, lambda: None).cancel()
    loop.run_to(3)
    assert loop.time() == 3.0


def test_the_method_run_to_changes_nothing_if_its_time_is_past(loop: VirtualLoop) -> None:
    loop.run_to(3)
    loop.run_to(1)
    assert loop.time() == 3.0


def test_the_loop_runs_a_coroutine_to_its_end(loop: VirtualLoop) -> None:
    async def work() -> float:
        await sleep(3600)
        return loop.time()

    assert loop.run_until_complete(work()) == 3600.0


def test_waiting_for_an_event_that_never_comes_raises_an_error(loop: VirtualLoop) -> None:
    async def wait() -> None:
        await loop.create_future()

    task = loop.create_task(wait())
    with pytest.raises(RuntimeError, match="every task waits for something that never happens"):
        loop.run_until_complete(task)
    task.cancel()
    with pytest.raises(asyncio.CancelledError):
        loop.run_until_complete(task)


def test_virtual_time_does_not_pass_while_threads_are_busy(loop: VirtualLoop) -> None:
    busy = ["work"]
    seen: list[float] = []
    go = threading.Event()

    def done() -> None:
        busy.clear()
        seen.append(loop.time())

    loop.busy = lambda: busy
    thread = threading.Thread(target=lambda: (go.wait(20), loop.call_soon_threadsafe(done)))
    thread.start()
    loop.call_soon(go.set)
    loop.call_later(1, lambda: seen.append(loop.time()))
    loop.run_to(2)
    thread.join()
    assert seen == [0.0, 1.0]


def test_the_loop_waits_for_busy_threads_only_up_to_a_limit_and_only_once(
    loop: VirtualLoop, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(virtual_loop, "REAL_LIMIT", 0.001)
    loop.busy = lambda: ["m:one", "m:two"]
    with pytest.raises(TimeoutError, match=r"m:one and m:two kept virtual time waiting for over 0\.001 real seconds"):
        loop.run_to(1)
    loop.run_to(1)
    assert loop.time() == 1.0


def test_the_loop_waits_longer_for_a_function_that_computes_than_for_one_that_waits(
    loop: VirtualLoop, monkeypatch: pytest.MonkeyPatch
) -> None:
    """On a slow machine, a function that computes needs longer. This must not change the result."""
    monkeypatch.setattr(virtual_loop, "REAL_LIMIT", 0.001)
    busy, readings = ["m:learn"], 0

    def used() -> float:
        """A stand-in for `process_time`: each call adds a second, and the sixth call ends the busy function."""
        nonlocal readings
        readings += 1
        if readings == 6:
            loop.call_soon_threadsafe(busy.clear)
        return float(readings)

    monkeypatch.setattr(virtual_loop, "process_time", used)
    loop.busy = lambda: busy
    loop.run_to(1)
    assert loop.time() == 1.0 and readings >= 6

    busy.append("m:endless")
    with pytest.raises(TimeoutError, match="m:endless kept virtual time waiting"):
        loop.run_to(2)


def test_functions_in_asyncio_to_thread_take_no_virtual_time(
    loop: VirtualLoop, monkeypatch: pytest.MonkeyPatch
) -> None:
    meet = threading.Barrier(2)
    seen: list[float] = []

    async def work() -> None:
        await asyncio.gather(asyncio.to_thread(meet.wait, 20), asyncio.to_thread(meet.wait, 20))
        seen.append(loop.time())

    task = loop.create_task(work())
    loop.run_to(5)
    assert seen == [0.0] and task.done()

    monkeypatch.setattr(virtual_loop, "REAL_LIMIT", 0.001)
    release = threading.Event()

    async def hang() -> None:
        await asyncio.to_thread(release.wait, 20)

    task = loop.create_task(hang())
    with pytest.raises(TimeoutError, match=r"Event\.wait kept virtual time waiting"):
        loop.run_to(6)
    release.set()
    task.cancel()
    loop.run_to(6)


def test_closing_a_runner_waits_for_the_threads_of_its_pool() -> None:
    begun, over, ended = threading.Event(), threading.Event(), threading.Event()

    def wait() -> None:
        begun.set()
        over.wait(5)
        ended.set()

    async def work() -> None:
        function = asyncio.get_running_loop().run_in_executor(None, wait)
        begun.wait(5)
        function.cancel()  # its thread continues
        threading.Timer(0.05, over.set).start()

    with asyncio.Runner(loop_factory=VirtualLoop) as runner:
        runner.run(work())
    assert ended.is_set()
