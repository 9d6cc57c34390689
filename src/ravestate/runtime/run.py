"""Running an agent until it is told to end."""

from __future__ import annotations

import asyncio
import contextlib
import logging
import signal
from collections.abc import Callable, Coroutine, Generator, Sequence
from types import ModuleType
from typing import Any

from ravestate.declare.module import Module
from ravestate.policy.policy import Policy
from ravestate.runtime.agent import Agent
from ravestate.runtime.context import Context

__all__ = ["run", "run_context", "run_servers"]

log = logging.getLogger("ravestate")

INPUT = "rawio:input"
"""What a user says. Whoever runs modules that know of it mostly wants to talk with them."""

UNABLE = (NotImplementedError, RuntimeError, ValueError)
"""What handling signals raises where the platform cannot, or outside of the main thread."""


def run(*modules: Module | ModuleType | Policy, **options: Any) -> None:
    """Run an agent until a rule calls ``ctx.stop()``, or Ctrl-C; then shut it down in order.

    It runs as one context; or, with a platform among the modules that serves many users, as one for each of them.

    A warning says so if the modules use `rawio`, but none of them is a platform on which a user could talk.

    Args:
        modules: As for `Context`.
        options: As for `Context`.

    Raises:
        DeclarationErrors: The modules, or the settings, do not fit.
    """
    agent = Agent(*modules, **options)
    servers = [module.serve for module in agent.policy.modules if module.serve is not None]
    if not servers:
        warn_if_mute(agent.policy)
    asyncio.run(run_servers(agent, servers) if servers else run_context(agent.context()))


def warn_if_mute(policy: Policy) -> None:
    """Say so if the modules use `rawio`, but none of them is a platform on which a user could talk."""
    if INPUT in policy.slots and not any(INPUT in map(str, rule.writes) for rule in policy.rules.values()):
        log.warning(
            "nobody can talk to this agent: no rule writes %s; name a platform too, e.g. conio for the console. "
            "Ctrl-C ends it",
            INPUT,
        )


async def run_context(context: Context) -> None:
    """Run a context until it is asked to stop; SIGINT and SIGTERM ask it, a second time they break off."""
    with asked_by_signals(context.ask_to_stop):
        async with context:
            await context.until_stopped()


async def run_servers(agent: Agent, servers: Sequence[Callable[[Agent], Coroutine[Any, Any, None]]]) -> None:
    """Run what serves an agent to many users until the first of them ends or fails; SIGINT and SIGTERM cancel them."""
    tasks = [asyncio.create_task(serve(agent)) for serve in servers]
    ends: list[BaseException | None] = []

    def stop() -> None:
        for task in tasks:
            task.cancel()

    with asked_by_signals(stop):
        await asyncio.wait(tasks, return_when=asyncio.FIRST_COMPLETED)
        stop()
        ends = await asyncio.gather(*tasks, return_exceptions=True)
    for end in ends:
        if isinstance(end, Exception):
            raise end


@contextlib.contextmanager
def asked_by_signals(stop: Callable[[], None]) -> Generator[None]:
    """Have SIGINT and SIGTERM call a function; a second one cancels the running task, which ends without a word."""
    loop = asyncio.get_running_loop()
    main = asyncio.current_task()
    asked = False

    def ask() -> None:
        nonlocal asked
        if asked and main is not None:
            main.cancel()
        asked = True
        stop()

    signals = (signal.SIGINT, signal.SIGTERM)
    for number in signals:
        with contextlib.suppress(*UNABLE):
            loop.add_signal_handler(number, ask)
    try:
        yield
    except asyncio.CancelledError:
        pass
    finally:
        for number in signals:
            with contextlib.suppress(*UNABLE):
                loop.remove_signal_handler(number)
