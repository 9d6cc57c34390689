"""The runner of one engine on an asyncio loop. It passes events on, performs the effects, and keeps one timer.

An *effect* is an instruction of the engine, for instance to call the function of a rule.
"""

from __future__ import annotations

import asyncio
import contextlib
import logging
import random
from asyncio.tasks import _enter_task, _leave_task  # pyright: ignore[reportPrivateUsage]  # documented for task implementations
from collections.abc import Callable, Mapping
from threading import get_ident
from time import perf_counter
from typing import Any, Final, Protocol

from ravestate.declare.rule import Rule
from ravestate.declare.wording import said
from ravestate.engine.effects import Cancel, Effect, Ended, Failed, Run, Spiked
from ravestate.engine.engine import Engine
from ravestate.engine.events import AddRule, Emit, Event, Write
from ravestate.engine.parts import Parts
from ravestate.engine.trace import Record
from ravestate.errors import EngineError, PlatformError, RavestateError, RunEnded
from ravestate.policy.policy import Policy
from ravestate.runtime.clock import Clock
from ravestate.runtime.functions import Functions
from ravestate.runtime.journal import Taken
from ravestate.runtime.listeners import Hooks, Listeners
from ravestate.runtime.timer import Timer
from ravestate.runtime.waits import Waits

# In a round, the runner takes the engine's effects and performs them.
ENDLESS = 200_000  # an instant of virtual time counts as endless after this many rounds of effects
BATCH: Final = 512  # the loop gets a turn after this many rounds of effects, so that a busy agent still hears input
TURN: Final = 0.02  # the loop gets a turn after this many real seconds, even after fewer rounds than `BATCH`

SETTLES: Final = 64
"""The loop gets a turn after this many calls of `Runner.settle` in a row."""

ENDED = "the context has ended"

# The compiled build looks an imported name up each time, but not a constant.
THREAD: Final = get_ident
CURRENT: Final = asyncio.current_task
ENTER: Final = _enter_task
LEAVE: Final = _leave_task

log = logging.getLogger("ravestate")


class Stoppable(Protocol):
    """The part of a `Context` that its runner uses."""

    def ask_to_stop(self) -> None: ...


