"""The runner drives one engine on an asyncio loop: events in, effects done, one timer."""

from __future__ import annotations

import asyncio
import contextlib
import functools
import logging
import random
import threading
from collections import deque
from collections.abc import Callable, Mapping
from time import perf_counter
from typing import Any, cast

from ravestate.declare.rule import Rule
from ravestate.engine.activation import NEVER, Activation
from ravestate.engine.effects import Cancel, Effect, Ended, Failed, Run, Spiked
from ravestate.engine.engine import Engine
from ravestate.engine.events import AddRule, Event, Finish
from ravestate.engine.foreign import said
from ravestate.errors import EngineError, PlatformError, RavestateError, RunEnded
from ravestate.runtime.clock import Clock
from ravestate.runtime.ending import ending, short
from ravestate.runtime.journal import Taken
from ravestate.runtime.nest import Nest
from ravestate.runtime.rule_context import RuleContext
from ravestate.runtime.workers import Order, Workers

__all__ = ["BLOCKING", "Runner"]

BLOCKING = 0.1
"""Seconds that one step of an async rule may take before a warning names it: nothing else runs meanwhile."""

GRACE = 5.0
"""Seconds that a cancelled rule has for its cleaning up before its run counts as ended."""

ENDLESS = 200_000
"""Rounds of effects in one instant of virtual time after which it counts as one that does not end."""

CLEANING = 10
"""Turns of the loop that a cancelled rule has before anything else is done, for what it writes at once."""

BATCH = 512
"""Rounds of effects after which the loop gets a turn, so that a busy agent still hears and sees."""

log = logging.getLogger("ravestate")


