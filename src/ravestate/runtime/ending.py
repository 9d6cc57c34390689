"""How a run ended, according to the value that its function returned or the exception that it raised (law L18)."""

from __future__ import annotations

import os
from collections.abc import Coroutine
from typing import Any, cast

from ravestate.declare.outcome import Resign, Retire
from ravestate.declare.rule import Rule
from ravestate.declare.wording import short
from ravestate.engine.events import Finish
from ravestate.errors import RuleError


def ending(run: int, rule: Rule[Any, Any], outcome: Any, raised: bool) -> Finish:
    """Return the event that reports the end of a run. `outcome` is the run's result or, if `raised`, its exception."""
    if outcome is None:
        return Finish(run, "done")
    if isinstance(outcome, Resign):
        return Finish(run, "resigned", outcome.reason)
    if isinstance(outcome, Retire):
        return Finish(run, "retired", outcome.reason)
    failure = cast("BaseException", outcome) if raised else _nonsense(rule, outcome)
    if isinstance(outcome, SystemExit):
        failure = RuleError(
            f"rule {rule.name} ({rule.origin}) called sys.exit: a rule does not end the process; write ctx.stop() "
            "to end the agent"
        )
        failure.__cause__ = outcome
    return Finish(run, "failed", short(failure) + _place(rule, failure), failure)


def _nonsense(rule: Rule[Any, Any], result: Any) -> RuleError:
    if isinstance(result, Coroutine):
        cast("Coroutine[Any, Any, Any]", result).close()
        return RuleError(
            f"rule {rule.name} ({rule.origin}) is a plain function that returned a coroutine: write async def; "
            "the wrapper of a decorator must be async, too"
        )
    return RuleError(
        f"rule {rule.name} ({rule.origin}) returned {short(result)}; a rule may only return None, rs.Resign(reason) "
        "or rs.Retire(); write the result to a slot"
    )


def _place(rule: Rule[Any, Any], failure: BaseException) -> str:
    """Return the line of the rule's file at which the rule failed, e.g. `` (guide.py:42)``; empty if it is unknown."""
    file = rule.origin.rpartition(":")[0]
    line, step = 0, failure.__traceback__
    while step is not None:
        if step.tb_frame.f_code.co_filename == file:
            line = step.tb_lineno
        step = step.tb_next
    return f" ({os.path.basename(file)}:{line})" if line else ""