class Runner:
    """Gives events to an engine, and performs the effects that the engine returns.

    `Context` and `RuleContext` (see `rule_context.Host`) call its public methods. The runner asks the `agent` to stop
    when a rule asks the context to end, or when the engine fails. It calls `journal` with each event before the engine
    receives this event, and with `Taken` before the runner takes the engine's effects.
    """

    def __init__(
        self,
        engine: Engine,
        loop: asyncio.AbstractEventLoop,
        settings: Mapping[str, Any],
        seed: int | None,
        agent: Stoppable,
        hooks: Hooks,
        journal: Callable[[Event | Taken, float], None] | None,
    ) -> None:
        self.loop = loop
        self.settings = settings
        self.clock = Clock(loop)
        self.listeners = Listeners(engine.watched, hooks.listeners)
        self.closed = False
        self.fault: RavestateError | None = None
        """The error that ends the context, from a rule (``ctx.stop``) or from the engine; None without an error."""
        self._engine = engine
        self._agent = agent
        self._hooks = hooks
        self._journal = journal
        self._is_virtual = hooks.on_endless is not None
        self._home = get_ident()  # the identifier of the loop's thread
        self._seed = seed
        self._random: random.Random | None = None
        self.functions = Functions(loop, self, is_virtual=self._is_virtual)
        self._waits: Waits | None = None  # made when the first task waits
        self._todo: list[Effect] | None = None  # the effects that are still to be performed, in reverse order
        self._due = False  # whether the engine may have effects
        self._scheduled = False  # whether the loop will call `_turn`
        self._settled = 0  # how often `settle` has performed effects since the loop's last turn
        self._pumping = False
        self._instant = -1.0
        self._rounds = 0  # how many rounds of effects there were in the current instant
        self._timer = Timer(loop, self.clock, self._wake)

    # ------------------------------------------------------------------------------------ events in

    @property
    def now(self) -> float:
        """The time on the context's clock: seconds since the runner was made."""
        return self.clock.now()

    @property
    def waits(self) -> Waits:
        """The tasks that wait until the engine reaches a certain state."""
        if self._waits is None:
            self._waits = Waits(self._engine, self._is_busy, self.schedule)
        return self._waits

    @property
    def policy(self) -> Policy:
        """The engine's policy, with the rules that were added to it."""
        return self._engine.policy

    @property
    def random(self) -> random.Random:
        """Random numbers from the context's seed."""
        if self._random is None:
            self._random = random.Random(self._seed)
        return self._random

    def emit(self, signal: str, payload: Any, run: int | None, origin: Any = None) -> None:
        """Raise a signal for a run; if `run` is None, for code outside the rules. Any thread may call this."""
        parts = self.short_way()
        if parts is not None:
            parts.emit(signal, payload, run, origin)
        else:
            self.receive(Emit(signal, payload, run, origin))

    def write(self, slot: str, value: Any, run: int | None, origin: Any = None) -> None:
        """Write a slot for a run; if `run` is None, for code outside the rules. Any thread may call this."""
        parts = self.short_way()
        if parts is not None:
            parts.write(slot, value, run, origin)
        else:
            self.receive(Write(slot, value, run, origin))

    def short_way(self) -> Parts | None:
        """Return the engine's `Parts`, its inner objects, if an event may go directly to them; else None.

        This way is faster than `receive`.
        """
        if self._journal is not None or self.closed or THREAD() != self._home:
            return None
        if self._pumping:
            return self._engine.parts_at(self._instant)
        parts = self._engine.parts_at(self.clock.now())
        self.schedule()
        return parts

    def receive(self, event: Event) -> None:
        """Give the engine an event. Any thread may call this."""
        if get_ident() != self._home:
            with contextlib.suppress(RuntimeError):  # the context has ended, and its loop is closed
                self.loop.call_soon_threadsafe(self._receive_late, event)
            return
        if self.closed:
            return
        # All events that arrive while effects are performed belong to one instant.
        now = self._instant if self._pumping else self.clock.now()
        if self._journal is not None:
            self._journal(event, now)
        self._engine.receive(event, now)
        if not self._pumping:
            self.schedule()

    def _receive_late(self, event: Event) -> None:
        """Receive an event that another thread has sent, unless the event's run has ended in the meantime."""
        run = getattr(event, "run", None)
        if run is None or run in self.functions.running:
            self.receive(event)

    def add_rule(self, rule: Rule[Any, Any]) -> None:
        """Add a rule to the engine's policy. Any thread may call this; the loop makes the new policy."""
        if get_ident() == self._home:
            self.receive(AddRule(self.policy.with_rule(rule, self.settings)))
            return
        added = asyncio.run_coroutine_threadsafe(self._add_rule_late(rule), self.loop)
        while not self.closed:
            with contextlib.suppress(TimeoutError):
                added.result(1.0)
                return
        raise RunEnded(f"rule {rule.name} was not added: {ENDED}")

    async def _add_rule_late(self, rule: Rule[Any, Any]) -> None:
        self.add_rule(rule)

    # ------------------------------------------------------------------------------------ effects out

    def schedule(self) -> None:
        """Perform the engine's effects in the loop's next turn."""
        self._due = True
        if not self._scheduled:
            self._scheduled = True
            self.loop.call_soon(self._turn)

    def _turn(self) -> None:
        self._scheduled = False
        self._settled = 0
        if self._due:
            self.pump()

    def settle(self) -> None:
        """Perform now the effects of the loop's next turn, because a task is about to wait for a spike.

        Other tasks get no turn meanwhile. So after `SETTLES` calls, the effects wait for the loop's next turn. In
        virtual time, and inside a rule, the effects always wait for that turn.
        """
        if self._due and self._settled < SETTLES and not (self._pumping or self._is_virtual):
            self._settled += 1
            self.pump()

    def pump(self) -> None:
        """Perform the effects that are due now."""
        self._due = False
        if self.closed or self.clock.halted:
            return
        self._work_off(BATCH)
        self._timer.set(self._engine.next_deadline())
        if self._waits is not None and self._waits.futures and not self._is_busy():
            self._waits.check()

    def _is_busy(self) -> bool:
        """Return whether some effects have not been performed yet."""
        return bool(self._due or self._pumping or self._todo or self.functions.tasks.cleaning)

    def _work_off(self, rounds: int) -> bool:
        """Take and perform the engine's effects, for at most `rounds` rounds; return whether there were any effects."""
        engine, functions = self._engine, self.functions
        rules = functions.tasks
        began = self.clock.now()
        if began != self._instant:
            self._rounds = 0
        self._instant = began
        if self._hooks.on_endless is not None and (self._rounds > ENDLESS or engine.late_turns > ENDLESS // 20):
            self.closed = True
            self._hooks.on_endless("" if self.functions.last is None else self.functions.last.name)
            return False
        some = False
        self._pumping = True
        turn_ends = perf_counter() + TURN
        around = CURRENT(self.loop)
        if around is not None:  # no task may be current when a rule starts
            LEAVE(self.loop, around)
        todo = self._todo or []
        try:
            for _ in range(rounds):
                if (self._is_virtual or rules.cleaning) and functions.holds(halted=self.clock.halted):
                    break  # effects must wait for functions; when these have ended, the runner goes on
                self._rounds += 1
                if not todo:
                    if self._journal is not None:
                        self._journal(Taken(), engine.now)
                    try:
                        todo = self._todo = engine.effects()
                    except Exception as error:
                        self._break(error)
                        return False
                    if not todo:
                        break
                    todo.reverse()
                some = True
                while todo and not ((self._is_virtual or rules.cleaning) and functions.holds(halted=self.clock.halted)):
                    self._perform(todo.pop())
                if not self._is_virtual and perf_counter() > turn_ends:
                    self.schedule()
                    break
            else:
                self.schedule()
        except BaseException:  # e.g. a rule raised KeyboardInterrupt: the loop may still run other rules
            self.schedule()
            raise
        finally:
            self._pumping = False
            rules.rest()
            if not todo:
                self._todo = None
            if around is not None:
                ENTER(self.loop, around)
        return some

    def _perform(self, effect: Effect) -> None:
        kind = type(effect)
        if kind is Run:
            self.functions.start(effect)  # type: ignore[arg-type]  # its type has been checked
        elif kind is Spiked:
            self.listeners.tell(effect)  # type: ignore[arg-type]
        elif isinstance(effect, Ended):
            if self._hooks.on_ended is not None:
                self._hooks.on_ended(effect)
        elif isinstance(effect, Cancel):
            self.functions.cancel(effect)
        elif isinstance(effect, Failed):
            self._failed(effect)

    def _failed(self, effect: Failed) -> None:
        if self._hooks.on_failed is not None:
            self._hooks.on_failed(effect.rule, effect.exception)
        # The message of a platform error says what to fix outside the code; a traceback would not help.
        trace = None if isinstance(effect.exception, PlatformError) else effect.exception
        log.error("rule %s failed: %s", effect.rule, said(effect.exception), exc_info=trace)

    def _break(self, error: Exception) -> None:
        """End the context with an error: the engine itself has failed, so nothing works any longer."""
        self.fault = EngineError(f"the engine has failed, which is a bug in ravestate: {error!r}")
        self.fault.__cause__ = error
        self.closed = True
        fault = self.fault
        self.listeners.fail(lambda signal: fault)
        self.waits.end(fault)
        self._agent.ask_to_stop()

    # ------------------------------------------------------------------------------------ time

    def pause(self) -> None:
        """Halt the clock: the engine still takes events, but no effect is performed, and no deadline passes."""
        self.clock.halt()

    def step(self) -> bool:
        """Perform the next round of effects while the clock is halted. If none is due, first set the clock forward.

        Returns:
            False if the clock is not halted, or if nothing is due, not even at a later time; else True.
        """
        if not self.clock.halted or self.closed:
            return False
        waiting = list(self._engine.waiting)
        if self._work_off(1) or list(self._engine.waiting) != waiting:
            return True
        dues = [due for due in (self._engine.next_deadline(), self.clock.next_waking()) if due is not None]
        if dues:
            self.clock.set(min(dues))
            self._fall_due()
            self._work_off(1)
        return bool(dues)

    def resume(self) -> None:
        """Start a halted clock again from its present time. If it was driven to a later time meanwhile, start there."""
        if self.clock.halted:
            self.clock.go()
            self._timer.clear()
            self.schedule()  # not now: the caller may be a task, and no task may be current when a rule starts

    def drive(self, time: float) -> None:
        """Set the clock forward to `time` (seconds). The clock then no longer moves by itself; see `Clock.drive`."""
        self.clock.drive(time)
        self._timer.clear()
        due = self._engine.next_deadline()
        if due is not None and due <= self.clock.now() and not self.closed and not self.clock.halted:
            self._fall_due(due)
            self.schedule()

    def engine_now(self) -> Engine:
        """Return the engine for inspection, after it has handled all deadlines that are due."""
        self._engine.advance(max(self._engine.now, self.clock.now()))
        return self._engine

    def read(self, slot: str) -> Any:
        """Return the current value of the slot with this qualified name."""
        return self._engine.read(self.policy.slot_of[slot].index)

    def trace(self, tracer: Callable[[Record], None] | None) -> None:
        """Call `tracer` with each new record of the trace; None stops the calls."""
        self._engine.tracer = tracer

    def _wake(self, due: float) -> None:
        if not self.closed and not self.clock.halted:
            self._fall_due(due)
            self.pump()

    def _fall_due(self, due: float = 0.0) -> None:
        try:
            self._engine.advance(max(self.clock.now(), due))
        except Exception as error:
            self._break(error)

    # ------------------------------------------------------------------------------------ the end

    async def quiet(self, slot: str | None = None) -> None:
        """Wait until no foreground rule runs, or is ready and waits to run.

        With a slot, ignore rules that cannot cause a write of the slot.
        """
        await self.waits.until(lambda: self.waits.is_quiet(slot))

    def stop(self, failure: RavestateError | None) -> None:
        """Ask the context to end. The first `failure` counts."""
        self.fault = self.fault or failure
        self._agent.ask_to_stop()

    async def close(self, *, at_once: bool = False) -> None:
        """Cancel all runs; unless `at_once`, give them a few seconds to clean up. From now on, no rule starts."""
        await self.functions.cancel_all(ENDED, at_once=at_once)
        self.closed = True
        self.functions.abandon(ENDED)
        self._timer.clear()
        self.listeners.fail(lambda signal: EngineError(f"the context ended before there was a {signal}"))
        self.waits.end()
        await asyncio.sleep(0)  # so that the cancelled tasks end
