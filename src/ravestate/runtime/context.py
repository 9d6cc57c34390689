"""A context: one running agent. Several contexts may share one policy."""

from __future__ import annotations

import asyncio
import contextlib
import math
from collections import deque
from collections.abc import Callable, Mapping
from types import ModuleType
from typing import Any, TypeVar

from ravestate.declare.module import Module
from ravestate.declare.rule import Rule
from ravestate.declare.signal import Signal
from ravestate.declare.slot import Slot
from ravestate.engine.engine import DEFAULT_PATIENCE, Engine
from ravestate.engine.events import Event, Start, Stop, Wipe
from ravestate.engine.explain import Explanation, explain
from ravestate.engine.snapshot import snapshot
from ravestate.engine.trace import Record
from ravestate.errors import DeclarationError, EngineError
from ravestate.policy.compile import compile_policy
from ravestate.policy.policy import Policy
from ravestate.runtime.journal import Taken
from ravestate.runtime.listeners import NO_HOOKS, Hooks
from ravestate.runtime.lookup import check_known
from ravestate.runtime.runner import Runner
from ravestate.settings import load_settings

T = TypeVar("T")

TRACE_LIMIT = 100_000  # the maximum number of records in a context's trace


class Context:
    """A running agent: ``async with rs.Context(module, ...) as context``.

    Before it has started, most methods raise an `EngineError`.

    Args:
        modules: Modules to compile, or one compiled `Policy` to share.
        settings: Name of a module → the module's settings. They override settings from the environment.
        seed: The seed of all random choices that rules make through ``ctx.random``; a new seed in each run by default.
        patience: The seconds for which other rules wait for a rule that lacks an input or a spike of another causal
            group. Then that rule gives up its spikes (law L16). A rule may set its own patience.
        trace: True to keep the latest 100,000 records of events, for ``trace`` and ``explain``; or a function to call
            with each record.
        journal: A function, e.g. a `Journal`, to call with each event and its time (seconds). Each time the context
            takes the engine's effects, it calls the function with a `Taken` instead of an event.

    Raises:
        DeclarationErrors: The modules or the settings have faults.
        DeclarationError: The patience is not a number of seconds.

    Example:
        >>> import asyncio, ravestate as rs
        >>> echo = rs.Module("echo")
        >>> heard, said = echo.slot("heard", ""), echo.slot("said", "")
        >>> @echo.rule(when=heard.changed, writes=said)
        ... async def answer(ctx):
        ...     ctx[said] = ctx.payload(heard.changed).upper()
        >>> async def main():
        ...     async with rs.Context(echo) as context:
        ...         context.put(heard, "hello")
        ...         return await context.next(said.changed, timeout=5)
        >>> asyncio.run(main())
        'HELLO'
    """

    __slots__ = (
        "__dict__", "__weakref__", "_is_to_stop", "_journal", "_observers", "_patience", "_policy", "_runner", "_seed",
        "_stopping", "_trace", "settings",
    )  # fmt: skip

    def __init__(
        self,
        *modules: Module | ModuleType | Policy,
        settings: Mapping[str, Any] | None = None,
        seed: int | None = None,
        patience: float = DEFAULT_PATIENCE,
        trace: bool | Callable[[Record], None] = False,
        journal: Callable[[Event | Taken, float], None] | None = None,
    ) -> None:
        policy = (
            modules[0] if len(modules) == 1 and isinstance(modules[0], Policy) else compile_policy(*modules)  # type: ignore[arg-type]  # compile_policy refuses a policy among modules
        )
        _check_seconds(patience)
        self.settings = load_settings(policy.modules, settings)
        self._policy = policy.with_settings(self.settings)
        self._seed = seed
        self._patience = patience
        self._trace: deque[Record] | None = None
        self._observers: tuple[Callable[[Record], None], ...] = ()
        if trace:
            self._observers = (self.trace.append if trace is True else trace,)
        self._journal = journal
        self._runner: Runner | None = None
        self._is_to_stop = False
        self._stopping: asyncio.Event | None = None  # made when the first task waits for the end

    # ------------------------------------------------------------------------------------ life

    async def __aenter__(self) -> Context:
        await self.start()
        return self

    async def start(self, hooks: Hooks | None = None) -> None:
        """Start the context, as ``async with`` does; `stop` ends it.

        Args:
            hooks: Functions that observe the context, e.g. for a simulation.

        Raises:
            EngineError: The context has been started before.
        """
        if self._runner is not None:
            raise EngineError("a context runs once: make another one of the same policy")
        hooks = hooks or NO_HOOKS
        engine = Engine(self._policy, patience=self._patience, report_ends=hooks.on_ended is not None)
        loop = asyncio.get_running_loop()
        self._runner = Runner(engine, loop, self.settings, self._seed, self, hooks, self._journal)
        if self._observers:
            self._attach()
        self._runner.receive(Start())

    async def __aexit__(self, *_: object) -> None:
        await self.stop()

    async def stop(self, grace: float = 5.0) -> None:
        """End the context in order.

        The context raises ``rs.shutdown``. Rules that start from then on have `grace` seconds to finish; the context
        does not wait for rules that run already. Then all async rules are cancelled, and have 5 seconds to clean up.
        Plain functions cannot be cancelled: they run on, but can no longer act. If `stop` itself is cancelled, it stops
        waiting.

        An endless rule with ``background=True`` does not delay the end. This also holds if the rule reacts only to
        ``rs.activity`` or ``rs.pressure``, and starts during the shutdown.
        """
        runner = self._running()
        self.ask_to_stop()
        runner.resume()
        known = runner.waits.alive()
        runner.receive(Stop())
        try:
            await runner.waits.until_others_end(known, grace)
            await runner.close()
        except asyncio.CancelledError:
            await runner.close(at_once=True)
            raise

    def ask_to_stop(self) -> None:
        """Make `until_stopped` return. Any thread may call this.

        The context keeps running until its ``async with`` ends.
        """
        if self._runner is not None:
            with contextlib.suppress(RuntimeError):  # the context has ended, and its loop is closed
                self._runner.loop.call_soon_threadsafe(self._note_stop)

    def _note_stop(self) -> None:
        self._is_to_stop = True
        if self._stopping is not None:
            self._stopping.set()

    async def until_stopped(self) -> None:
        """Wait until a rule (``ctx.stop()``) or other code (`ask_to_stop`) has asked the context to end.

        Raises:
            RavestateError: A rule has asked the context to end because of this error (``ctx.stop(failure)``).
            EngineError: The engine has failed, which is a bug in this library.
        """
        runner = self._running()
        if not self._is_to_stop:
            if self._stopping is None:
                self._stopping = asyncio.Event()
            await self._stopping.wait()
        if runner.fault is not None:
            raise runner.fault

    async def quiet(self, slot: Slot[Any] | None = None) -> None:
        """Wait until no foreground rule (without ``background=True``) runs, or is ready and waits to run.

        Args:
            slot: Wait only for rules that may write this slot, or may cause another rule to write it. None: wait for
                all rules.
        """
        await self._running().quiet(None if slot is None else slot.name)

    # ------------------------------------------------------------------------------------ its clock

    def pause(self) -> None:
        """Halt the context's clock. Call `pause`, `step` and `resume` only on the thread of the context's loop.

        The context still accepts events from outside. But no rule starts, no deadline passes, and ``ctx.sleep`` does
        not end. A rule that computes, or waits for something other than the clock, continues.
        """
        self._running().pause()

    def step(self) -> bool:
        """Perform the next step of a paused context.

        One step does what the engine has decided by now, for instance to start several rules. If nothing is due now,
        set the clock forward to the next time at which something is due.

        Returns:
            False if the context is not paused, or if nothing is due, not even at a later time; else True.
        """
        return self._running().step()

    def resume(self) -> None:
        """Start the clock of a paused context again from its present time."""
        self._running().resume()

    @property
    def paused(self) -> bool:
        """Whether the context's clock is halted."""
        return self._running().clock.halted

    # ------------------------------------------------------------------------------------ acting from outside

    def put(self, slot: Slot[T], value: T, *, origin: object = None) -> None:
        """Write a slot from outside. Any thread may call this. After the end of the context, the call does nothing.

        Args:
            slot: The slot.
            value: The new value.
            origin: Any object, for example the message that brought the value. Every rule that the write leads to gets
                this object as ``ctx.origin``. So a platform knows which message an output answers.

        Raises:
            UndeclaredError: The policy does not have the slot.
            RuleError: The value is not of the slot's type.
        """
        check_known(slot, self.policy.slots, Slot)
        slot.check(value, "context.put")
        self._running().write(slot.name, value, None, origin)

    def emit(self, signal: Signal[T], payload: T | None = None, *, origin: object = None) -> None:
        """Raise a signal from outside. Any thread may call this. After the end of the context, the call does nothing.

        Args:
            signal: The signal.
            payload: Its payload.
            origin: Any object; see `put`.

        Raises:
            UndeclaredError: The policy does not have the signal.
        """
        check_known(signal, self.policy.signals, Signal)
        self._running().emit(signal.name, payload, None, origin)

    def wipe(self, signal: Signal[Any]) -> None:
        """Withdraw the live spikes of a signal, and all spikes that they caused (L20). Any thread may call this.

        Async runs that began with such a spike are cancelled.

        Raises:
            UndeclaredError: The policy does not have the signal.
        """
        check_known(signal, self.policy.signals, Signal)
        self._running().receive(Wipe(signal.name))

    def add_rule(self, rule: Rule[Any, Any]) -> None:
        """Add a rule to this context alone. Any thread may call this.

        The rule must use signals and slots of this context's policy.

        Raises:
            DeclarationErrors: The rule does not fit the policy.
        """
        self._running().add_rule(rule)

    async def next(self, signal: Signal[T], timeout: float | None = None) -> T:  # noqa: ASYNC109  # the public name
        """Wait for the next spike of a signal, and return its payload.

        The call first starts the rules that are due. If one of them raises the signal, the call returns immediately,
        and other tasks get no turn. After 64 such calls in a row, the event loop gets a turn.

        Args:
            signal: The signal, e.g. ``rawio.output.changed``.
            timeout: The maximum time to wait, in seconds. By default, there is no limit.

        Raises:
            TimeoutError: No spike came in time.
            EngineError: The context ended before a spike came.
            UndeclaredError: The policy does not have the signal.
            ValueError: `timeout` is NaN.
        """
        if timeout is not None and math.isnan(timeout):
            raise ValueError(f"next(timeout={timeout!r}): write a number of seconds, or None to wait without a limit")
        check_known(signal, self.policy.signals, Signal)
        runner = self._running()
        if runner.closed:
            raise runner.fault or EngineError(f"the context has ended: there will be no {signal.name}")
        if timeout is None:  # an asyncio.timeout would cost as much as a short rule
            return await runner.listeners.next(signal.name, runner.settle)
        try:
            async with asyncio.timeout(timeout):
                return await runner.listeners.next(signal.name, runner.settle)
        except TimeoutError:
            raise TimeoutError(f"no {signal.name} within {timeout:g} s") from None

    # ------------------------------------------------------------------------------------ inspection

    def observe(self, observer: Callable[[Record], None]) -> Callable[[], None]:
        """Call `observer` with each new record of the trace. Return a function that stops these calls.

        The observer runs on the context's loop, in the middle of an event. It must be quick, must not raise, and must not
        act on the context. Without observers, the engine makes no records.
        """
        self._observers = (*self._observers, observer)
        self._attach()

        def leave() -> None:
            if observer in self._observers:
                place = self._observers.index(observer)
                self._observers = (*self._observers[:place], *self._observers[place + 1 :])
                self._attach()

        return leave

    @property
    def trace(self) -> deque[Record]:
        """The latest records of the trace; empty unless the argument `trace` is True."""
        if self._trace is None:
            self._trace = deque(maxlen=TRACE_LIMIT)
        return self._trace

    def _attach(self) -> None:
        observers = self._observers

        def tell_all(record: Record) -> None:
            for observer in observers:
                observer(record)

        if self._runner is not None:
            self._runner.trace(tell_all if len(observers) > 1 else observers[0] if observers else None)

    @property
    def policy(self) -> Policy:
        """The context's policy, with the rules that were added to this context."""
        return self._policy if self._runner is None else self._runner.policy

    @property
    def now(self) -> float:
        """The time on the context's clock: the seconds since the start, without pauses."""
        return self._running().now

    def read(self, slot: Slot[T]) -> T:
        """Return the current value of a slot.

        Raises:
            UndeclaredError: The policy does not have the slot.
        """
        check_known(slot, self.policy.slots, Slot)
        return self._running().read(slot.name)

    def explain(self, rule: str | Rule[Any, Any]) -> Explanation:
        """Explain why a rule runs, waits, or did not fire (L25). If the context keeps a trace, add the rule's history.

        Raises:
            DeclarationError: The policy has no such rule.
        """
        return explain(self._running().engine_now(), self.policy.rule_plan(rule), self.trace)

    def snapshot(self) -> dict[str, Any]:
        """Return all slots and live objects of the context, as plain data for JSON."""
        return snapshot(self._running().engine_now())

    def plain_functions(self) -> list[str]:
        """Return the names of the rules whose plain functions (not ``async``) are running: one name for each run."""
        return self._running().functions.plain_names()

    def _running(self) -> Runner:
        if self._runner is None:
            raise EngineError("the context has not started: write `async with rs.Context(...) as context:`")
        return self._runner


def _check_seconds(patience: object) -> None:
    if isinstance(patience, bool) or not isinstance(patience, (int, float)) or not 0 <= patience < math.inf:
        raise DeclarationError(
            f"patience={patience!r} must be a finite number of seconds, 0 or more, e.g. patience=1.0"
        )
