"""Run an agent until a rule, the user or the operating system ends it."""

from __future__ import annotations

import asyncio
import contextlib
import logging
import signal
from collections.abc import Callable, Coroutine, Generator, Sequence
from types import ModuleType
from typing import Any

from ravestate.declare.module import Module
from ravestate.errors import EngineError
from ravestate.policy.policy import Policy
from ravestate.runtime.agent import Agent
from ravestate.runtime.context import Context

log = logging.getLogger("ravestate")

INPUT = "rawio:input"
"""The name of the slot for the user's words. An agent with this slot is usually meant for conversation."""

UNABLE = (NotImplementedError, RuntimeError, ValueError)
"""The errors that `add_signal_handler` raises outside the main thread, and on operating systems without this method."""


def run(*modules: Module | ModuleType | Policy, **options: Any) -> None:
    """Run an agent until a rule calls ``ctx.stop()``, or SIGINT (Ctrl-C) or SIGTERM comes; then shut it down in order.

    The agent runs as one context. If a platform among the modules serves many users, each user gets their own context.
    With such a platform, ``ctx.stop()`` ends only the context of its user, and the agent ends with the platform.

    If the modules use `rawio`, but no platform among them lets a user talk, this function logs a warning. The arguments
    are those of `Context`.

    Raises:
        DeclarationErrors: The modules or the settings have faults.
        RavestateError: A rule has ended the agent because of this error (``ctx.stop(failure)``).
        EngineError: An event loop runs in this thread already, as in an async function or a notebook.
    """
    try:
        asyncio.get_running_loop()
    except RuntimeError:
        pass
    else:
        raise EngineError(
            "rs.run starts an event loop, but this thread runs one already (an async function, a notebook): write "
            "async with rs.Context(...) as context: await context.until_stopped()"
        )
    agent = Agent(*modules, **options)
    servers = [module.serve for module in agent.policy.modules if module.serve is not None]
    if not servers:
        warn_if_mute(agent.policy)
    asyncio.run(run_servers(agent, servers) if servers else run_context(agent.context()))


def warn_if_mute(policy: Policy) -> None:
    """Log a warning if the modules use `rawio`, but no platform among them lets a user talk."""
    if INPUT in policy.slots and not any(INPUT in map(str, rule.writes) for rule in policy.rules.values()):
        log.warning(
            "nobody can talk to this agent: no rule writes %s; name a platform too, e.g. conio for the console. "
            "Ctrl-C ends the agent",
            INPUT,
        )


async def run_context(context: Context) -> None:
    """Run a context until a rule, other code, SIGINT or SIGTERM stops it.

    A second SIGINT or SIGTERM aborts the shutdown.
    """
    with asked_by_signals(context.ask_to_stop):
        async with context:
            await context.until_stopped()


async def run_servers(agent: Agent, servers: Sequence[Callable[[Agent], Coroutine[Any, Any, None]]]) -> None:
    """Run the servers of an agent until one of them ends or fails, or until SIGINT or SIGTERM comes."""
    stopped = asyncio.Event()
    with asked_by_signals(stopped.set):
        await until_first_ends(stopped.wait(), *(serve(agent) for serve in servers))


async def until_first_ends(*coroutines: Coroutine[Any, Any, object]) -> None:
    """Run coroutines at the same time until one of them ends, then cancel the others.

    If a coroutine has failed, raise its exception.
    """
    tasks = [asyncio.create_task(coroutine) for coroutine in coroutines]
    ends: list[object] = []
    try:
        await asyncio.wait(tasks, return_when=asyncio.FIRST_COMPLETED)
    finally:
        for task in tasks:
            task.cancel()
        ends = await asyncio.gather(*tasks, return_exceptions=True)
    for end in ends:
        if isinstance(end, Exception):
            raise end


@contextlib.contextmanager
def asked_by_signals(stop: Callable[[], None]) -> Generator[None]:
    """Call `stop` at each SIGINT or SIGTERM; the second one also aborts the body of the ``with``, without an error.

    A cancellation by other code works as usual.
    """
    loop = asyncio.get_running_loop()
    main = asyncio.current_task()
    asked = 0

    def ask() -> None:
        nonlocal asked
        if asked and main is not None:
            main.cancel()
        asked += 1
        stop()

    signals = (signal.SIGINT, signal.SIGTERM)
    for number in signals:
        with contextlib.suppress(*UNABLE):
            loop.add_signal_handler(number, ask)
    try:
        yield
    except asyncio.CancelledError:
        if main is not None:
            for _ in range(1, asked):  # each signal after the first has called `cancel` once: undo these calls
                main.uncancel()
        if asked < 2 or main is None or main.cancelling():
            raise
    finally:
        for number in signals:
            with contextlib.suppress(*UNABLE):
                loop.remove_signal_handler(number)
