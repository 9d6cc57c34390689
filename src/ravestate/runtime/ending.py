"""How a run ended, from what its function returned or raised (L18)."""

from __future__ import annotations

import os
from collections.abc import Coroutine
from typing import Any, cast

from ravestate.declare.outcome import Resign, Retire
from ravestate.declare.rule import Rule
from ravestate.engine.events import Finish
from ravestate.engine.foreign import shown
from ravestate.errors import RuleError

__all__ = ["ending", "short"]


def ending(run: int, rule: Rule[Any, Any], told: Any, raised: bool) -> Finish:
    """The event that ends a run.

    Args:
        run: Its number.
        rule: Whose it was.
        told: What the function returned or raised.
        raised: Whether it raised that.
    """
    if told is None:
        return Finish(run, "done")
    if isinstance(told, Resign):
        return Finish(run, "resigned", told.reason)
    if isinstance(told, Retire):
        return Finish(run, "retired", told.reason)
    failure = cast("BaseException", told) if raised else _nonsense(rule, told)
    if isinstance(told, SystemExit):
        failure = RuleError(
            f"rule {rule.name} ({rule.origin}) called sys.exit: a rule does not end the process; write ctx.stop() "
            "to end the agent"
        )
        failure.__cause__ = told
    return Finish(run, "failed", short(failure) + _place(rule, failure), failure)


def short(value: object) -> str:
    """The value's `repr`, cut to 60 characters."""
    text = shown(value)
    return text if len(text) <= 60 else text[:57] + "..."


def _nonsense(rule: Rule[Any, Any], result: Any) -> RuleError:
    if isinstance(result, Coroutine):
        cast("Coroutine[Any, Any, Any]", result).close()
        return RuleError(
            f"rule {rule.name} ({rule.origin}) is a plain function that returned a coroutine: write async def, also for "
            "what a decorator puts around it"
        )
    return RuleError(
        f"rule {rule.name} ({rule.origin}) returned {short(result)}; a rule returns nothing, rs.Resign(reason) or "
        "rs.Retire(); write its result to a slot"
    )


def _place(rule: Rule[Any, Any], failure: BaseException) -> str:
    """Where in the rule's own file it failed, e.g. `` (guide.py:42)``; nothing if that cannot be told."""
    file = rule.origin.rpartition(":")[0]
    line, step = 0, failure.__traceback__
    while step is not None:
        if step.tb_frame.f_code.co_filename == file:
            line = step.tb_lineno
        step = step.tb_next
    return f" ({os.path.basename(file)}:{line})" if line else ""
