"""An eager task runs a coroutine that does not wait at little cost. If the coroutine waits, it acts like any task."""

import asyncio
import contextvars
import dataclasses
import threading
from collections.abc import AsyncIterator, Coroutine
from typing import Any

import pytest

import ravestate as rs
from ravestate.engine.effects import Run
from ravestate.runtime import blocking
from ravestate.runtime.blocking import StepTimer
from ravestate.runtime.eager_task import EagerTask
from ravestate.runtime.rule_context import RuleContext
from runtime.on_loop import on_loop, turns

shade = contextvars.ContextVar("shade", default="none")


@rs.Module("m").rule(when=rs.startup)
async def rule(ctx: rs.RuleContext) -> None: ...


def make() -> EagerTask:
    return EagerTask(asyncio.get_running_loop(), StepTimer(), contextvars.copy_context())


class Host:
    """A stand-in for a running context. The rules of these tests do not use it."""


def context_of(coroutine: Coroutine[Any, Any, Any]) -> RuleContext:
    """Return the context of a rule whose function returns a coroutine."""
    host: Any = Host()
    return RuleContext(host, Run(1, dataclasses.replace(rule, function=lambda ctx: coroutine), {}, {}))


async def step(eager: EagerTask, coroutine: Coroutine[Any, Any, Any]) -> bool:
    """Take the first step as the runner does, from a callback of the loop. There, no task is current.

    Return whether a task adopted the coroutine.
    """
    done: asyncio.Future[bool] = asyncio.get_running_loop().create_future()

    def take() -> None:
        try:
            done.set_result(eager.first_step(context_of(coroutine)) is None)
        except BaseException as error:
            done.set_exception(error)

    asyncio.get_running_loop().call_soon(take)
    return await done


async def closed(eager: EagerTask) -> None:
    eager.close()
    await turns()
    assert eager.task.done()


# ---------------------------------------------------------------------------------------- coroutines that do not wait


@on_loop
async def test_a_coroutine_that_does_not_wait_leaves_the_task_free() -> None:
    eager = make()
    ran: list[int] = []

    async def work(number: int) -> None:
        ran.append(number)

    for number in range(3):
        assert not await step(eager, work(number))
    assert ran == [0, 1, 2] and not eager.task.done() and not eager.spoilt
    await closed(eager)


@on_loop
async def test_an_exception_in_the_first_step_is_raised_immediately() -> None:
    eager = make()

    async def fail() -> None:
        raise KeyError("x")

    with pytest.raises(KeyError):
        await step(eager, fail())
    assert not eager.spoilt
    await closed(eager)


def counted_tasks() -> list[str]:
    """Return the list to which each new task adds its name."""
    made: list[str] = []
    loop = asyncio.get_running_loop()

    def factory(loop: asyncio.AbstractEventLoop, coroutine: Any, **options: Any) -> asyncio.Task[Any]:
        made.append(coroutine.__qualname__)
        return asyncio.Task(coroutine, loop=loop, **options)

    loop.set_task_factory(factory)
    return made


@on_loop
async def test_rules_that_do_not_wait_share_one_spare_task() -> None:
    m = rs.Module("m")
    links = [m.signal(f"s{number}") for number in range(100)]
    last = m.signal("last")
    for here, there in zip(links, [*links[1:], last], strict=True):

        async def hop(ctx: rs.RuleContext, there: rs.Signal[None] = there) -> None:
            ctx.emit(there)

        m.rule(when=here, emits=there, name=f"to_{there.name.split(':')[1]}")(hop)

    async with rs.Context(m) as context:
        made = counted_tasks()
        waiting = context.next(last)
        context.emit(links[0])
        await waiting
        await context.quiet()
        asyncio.get_running_loop().set_task_factory(None)
    assert made == ["main"]


# ---------------------------------------------------------------------------------------- coroutines that wait


@on_loop
async def test_a_task_adopts_a_coroutine_that_waits_and_continues_it() -> None:
    eager = make()
    seen: list[object] = []

    async def work() -> str:
        seen.append(asyncio.current_task())
        await asyncio.sleep(0)
        seen.append(asyncio.current_task())
        future: asyncio.Future[int] = asyncio.get_running_loop().create_future()
        asyncio.get_running_loop().call_soon(future.set_result, 7)
        seen.append(await future)
        return "result"

    assert await step(eager, work())
    assert await eager.task == "result"
    assert seen == [eager.task, eager.task, 7]


@on_loop
async def test_an_exception_after_the_coroutine_has_waited_is_raised_by_the_task() -> None:
    eager = make()

    async def fail() -> None:
        await asyncio.sleep(0)
        raise KeyError("x")

    await step(eager, fail())
    with pytest.raises(KeyError):
        await eager.task


