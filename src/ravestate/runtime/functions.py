"""The functions of the rules of one context: how they start, are cancelled, and end."""

from __future__ import annotations

import asyncio
from typing import TYPE_CHECKING, Any

from ravestate.declare.rule import Rule
from ravestate.engine.effects import Cancel, Run
from ravestate.engine.events import Finish
from ravestate.runtime.async_rules import AsyncRules
from ravestate.runtime.ending import ending
from ravestate.runtime.plain_rules import PlainRules
from ravestate.runtime.rule_context import RuleContext

if TYPE_CHECKING:
    from ravestate.runtime.runner import Runner


class Functions:
    """Starts, cancels and ends the functions of one context's rules. It reports to the runner how each run has ended.

    Attributes:
        tasks: The runs of async rules.
        plain: The runs of plain functions, in worker threads; None before the first such run.
        last: The rule whose function started last.
        running: Number of a run in progress → its rule context. An async run is here only after its first step.
    """

    def __init__(self, loop: asyncio.AbstractEventLoop, runner: Runner, *, is_virtual: bool) -> None:
        self.tasks = AsyncRules(loop, self)
        self.plain: PlainRules | None = None
        self.last: Rule[Any, Any] | None = None
        self.running: dict[int, RuleContext] = {}
        self._loop = loop
        self._runner = runner
        self._is_virtual = is_virtual
        self._closing = False

    def start(self, effect: Run) -> None:
        """Call a rule's function, unless the context is about to end."""
        if self._closing:
            return
        rule = self.last = effect.rule
        ctx = RuleContext(self._runner, effect)
        if rule.is_async:
            self.tasks.start(ctx)
            if not ctx.ended:
                self.running[effect.run] = ctx
        else:
            self.running[effect.run] = ctx
            if self.plain is None:
                self.plain = PlainRules(self._loop, self.finish)
            self.plain.start(ctx)

    def finish(self, ctx: RuleContext, result: Any, exception: BaseException | None) -> None:
        """Report to the engine how a run has ended (law L18)."""
        runner = self._runner
        if ctx.run in self.running:
            del self.running[ctx.run]
        if not (ctx.ended or runner.closed):
            ctx.ended = "the function has returned"
            parts = runner.short_way() if result is None and exception is None else None
            if parts is not None:
                parts.done(ctx.run)
            else:
                outcome = result if exception is None else exception
                if ctx.cancelled and isinstance(outcome, asyncio.CancelledError):
                    outcome = None
                runner.receive(ending(ctx.run, ctx.rule, outcome, exception is not None))
        if self._is_virtual and not ctx.rule.is_async:
            runner.schedule()

    def drop(self, ctx: RuleContext, reason: str) -> None:
        """End a run, for a `reason`, although its function is still running. The function may no longer act."""
        if self.running.pop(ctx.run, None) is not None and not self._runner.closed:
            ctx.ended = reason
            self._runner.receive(Finish(ctx.run, "done", reason))

    def cancel(self, effect: Cancel) -> None:
        """Cancel a run, if its function is still running."""
        ctx = self.running.get(effect.run)
        if ctx is None:
            return
        if ctx.rule.is_async:
            self.tasks.cancel(ctx, effect.reason)
        else:
            assert self.plain is not None  # the run has started
            self.plain.abandon(ctx)
            self.drop(ctx, effect.reason)

    def holds(self, *, halted: bool) -> bool:
        """Return whether the engine's effects must wait: for cancelled rules or, in virtual time, for a plain function.

        While the clock is `halted`, effects do not wait for the cancelled rules.
        """
        if self._is_virtual and self.plain is not None and self.plain.runs:
            return True
        return bool(self.tasks.cleaning) and not halted

    def plain_names(self) -> list[str]:
        """Return the names of the rules whose plain functions are running, one for each run."""
        return [] if self.plain is None else [ctx.rule.name for ctx in self.plain.runs]

    def go_on(self) -> None:
        """Perform the effects that waited for the last writes of cancelled rules."""
        self._runner.pump()

    async def cancel_all(self, reason: str, *, at_once: bool) -> None:
        """Cancel all async rules. Unless `at_once`, give them time to clean up. No function starts from now on."""
        self._closing = True
        await self.tasks.close(reason, at_once=at_once)

    def abandon(self, reason: str) -> None:
        """End all runs, for a `reason`. Their functions may no longer act."""
        for ctx in self.running.values():
            ctx.ended = reason
        self.running.clear()
        if self.plain is not None:
            self.plain.close()
