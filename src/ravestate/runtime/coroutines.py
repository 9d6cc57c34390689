"""The generators behind an `EagerTask`, which runs the functions of rules (see ``eager_task.py``).

The compiled build leaves this file interpreted, because a task needs real generators.
"""

from __future__ import annotations

import asyncio
import types
from collections.abc import Generator
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from ravestate.runtime.eager_task import EagerTask


class Done:
    """A sign that a coroutine has ended, with its result."""

    __slots__ = ("result",)

    def __init__(self, result: Any) -> None:
        self.result = result


DONE = Done(None)
"""The sign for all coroutines that end without a result."""


@types.coroutine
def drive() -> Generator[Any, Any, Any]:
    """Run the functions of rule contexts, one after another.

    The caller sends each rule context to the generator, which calls the function of the context's rule. The generator
    yields everything that the function's coroutine yields, and then a `Done`. So the end of a coroutine needs no
    exception, which would take longer than a short rule.
    """
    ctx: Any = yield
    while True:
        result = yield from ctx.rule.function(ctx)  # pyright: ignore[reportUnknownVariableType]  # it may be anything
        ctx = yield DONE if result is None else Done(result)


async def main(host: Generator[Any, Any, Any]) -> Any:
    """Run a generator of `host` as a coroutine, because a task accepts only coroutines."""
    return await host  # type: ignore[misc]  # it is decorated with types.coroutine


@types.coroutine
def host(eager: EagerTask) -> Generator[Any, Any, Any]:
    """Wait until an eager task adopts a coroutine, and then run the coroutine to its end."""
    error: BaseException | None = None
    try:
        yield  # the task's first step continues here
        if eager.rule is None:
            yield from eager.wake
    except asyncio.CancelledError as cancelled:
        error = cancelled
    rule, driver = eager.rule, eager.driver
    if rule is None:
        return None
    pending = eager.first
    eager.first = None
    if error is not None and pending is not None and pending.cancel():
        error = None  # the awaited future will raise the cancellation, as in any task
    while True:
        value = None
        if error is None:
            try:
                value = yield pending
            except GeneratorExit:
                driver.close()
                raise
            except BaseException as thrown:  # `driver.throw` below raises this in the coroutine
                error = thrown
        if eager.abandoned:
            driver.close()
            return None
        began = eager.timer.begin()
        try:
            if error is None:
                pending = driver.send(value)
            else:
                raised, error = error, None
                pending = driver.throw(raised)
        except SystemExit as exit:  # if raised here, SystemExit would end the loop and all other rules
            return exit
        finally:
            eager.timer.end(rule, began)
        if type(pending) is Done:
            driver.close()
            return pending.result