@on_loop
async def test_the_exception_of_an_awaited_future_is_raised_in_the_coroutine() -> None:
    eager = make()
    future: asyncio.Future[None] = asyncio.get_running_loop().create_future()

    async def recover() -> str:
        try:
            await future
        except ValueError as error:
            return str(error)
        return "nothing"

    await step(eager, recover())
    future.set_exception(ValueError("broken"))
    assert await eager.task == "broken"


@on_loop
async def test_tools_of_asyncio_work_from_the_first_step() -> None:
    async def value(result: object) -> object:
        await asyncio.sleep(0)
        return result

    async def once() -> AsyncIterator[None]:  # an async generator that does not wait
        yield

    async def with_timeout() -> object:
        async with asyncio.timeout(60):
            return await value(1)

    async def with_timeout_that_is_not_needed() -> object:
        async with asyncio.timeout(60):
            await anext(once())
            return 1

    async def with_timeout_that_is_over() -> object:
        try:
            async with asyncio.timeout(0):
                await asyncio.get_running_loop().create_future()
        except TimeoutError:
            return 1

    async def with_group() -> object:
        async with asyncio.TaskGroup() as group:
            task = group.create_task(value(1))
        return task.result()

    async def with_group_that_fails() -> object:
        async def fail() -> None:
            raise ValueError

        try:
            async with asyncio.TaskGroup() as group:
                group.create_task(fail())
                group.create_task(value(2))
        except* ValueError as errors:
            failed = len(errors.exceptions)
        return failed

    async def with_thread() -> object:
        return 1 if await asyncio.to_thread(threading.get_ident) != threading.get_ident() else 2

    async def with_gather() -> object:
        return len(await asyncio.gather(value(1), value(2))) - 1

    async def with_wait_for() -> object:
        return await asyncio.wait_for(value(1), 60)

    async def with_shield() -> object:
        return await asyncio.shield(value(1))

    for work in (
        with_timeout, with_timeout_that_is_not_needed, with_timeout_that_is_over, with_group, with_group_that_fails,
        with_thread, with_gather, with_wait_for, with_shield,
    ):  # fmt: skip
        eager = make()
        if await step(eager, work()):
            assert await eager.task == 1, work.__name__
        else:
            await closed(eager)


# ---------------------------------------------------------------------------------------- context variables


@on_loop
async def test_a_context_variable_keeps_the_value_that_a_coroutine_sets_until_the_coroutine_ends() -> None:
    eager = make()
    seen: list[str] = []

    async def paint() -> None:
        token = shade.set("red")
        await asyncio.sleep(0)
        seen.append(await asyncio.to_thread(shade.get))
        shade.reset(token)
        seen.append(shade.get())

    await step(eager, paint())
    await eager.task
    assert seen == ["red", "none"] and shade.get() == "none"


@on_loop
async def test_a_context_variable_that_a_rule_sets_does_not_reach_the_next_rule() -> None:
    m = rs.Module("m")
    go, seen = m.signal("go", str), m.slot("seen", "")

    @m.rule(when=go, writes=seen)
    async def paint(ctx: rs.RuleContext) -> None:
        ctx[seen] = shade.get()
        shade.set(ctx.payload(go))

    async with rs.Context(m) as context:
        for colour in ("red", "blue"):
            context.emit(go, colour)
            await context.quiet()
            assert context.read(seen) == "none"


# ---------------------------------------------------------------------------------------- cancellation


@pytest.mark.parametrize("when", ["before adoption", "after adoption"])
@on_loop
async def test_a_cancelled_coroutine_cleans_up(when: str) -> None:
    eager = make()
    told: list[str] = []

    async def work() -> None:
        try:
            await asyncio.get_running_loop().create_future()
        except asyncio.CancelledError:
            told.append("cancelled")
            raise
        finally:
            await asyncio.sleep(0)
            told.append("clean")

    if when == "before adoption":  # the task gets the cancellation in its first step
        asyncio.get_running_loop().call_soon(lambda: (eager.first_step(context_of(work())), eager.task.cancel()))
        await asyncio.sleep(0)
    else:
        await step(eager, work())
        await turns()
        eager.task.cancel()
    with pytest.raises(asyncio.CancelledError):
        await eager.task
    assert told == ["cancelled", "clean"]


