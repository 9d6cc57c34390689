"""A spare task runs one rule after another. All contexts of an event loop share one spare task."""

import asyncio
import contextvars

import ravestate as rs
from ravestate.runtime.spares import Spares
from runtime.on_loop import on_loop, turns

shade = contextvars.ContextVar("shade", default="none")

m = rs.Module("m")
asked, answered = m.signal("asked"), m.signal("answered", payload=object)


@m.rule(when=asked, emits=answered)
async def answer(ctx: rs.RuleContext) -> None:
    ctx.emit(answered, (asyncio.current_task(), shade.get()))


async def ask(context: rs.Context) -> tuple[object, str]:
    """Return the current task inside a rule, and the value of a context variable there."""
    context.emit(asked)
    found = await context.next(answered)
    assert isinstance(found, tuple)
    return found[0], found[1]


@on_loop
async def test_contexts_share_one_spare_task() -> None:
    async with rs.Context(m) as one, rs.Context(m) as other:
        first, _ = await ask(one)
        assert (await ask(other))[0] is first and (await ask(one))[0] is first


@on_loop
async def test_a_rule_has_the_context_variables_with_which_its_context_started() -> None:
    async with rs.Context(m) as one:
        shade.set("blue")
        async with rs.Context(m) as other:
            assert [(await ask(context))[1] for context in (one, other, one)] == ["none", "blue", "none"]


@on_loop
async def test_the_last_context_ends_the_spare_task() -> None:
    async with rs.Context(m) as one:
        async with rs.Context(m) as other:
            await ask(other)
        spare, _ = await ask(one)
        assert isinstance(spare, asyncio.Task) and not spare.done()
    await turns()
    assert spare.done()


@on_loop
async def test_a_spare_task_that_is_in_use_is_not_given_to_a_second_rule() -> None:
    spares = Spares.join(asyncio.get_running_loop())
    variables = contextvars.copy_context()
    one, other = spares.take(variables), spares.take(variables)
    assert one is not other
    spares.give(one)
    spares.give(other)
    await turns()
    assert other.task.done() and spares.take(variables) is one
    spares.give(one)
    spares.leave()
    await turns()
    assert one.task.done()


class Vector:
    """A value whose comparison raises an error, like that of an array."""

    __hash__ = None  # type: ignore[assignment]

    def __eq__(self, other: object) -> bool:
        raise ValueError("the truth value of an array is ambiguous")


@on_loop
async def test_context_variables_can_have_values_that_cannot_be_compared() -> None:
    held: contextvars.ContextVar[Vector] = contextvars.ContextVar("held")
    held.set(Vector())
    async with rs.Context(m) as one:
        held.set(Vector())
        async with rs.Context(m) as other:
            assert [(await ask(context))[1] for context in (one, other)] == ["none", "none"]


@on_loop
async def test_a_rule_can_set_a_context_variable_to_a_value_that_cannot_be_compared() -> None:
    held: contextvars.ContextVar[Vector] = contextvars.ContextVar("held")
    held.set(Vector())
    setter = rs.Module("setter")
    go, done = setter.signal("go"), setter.slot("done", 0)

    @setter.rule(when=go, writes=done)
    async def replace(ctx: rs.RuleContext) -> None:
        """Set a context variable in the spare task."""
        held.set(Vector())
        ctx[done] += 1

    async with rs.Context(setter) as context:
        for number in range(3):
            context.emit(go)
            assert await context.next(done.changed, timeout=5) == number + 1
        assert context.read(done) == 3


@on_loop
async def test_contexts_with_equal_context_variables_share_them() -> None:
    spares = Spares.join(asyncio.get_running_loop())
    first = spares.variables()
    assert spares.variables() is first
    shade.set("green")
    assert spares.variables() is not first
    spares.leave()
