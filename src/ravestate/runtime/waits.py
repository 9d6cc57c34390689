"""Tasks that wait until an engine reaches a certain state."""

from __future__ import annotations

import asyncio
import contextlib
from collections.abc import Callable, Mapping

from ravestate.engine.activation import NEVER, Activation
from ravestate.engine.engine import Engine

FLAGS = ("core:activity", "core:pressure")
"""The built-in flags (L22). They also change because of the shutdown, and then start background rules."""


class Waits:
    """The tasks that wait until an engine reaches a certain state.

    Effects are the engine's instructions, such as to start a rule. While `is_busy()` is true, some effects have not
    been performed yet. A call of `schedule` makes the loop perform these effects, and then call `check`.
    """

    def __init__(self, engine: Engine, is_busy: Callable[[], bool], schedule: Callable[[], None]) -> None:
        self.futures: dict[asyncio.Future[None], Callable[[], bool]] = {}
        """Future of a waiting task → a function that returns whether the task's state is reached."""
        self._engine = engine
        self._is_busy = is_busy
        self._schedule = schedule
        self._ended = False

    async def until(self, reached: Callable[[], bool]) -> None:
        """Wait until all effects are performed and `reached` is true.

        `reached` may become true only because of an effect or the end of a run.
        """
        if not self._ended and (self._is_busy() or not reached()):
            future: asyncio.Future[None] = asyncio.get_running_loop().create_future()
            self.futures[future] = reached
            self._schedule()
            await future

    def check(self) -> None:
        """Wake the tasks whose state is reached now."""
        for future in [future for future, reached in self.futures.items() if reached()]:
            del self.futures[future]
            if not future.done():
                future.set_result(None)

    def end(self, error: BaseException | None = None) -> None:
        """Wake all tasks; if `error` is given, they raise it. Later tasks do not wait."""
        self._ended = True
        for future in self.futures:
            if future.done():
                continue
            if error is None:
                future.set_result(None)
            else:
                future.set_exception(error)
        self.futures.clear()

    def is_quiet(self, slot: str | None = None) -> bool:
        """Return whether no foreground rule runs, or is ready and waits to run.

        With a slot, ignore rules that cannot cause a write of the slot.
        """
        alive = [activation.clause.rule for activation in (*self._engine.running.values(), *self._engine.waiting)]
        if slot is not None and alive:
            policy = self._engine.policy
            leading = policy.causes.ancestors(policy.slot_of[slot].signals[0].index)
            alive = [rule for rule in alive if rule.index in leading]
        return all(rule.background for rule in alive)

    def alive(self) -> dict[int, Activation]:
        """Return the activations that run, or are ready and wait to run, by number."""
        return {a.id: a for a in (*self._engine.running.values(), *self._engine.waiting)}

    async def until_others_end(self, known: Mapping[int, Activation], seconds: float) -> None:
        """Wait until all activations outside `known` have ended.

        Also wait while an activation that holds a spike of ``rs.shutdown`` waits for the `min_age` of one of its
        spikes. A background rule may run endlessly, if it has an activation in `known`, or reacts only to
        ``rs.activity`` or ``rs.pressure``. So wait for a new run of such a rule only if ``rs.shutdown`` led to that run.
        In any case, wait for at most `seconds`.
        """
        engine = self._engine
        shutdown = engine.policy.signal_of["core:shutdown"].index
        flags = {signal for name in FLAGS for signal in engine.policy.slot_of[name].signals}
        loops = {a.clause.rule.name for a in known.values() if a.clause.rule.background}

        def counts(activation: Activation) -> bool:
            rule, spikes = activation.clause.rule, [spike for spike in activation.spikes if spike is not None]
            if any(spike.comes_from("core:shutdown") for spike in spikes):
                return True
            endless = rule.background and all(spike.signal in flags for spike in spikes)
            return rule.name not in loops and not endless

        def done() -> bool:
            if any(holder.ripens != NEVER for s in engine.state.live.get(shutdown, ()) for holder in s.holders):
                return False
            return not any(n not in known and counts(a) for n, a in self.alive().items())

        with contextlib.suppress(TimeoutError):
            await asyncio.wait_for(self.until(done), seconds)
