"""Running an agent until it is told to end."""

from __future__ import annotations

import asyncio
import contextlib
import signal
from types import ModuleType
from typing import Any

from ravestate.declare.module import Module
from ravestate.policy.policy import Policy
from ravestate.runtime.context import Context

__all__ = ["run", "run_context"]

UNABLE = (NotImplementedError, RuntimeError, ValueError)
"""What handling signals raises where the platform cannot, or outside of the main thread."""


def run(*modules: Module | ModuleType | Policy, **options: Any) -> None:
    """Run an agent until a rule calls ``ctx.stop()``, or Ctrl-C; then shut it down in order.

    Args:
        modules: As for `Context`.
        options: As for `Context`.

    Raises:
        DeclarationErrors: The modules, or the settings, do not fit.
    """
    context = Context(*modules, **options)
    asyncio.run(run_context(context))


async def run_context(context: Context) -> None:
    """Run a context until it is asked to stop; SIGINT and SIGTERM ask it, a second time they break off."""
    loop = asyncio.get_running_loop()
    main = asyncio.current_task()
    asked = False

    def ask() -> None:
        nonlocal asked
        if asked and main is not None:
            main.cancel()
        asked = True
        context.ask_to_stop()

    signals = (signal.SIGINT, signal.SIGTERM)
    for number in signals:
        with contextlib.suppress(*UNABLE):
            loop.add_signal_handler(number, ask)
    try:
        async with context:
            await context.until_stopped()
    except asyncio.CancelledError:
        pass
    finally:
        for number in signals:
            with contextlib.suppress(*UNABLE):
                loop.remove_signal_handler(number)
