"""Simulated contexts: the real runtime in virtual time."""

from __future__ import annotations

import asyncio
from collections import deque
from collections.abc import Callable, Mapping
from math import isfinite
from pathlib import Path
from types import ModuleType
from typing import Any, TypeVar

from ravestate.declare.module import Module
from ravestate.declare.rule import Rule
from ravestate.declare.signal import Signal
from ravestate.declare.slot import Slot
from ravestate.engine.effects import Ended
from ravestate.engine.engine import DEFAULT_PATIENCE
from ravestate.engine.events import Event
from ravestate.engine.explain import Explanation
from ravestate.engine.trace import Record
from ravestate.errors import EngineError
from ravestate.loading.spec import AgentSpec
from ravestate.modules import BUILT_IN
from ravestate.policy.policy import Policy
from ravestate.runtime.context import Context
from ravestate.runtime.journal import Taken
from ravestate.runtime.listeners import Hooks
from ravestate.testing.virtual_loop import VirtualLoop

T = TypeVar("T")

OUTPUT = "rawio:output:changed"


class Simulation:
    """Run modules in virtual time: without waiting, and always with the same result. Use it as a context manager.

    Args:
        modules, settings, patience, journal: As for `Context`.
        seed: The seed of random choices. It is fixed by default, so that a test makes the same choices each time.
        trace: Whether to keep a record of every decision.

    Attributes:
        context: The simulated context, for everything that has no shortcut in this class.
        said: The values that were written to ``rawio.output``, in order.
        fired: The name of the rule of each run that fired, in the order in which the runs ended. A run has not fired if
            it resigned, or if it failed before its first write.
        failures: The name of each rule that failed, or whose predicate failed, with the exception.

    Example:
        >>> import ravestate as rs
        >>> from ravestate.testing import simulate
        >>> door = rs.Module("door")
        >>> bell, opened = door.signal("bell"), door.flag("opened")
        >>> @door.rule(when=bell, writes=opened)
        ... async def open_up(ctx):
        ...     await ctx.sleep(3.0)
        ...     ctx[opened] = True
        >>> with simulate(door) as sim:
        ...     sim.emit(bell)
        ...     sim.advance(3.0)
        ...     sim.read(opened), sim.fired, sim.now
        (True, ['door:open_up'], 3.0)
    """

    def __init__(
        self,
        *modules: Module | ModuleType | Policy,
        settings: Mapping[str, Any] | None = None,
        seed: int | None = 0,
        patience: float = DEFAULT_PATIENCE,
        trace: bool = True,
        journal: Callable[[Event | Taken, float], None] | None = None,
    ) -> None:
        self.context = Context(*modules, settings=settings, seed=seed, patience=patience, trace=trace, journal=journal)
        self.said: list[str] = []
        self.fired: list[str] = []
        self.failures: list[tuple[str, BaseException]] = []
        self._loop: VirtualLoop | None = None

    @classmethod
    def from_file(
        cls,
        path: str | Path,
        *,
        settings: Mapping[str, Mapping[str, Any]] | None = None,
        seed: int | None = None,
        patience: float | None = None,
        trace: bool = True,
    ) -> Simulation:
        """Return a simulation of the agent in an agent file, as ``ravestate run -f`` reads it.

        The simulation leaves out the built-in platforms (`conio`, `webio`, ...) and their settings. A test calls `say`
        instead.

        Args:
            path: The agent file. Relative paths in it are relative to its folder.
            settings: Name of a module → key → value. They override the environment and the file.
            seed: The seed of random choices; by default that of the file, or else 0.
            patience: As for `Context` (seconds); by default that of the file.
            trace: Whether to keep a record of every decision.

        Raises:
            UsageError: The file cannot be read or has mistakes. The message lists all mistakes.
            DeclarationErrors: The modules, or the values of the settings, have faults.
        """
        spec = AgentSpec.from_file(Path(path))
        platforms = {name for name, folder in BUILT_IN.items() if folder == "platform"}
        spec.settings = {name: values for name, values in spec.settings.items() if name not in platforms}
        for module, values in (settings or {}).items():
            spec.settings[module] = {**spec.settings.get(module, {}), **values}
        return cls(
            *(module for module in spec.modules if module.name not in platforms),
            settings=spec.settings,
            seed=next((s for s in (seed, spec.seed) if s is not None), 0),
            patience=spec.patience if patience is None else patience,
            trace=trace,
        )

    def __enter__(self) -> Simulation:
        try:
            asyncio.get_running_loop()
        except RuntimeError:
            pass
        else:
            raise EngineError("simulate runs a loop of its own: use it in a plain function, not in an async one")
        loop = self._loop = VirtualLoop()
        context = self.context
        hooks = Hooks(
            on_ended=self._ended,
            on_failed=self._failed,
            on_endless=loop.give_up,
            listeners={OUTPUT: self.said.append} if OUTPUT in context.policy.signals else {},
        )
        try:
            loop.run_until_complete(context.start(hooks))
            loop.busy = context.plain_functions
            self.settle()
        except BaseException:
            loop.close()
            raise
        return self

    def __exit__(self, *_: object) -> None:
        loop = self._running()
        try:
            loop.run_until_complete(self.context.stop())
            loop.run_until_complete(loop.shutdown_asyncgens())
        finally:
            loop.close()

    def say(self, text: str) -> None:
        """Say something as the user: write it to ``rawio.input``."""
        from ravestate.modules import rawio

        self.put(rawio.input, text)

    def put(self, slot: Slot[T], value: T) -> None:
        """Write a slot from outside the rules, and settle."""
        self.context.put(slot, value)
        self.settle()

    def emit(self, signal: Signal[T], payload: T | None = None) -> None:
        """Raise a signal from outside the rules, and settle."""
        self.context.emit(signal, payload)
        self.settle()

    def wipe(self, signal: Signal[Any]) -> None:
        """Withdraw the live spikes of a signal and all spikes that they have caused, and settle."""
        self.context.wipe(signal)
        self.settle()

    def add_rule(self, rule: Rule[Any, Any]) -> None:
        """Add a rule to the simulated context, and settle."""
        self.context.add_rule(rule)
        self.settle()

    def advance(self, seconds: float) -> None:
        """Let `seconds` of virtual time pass. Do everything that is due now, meanwhile, and at the end.

        Raises:
            ValueError: `seconds` is negative or not finite.
            EngineError: Rules trigger each other without end, so that no time passes.
            TimeoutError: A plain function takes too long in real time: 30 s, or 300 s if it computes.
        """
        if seconds < 0:
            raise ValueError(f"advance({seconds!r}): time does not run backwards")
        if not isfinite(seconds):
            raise ValueError(f"advance({seconds!r}): write a finite number of seconds")
        loop = self._running()
        self.settle()
        loop.run_to(loop.time() + seconds)

    def settle(self) -> None:
        """Do everything that is due now; no virtual time passes."""
        loop = self._running()
        loop.run_to(loop.time())

    @property
    def now(self) -> float:
        """The virtual seconds since the context began."""
        return self.context.now

    @property
    def trace(self) -> deque[Record]:
        """The latest records of the trace, at most 100,000; empty with ``trace=False``."""
        return self.context.trace

    def read(self, slot: Slot[T]) -> T:
        """Return the current value of a slot."""
        return self.context.read(slot)

    def explain(self, rule: str | Rule[Any, Any]) -> Explanation:
        """Return an explanation of why a rule runs, waits, or did not fire."""
        return self.context.explain(rule)

    def snapshot(self) -> dict[str, Any]:
        """Return all slots and live objects of the context, as plain data."""
        return self.context.snapshot()

    def _ended(self, ended: Ended) -> None:
        if ended.fired:
            self.fired.append(ended.rule)

    def _failed(self, rule: str, exception: BaseException) -> None:
        self.failures.append((rule, exception))

    def _running(self) -> VirtualLoop:
        if self._loop is None:
            raise EngineError("the simulation has not started: write `with simulate(...) as sim:`")
        if self._loop.is_closed():
            raise EngineError("the simulation has ended: act on it inside its `with` block")
        return self._loop


simulate = Simulation
"""Simulate modules: ``with simulate(module) as sim``. For the arguments, see `Simulation`."""