class Runner:
    """Feeds an engine, and performs what it asks for.

    Args:
        engine: The engine.
        loop: The loop on which everything happens.
        settings: The settings of each module.
        seed: Of the random numbers that rules use.
        stop: Called when a rule asks the context to end.
    """

    def __init__(
        self,
        engine: Engine,
        loop: asyncio.AbstractEventLoop,
        settings: Mapping[str, Any],
        seed: int | None,
        stop: Callable[[], None],
    ) -> None:
        self.engine = engine
        self.loop = loop
        self.settings = settings
        self.random = random.Random(seed)
        self.ask_to_stop = stop
        self.on_event: Callable[[Event | Taken, float], None] | None = None
        """Told of every event before the engine is, and of when its effects are taken: the journal."""
        self.on_ended: Callable[[Ended], None] | None = None
        self.on_failed: Callable[[str, BaseException], None] | None = None
        self.serial = False
        """Whether plain functions run one after the other, so that threads do not race in a simulation."""
        self.listeners: dict[str, Callable[[Any], None]] = {}
        """Called with the payload of every spike of a signal, by name; see `listen`."""
        self.futures: dict[str, list[asyncio.Future[Any]]] = {}
        """Who waits for the next spike of a signal, by name."""
        self.workers = Workers()
        self.threads: dict[int, Rule[Any, Any]] = {}
        """The runs of plain functions that are waited for, and their rules."""
        self._thread = threading.get_ident()
        self.clock = Clock(loop)
        self._scheduled = False
        self._pumping = False
        self._instant = -1.0
        self._rounds = 0  # of effects in this very instant
        self._last_run = ""
        self.on_endless: Callable[[str], None] | None = None
        """Told of the rule that ran last when an instant does not end (in virtual time, where it would stand still)."""
        self.fault: RavestateError | None = None
        """Why the context cannot go on: a rule has said so, or the engine itself has failed."""
        self._timer: asyncio.TimerHandle | None = None
        self._timer_due = 0.0
        self._contexts: dict[int, RuleContext] = {}
        self._nests: dict[int, Nest] = {}
        self._orders: dict[int, Order] = {}
        self._cleaning: list[asyncio.Task[Any]] = []  # cancelled just now
        self._spare: Nest | None = None
        self._is_async: dict[Rule[Any, Any], bool] = {}
        self._awaited: list[tuple[Callable[[], bool], asyncio.Future[None]]] = []
        self._patience: dict[int, asyncio.TimerHandle] = {}  # with what was cancelled and has not ended
        self._closing = False
        self._todo: deque[Effect] = deque()
        self.closed = False

    # ------------------------------------------------------------------------------------ events in

    def now(self) -> float:
        """Seconds since the runner was made."""
        return self.clock.now()

    def receive(self, event: Event) -> None:
        """Give the engine an event; from any thread."""
        if threading.get_ident() != self._thread:
            with contextlib.suppress(RuntimeError):  # the loop is closed: the context has ended
                self.loop.call_soon_threadsafe(self._receive_late, event)
            return
        if self.closed:
            return
        # What happens while effects are performed happens in one instant.
        now = self._instant if self._pumping else self.now()
        if self.on_event is not None:
            self.on_event(event, now)
        self.engine.receive(event, now)
        if not self._pumping:
            self._schedule()

    def _schedule(self) -> None:
        if not self._scheduled:
            self._scheduled = True
            self.loop.call_soon(self._pump)

    def add_rule(self, rule: Rule[Any, Any]) -> None:
        """Add a rule to the engine's policy; from any thread. The policy is made on the loop, so that none is lost.

        Raises:
            DeclarationErrors: The rule does not fit.
        """
        if threading.get_ident() == self._thread:
            self.receive(AddRule(self.engine.policy.with_rule(rule, self.settings)))
            return
        added = asyncio.run_coroutine_threadsafe(self._add_rule_late(rule), self.loop)
        while not self.closed:
            with contextlib.suppress(TimeoutError):
                added.result(1.0)
                return
        raise RunEnded(f"rule {rule.name} was not added: the context has ended")

    async def _add_rule_late(self, rule: Rule[Any, Any]) -> None:
        self.add_rule(rule)

    def _receive_late(self, event: Event) -> None:
        """What another thread gave; its run may have ended on the way."""
        run = getattr(event, "run", None)
        if run is None or run in self._contexts:
            try:
                self.receive(event)
            except Exception:  # nobody stands above us: the designer must see it all the same
                log.exception("what another thread asked for was refused: %s", short(event))

    # ------------------------------------------------------------------------------------ effects out

    def _pump(self) -> None:
        self._scheduled = False
        if self.closed or self.clock.halted:
            return
        self._work_off(BATCH)
        self._arm()
        if self._awaited and not (self._scheduled or self._todo or self._cleaning):
            reached = [entry for entry in self._awaited if entry[0]()]
            for entry in reached:
                self._awaited.remove(entry)
                if not entry[1].done():
                    entry[1].set_result(None)

    def _held(self) -> bool:
        """Whether others come first: a plain function in a simulation, or rules that have just been cancelled."""
        return bool((self.serial and self.threads) or (self._cleaning and not self.clock.halted))

    def _work_off(self, rounds: int) -> bool:
        """Take and perform effects, for so many rounds at most; whether there were any."""
        engine = self.engine
        began = self.now()
        if began != self._instant:
            self._rounds = 0
        self._instant = began
        if self.on_endless is not None and (self._rounds > ENDLESS or self.engine.late_turns > ENDLESS // 20):
            self.closed = True
            self.on_endless(self._last_run)
            return False
        some = False
        self._pumping = True
        try:
            for _ in range(rounds):
                if self._held():
                    break  # go on when they have ended
                self._rounds += 1
                if not self._todo:
                    if self.on_event is not None:
                        self.on_event(Taken(), engine.now)
                    try:
                        self._todo.extend(engine.effects())
                    except Exception as error:
                        self._break(error)
                        return False
                    if not self._todo:
                        break
                some = True
                while self._todo and not ((self.serial or self._cleaning) and self._held()):
                    self._perform(self._todo.popleft())
            else:
                self._schedule()
        except (
            BaseException
        ):  # a rule has interrupted the process: the others go on, for as long as the loop does
            self._schedule()
            raise
        finally:
            self._pumping = False
        return some

    def pause(self) -> None:
        """Halt the clock: events are still taken, but nothing is done about them, and nothing falls due."""
        self.clock.halt()

    def step(self) -> bool:
        """While it is paused: do what is due next, one wave of it; if that lies ahead, set the clock forward to it.

        Returns:
            Whether there was anything to do.
        """
        if not self.clock.halted or self.closed:
            return False
        waiting = list(self.engine.waiting)
        if self._work_off(1) or list(self.engine.waiting) != waiting:
            return True
        dues = [due for due in (self.engine.next_deadline(), self.clock.next_waking()) if due is not None]
        if dues:
            self.clock.set(min(dues))
            self._fall_due()
            self._work_off(1)
        return bool(dues)

    def resume(self) -> None:
        """Let the clock go on."""
        if self.clock.halted:
            self.clock.go()
            if self._timer is not None:
                self._timer.cancel()
                self._timer = None
            self._schedule()  # not at once: a task may be asking, and rules are started outside of any

    def _arm(self) -> None:
        """Set the one timer, unless it is early enough already: waking for nothing is harmless."""
        due = self.engine.next_deadline()
        if due is None or (self._timer is not None and self._timer_due <= due):
            return
        if self._timer is not None:
            self._timer.cancel()
        self._timer_due = due
        self._timer = self.loop.call_at(self.clock.on_loop(due), self._wake)

    def _wake(self) -> None:
        self._timer = None
        if not self.closed and not self.clock.halted:
            self._fall_due(self._timer_due)
            self._pump()

    def _fall_due(self, due: float = 0.0) -> None:
        try:
            self.engine.advance(max(self.now(), due))
        except Exception as error:
            self._break(error)

    def _break(self, error: Exception) -> None:
        """The engine itself has failed: rather than to go on half alive, the context ends, and says why."""
        self.fault = EngineError(f"the engine has failed, which is a fault of ravestate's: {error!r}")
        self.fault.__cause__ = error
        self.closed = True
        for future in [
            *(future for waiting in self.futures.values() for future in waiting),
            *(future for _, future in self._awaited),
        ]:
            if not future.done():
                future.set_exception(self.fault)
        self.futures.clear()
        self._awaited.clear()
        self.ask_to_stop()

    def _perform(self, effect: Effect) -> None:
        kind = type(effect)
        if kind is Run:
            self._run(effect)  # type: ignore[arg-type]  # its type has been looked at
        elif kind is Spiked:
            self._tell(effect)  # type: ignore[arg-type]
        elif isinstance(effect, Ended):
            if self.on_ended is not None:
                self.on_ended(effect)
        elif isinstance(effect, Cancel):
            self._cancel(effect)
        elif isinstance(effect, Failed):
            if self.on_failed is not None:
                self.on_failed(effect.rule, effect.exception)
            told = isinstance(
                effect.exception, PlatformError
            )  # its message says all: what to mend, not where
            log.error(
                "rule %s failed: %s",
                effect.rule,
                said(effect.exception),
                exc_info=None if told else effect.exception,
            )

    def listen(self, signal: str, listener: Callable[[Any], None]) -> None:
        """Have a function called with the payload of every spike of a signal."""
        self.listeners[signal] = listener
        self.engine.watched[signal] = 1

    def _tell(self, spiked: Spiked) -> None:
        listener = self.listeners.get(spiked.signal)
        if listener is not None:
            listener(spiked.payload)
        else:
            self.engine.watched.pop(spiked.signal, None)
        for future in self.futures.pop(spiked.signal, ()):
            if not future.done():
                future.set_result(spiked.payload)

    # ------------------------------------------------------------------------------------ runs

    def _run(self, effect: Run) -> None:
        if self._closing:
            return
        rule = effect.rule
        self._last_run = rule.name
        ctx = RuleContext(self, effect)
        self._contexts[effect.run] = ctx
        is_async = self._is_async.get(rule)
        if is_async is None:
            is_async = self._is_async[rule] = _is_async(rule.function)
        if not is_async:
            try:
                order = self.workers.submit(functools.partial(self._work, effect.run, rule, ctx))
            except RuntimeError as error:
                self._finish(effect.run, rule, None, error)
            else:
                self.threads[effect.run] = rule
                self._orders[effect.run] = order
            return
        nest = self._spare
        if nest is None:
            nest = self._spare = Nest(self.loop, self._blocked)
        began = perf_counter()
        try:
            nest.first_step(rule.function(ctx), rule)
        except StopIteration as stop:
            took = perf_counter() - began
            self._finish(effect.run, rule, stop.value, None)
        except BaseException as exception:  # a rule may raise anything
            took = perf_counter() - began
            self._finish(effect.run, rule, None, exception)
            if isinstance(exception, KeyboardInterrupt):
                raise
        else:
            took = perf_counter() - began
            self._spare = None
            self._nests[effect.run] = nest
            nest.task.add_done_callback(functools.partial(self._task_done, effect.run, rule))
        if took > BLOCKING:
            self._blocked(rule, took)
        if nest.spoilt and nest is self._spare:
            nest.close()
            self._spare = None

    def _task_done(self, run: int, rule: Rule[Any, Any], task: asyncio.Task[Any]) -> None:
        self._nests.pop(run, None)
        if task.cancelled():
            self._finish(run, rule, None, asyncio.CancelledError())
        else:
            exception = task.exception()
            self._finish(run, rule, None if exception is not None else task.result(), exception)

    def _work(self, run: int, rule: Rule[Any, Any], ctx: RuleContext) -> None:
        """In a worker thread: call a plain function."""
        if ctx.ended:
            return  # it was cancelled before there was a thread for it
        result, exception = None, None
        try:
            result = rule.function(ctx)
        except BaseException as raised:  # a rule may raise anything
            exception = raised
        with contextlib.suppress(
            RuntimeError
        ):  # the loop is closed: the context ended while the function ran
            self.loop.call_soon_threadsafe(self._work_done, run, rule, result, exception)

    def _work_done(
        self, run: int, rule: Rule[Any, Any], result: Any, exception: BaseException | None
    ) -> None:
        self.threads.pop(run, None)
        self._orders.pop(run, None)
        self._finish(run, rule, result, exception)
        if self.serial:
            self._schedule()

    def _finish(self, run: int, rule: Rule[Any, Any], result: Any, exception: BaseException | None) -> None:
        """Report how a run has ended (L18)."""
        ctx = self._contexts.pop(run, None)
        patience = self._patience.pop(run, None)
        if patience is not None:
            patience.cancel()
        if ctx is None or self.closed:
            return  # given up before
        cancelled = bool(ctx.told)
        ctx.ended = ctx.ended or "the function has returned"
        told = result if exception is None else exception
        if cancelled and isinstance(told, asyncio.CancelledError):
            told = None
        self.receive(ending(run, rule, told, exception is not None))

    def _cancel(self, effect: Cancel) -> None:
        ctx = self._contexts.get(effect.run)
        if ctx is None:
            return
        nest = self._nests.get(effect.run)
        if nest is None:  # a thread cannot be stopped: its run ends now, and it may not act any more
            ctx.ended = effect.reason
            del self._contexts[effect.run]
            self.threads.pop(effect.run, None)
            self.workers.let_go(self._orders.pop(effect.run))
            self.receive(Finish(effect.run, "done", effect.reason))
            return
        ctx.told = effect.reason
        nest.task.cancel()
        self._cleaning.append(nest.task)
        if len(self._cleaning) == 1:
            self.loop.call_soon(self._go_on, CLEANING)
        self._patience[effect.run] = self.loop.call_later(GRACE, self._give_up, effect.run)

    def _go_on(self, turns: int) -> None:
        """After a cancellation: work on once the cancelled have cleaned up, or wait for something."""
        if turns and not all(task.done() for task in self._cleaning):
            self.loop.call_soon(self._go_on, turns - 1)
        else:
            self._cleaning.clear()
            self._pump()

    def _give_up(self, run: int) -> None:
        """A cancelled rule did not end in time."""
        self._patience.pop(run, None)
        ctx = self._contexts.pop(run, None)
        if ctx is not None and not self.closed:
            ctx.ended = "it did not end in time"
            self._warn_of(ctx.rule)
            self.receive(Finish(run, "done", ctx.ended))

    def _warn_of(self, rule: Rule[Any, Any]) -> None:
        log.warning(
            "rule %s (%s) did not end within %g s of being cancelled: let asyncio.CancelledError through, and clean up "
            "quickly",
            rule.name,
            rule.origin,
            GRACE,
        )

    def _blocked(self, rule: Rule[Any, Any], seconds: float) -> None:
        if seconds > BLOCKING:
            log.warning(
                "rule %s (%s) blocked the loop for %.0f ms: make it a plain function (it then runs in a thread), or await "
                "what takes so long",
                rule.name,
                rule.origin,
                1000 * seconds,
            )

    # ------------------------------------------------------------------------------------ quiet, and the end

    def is_quiet(self) -> bool:
        """Whether no rule of the foreground runs or is kept waiting."""
        engine = self.engine
        return all(a.clause.rule.background for a in (*engine.waiting, *engine.running.values()))

    async def quiet(self) -> None:
        """Wait for `is_quiet`."""
        await self.until(self.is_quiet)

    async def until(self, reached: Callable[[], bool]) -> None:
        """Wait until all effects are performed and something is reached, which only effects and ends of runs bring."""
        if self.closed:
            return
        if self._scheduled or self._pumping or self._todo or self._cleaning or not reached():
            future: asyncio.Future[None] = self.loop.create_future()
            self._awaited.append((reached, future))
            self._schedule()
            await future

    def alive(self) -> dict[int, Activation]:
        """Activations that run, or are ready and wait, by their numbers."""
        return {a.id: a for a in (*self.engine.running.values(), *self.engine.waiting)}

    async def wait_for_others(self, known: Mapping[int, Activation], seconds: float) -> None:
        """Wait, for some seconds at most, until nothing runs or is kept waiting besides what is `known` by its number,
        and nothing waits for ``rs.shutdown`` to grow old enough.

        Rules in the background that were at work before may begin again for ever: they count only if they do something
        about ``rs.shutdown``.
        """
        shutdown = self.engine.policy.signal_of["core:shutdown"].index
        loops = {a.clause.rule.name for a in known.values() if a.clause.rule.background}

        def counts(activation: Activation) -> bool:
            return activation.clause.rule.name not in loops or any(
                spike is not None and spike.comes_from("core:shutdown") for spike in activation.spikes
            )

        def done() -> bool:
            if any(
                holder.ripens != NEVER for s in self.engine.live.get(shutdown, ()) for holder in s.holders
            ):
                return False
            return not any(n not in known and counts(a) for n, a in self.alive().items())

        with contextlib.suppress(TimeoutError):
            await asyncio.wait_for(self.until(done), seconds)

    async def close(self, *, at_once: bool = False) -> None:
        """Cancel whatever runs, and let it clean up, `at_once` without waiting; what refuses to end is given up.
        Nothing is started any more."""
        self._closing = True
        for run, nest in self._nests.items():
            ctx = self._contexts.get(run)
            if ctx is not None:
                ctx.told = "the context has ended"
            nest.task.cancel()
        if self._nests:
            await asyncio.wait([nest.task for nest in self._nests.values()], timeout=0 if at_once else GRACE)
        self.closed = True
        for run, nest in self._nests.items():
            ctx = self._contexts.get(run)
            if ctx is not None and not at_once:
                self._warn_of(ctx.rule)
            nest.abandon()
        for ctx in self._contexts.values():
            ctx.ended = "the context has ended"
        self._contexts.clear()
        self.threads.clear()
        self._orders.clear()
        if self._timer is not None:
            self._timer.cancel()
        if self._spare is not None:
            self._spare.close()
        for signal, futures in self.futures.items():
            for future in futures:
                if not future.done():
                    future.set_exception(EngineError(f"the context ended before there was a {signal}"))
        for handle in self._patience.values():
            handle.cancel()
        for _, future in self._awaited:
            if not future.done():
                future.set_result(None)
        self.workers.close()
        await asyncio.sleep(0)  # the tasks end


def _is_async(function: Callable[..., Any]) -> bool:
    import inspect

    while isinstance(function, functools.partial):
        function = cast("functools.partial[Any]", function).func
    return inspect.iscoroutinefunction(function) or inspect.iscoroutinefunction(
        vars(type(function)).get("__call__")  # an object with an async call
    )