@pytest.mark.parametrize("fresh", [True, False])
@on_loop
async def test_a_cancellation_reaches_the_awaited_tasks(fresh: bool) -> None:
    eager = make()
    if not fresh:
        await turns()
    told: list[str] = []

    async def inner() -> None:
        try:
            await asyncio.get_running_loop().create_future()
        finally:
            told.append("inner")

    async def outer() -> None:
        await asyncio.gather(inner(), inner())

    await step(eager, outer())
    eager.task.cancel()
    with pytest.raises(asyncio.CancelledError):
        await eager.task
    await turns()
    assert told in ([], ["inner", "inner"])  # a task that has not begun has nothing to clean up
    assert len(asyncio.all_tasks()) == 1


@on_loop
async def test_a_coroutine_can_suppress_a_cancellation() -> None:
    eager = make()

    async def stubborn() -> str:
        try:
            await asyncio.get_running_loop().create_future()
        except asyncio.CancelledError:
            return "declined"
        return ""

    await step(eager, stubborn())
    eager.task.cancel()
    assert await eager.task == "declined"


@on_loop
async def test_a_coroutine_that_cancels_itself_is_cancelled_at_its_next_wait() -> None:
    eager = make()
    told: list[str] = []

    async def work() -> None:
        task = asyncio.current_task()
        assert task is not None
        task.cancel()
        told.append("went on")
        try:
            await asyncio.get_running_loop().create_future()
        except asyncio.CancelledError:
            told.append("cancelled")
            raise

    await step(eager, work())
    with pytest.raises(asyncio.CancelledError):
        await eager.task
    assert told == ["went on", "cancelled"]


@on_loop
async def test_a_spare_task_that_was_cancelled_is_not_used_again() -> None:
    eager = make()

    async def work() -> None:
        task = asyncio.current_task()
        assert task is not None
        task.cancel()

    assert not await step(eager, work())
    assert eager.spoilt
    await turns()
    assert eager.task.cancelled() or eager.task.done()


@on_loop
async def test_a_rule_that_cancels_itself_does_not_cancel_other_rules() -> None:
    m = rs.Module("m")
    go, calm = m.signal("go"), m.signal("calm")
    done = m.slot("done", 0)

    @m.rule(when=go)
    async def rash(ctx: rs.RuleContext) -> None:
        task = asyncio.current_task()
        assert task is not None
        task.cancel()

    @m.rule(when=calm, writes=done)
    async def patient(ctx: rs.RuleContext) -> None:
        await asyncio.sleep(0)
        ctx[done] = 1

    async with rs.Context(m) as context:
        context.emit(go)
        context.emit(calm)
        await context.quiet()
        assert context.read(done) == 1


@on_loop
async def test_a_coroutine_that_refuses_to_end_can_be_abandoned() -> None:
    eager = make()
    told: list[str] = []

    async def stubborn() -> None:
        try:
            while True:
                try:
                    await asyncio.get_running_loop().create_future()
                except asyncio.CancelledError:
                    told.append("no")
        finally:
            told.append("closed")

    await step(eager, stubborn())
    eager.task.cancel()
    await turns()
    assert told == ["no"] and not eager.task.done()
    eager.abandon()
    await turns()
    assert told == ["no", "closed"] and eager.task.done()


@on_loop
async def test_the_method_close_ends_a_spare_task_but_no_task_that_has_a_coroutine() -> None:
    await closed(make())
    eager = make()
    future: asyncio.Future[int] = asyncio.get_running_loop().create_future()

    async def wait() -> int:
        return await future

    await step(eager, wait())
    eager.close()
    future.set_result(3)
    assert await eager.task == 3


# ---------------------------------------------------------------------------------------- other behaviour


@on_loop
async def test_sys_exit_is_passed_on_and_does_not_end_the_event_loop() -> None:
    eager = make()

    async def leave() -> None:
        await asyncio.sleep(0)
        raise SystemExit(3)

    await step(eager, leave())
    assert isinstance(await eager.task, SystemExit)


@on_loop
async def test_the_time_of_each_step_is_measured(monkeypatch: pytest.MonkeyPatch) -> None:
    readings: list[float] = []

    def read() -> float:
        readings.append(1.0)
        return 1.0

    monkeypatch.setattr(blocking, "perf_counter", read)
    eager = make()

    async def work() -> None:
        for _ in range(2):
            await asyncio.sleep(0)

    await step(eager, work())
    await eager.task
    assert len(readings) == 6  # a beginning and an end for each of three steps


@on_loop
async def test_closing_the_coroutine_of_a_task_closes_the_adopted_coroutine() -> None:
    eager = make()
    told: list[str] = []

    async def work() -> None:
        try:
            await asyncio.get_running_loop().create_future()
        finally:
            told.append("closed")

    await step(eager, work())
    await turns()
    eager.task.get_coro().close()
    assert told == ["closed"]
    eager.task.cancel()
    await turns()
