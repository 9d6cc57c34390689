"""A small synchronous shell around a bare engine. It performs the engine's effects in virtual time.

It has no loop and no thread. It steps the coroutine of an ``async`` rule itself, and wakes a sleeping rule when
virtual time reaches the end of the sleep. It has the same methods as `ravestate.testing.Simulation`, so a test can use
either.
"""

from __future__ import annotations

import asyncio
from collections.abc import Coroutine, Generator
from heapq import heappop, heappush
from inspect import iscoroutine
from types import TracebackType
from typing import Any

import ravestate as rs
from ravestate.engine.effects import Cancel, Effect, Ended, Failed, Run, Spiked
from ravestate.engine.engine import Engine
from ravestate.engine.events import AddRule, Emit, Event, Finish, Start, Stop, Wipe, Write
from ravestate.engine.explain import Explanation, explain
from ravestate.engine.snapshot import snapshot
from ravestate.engine.trace import Record
from ravestate.modules import rawio

OUTPUT = rawio.output.changed.name


class Driver:
    """A bare engine, the running rule functions, and virtual time.

    Attributes:
        engine: The bare engine.
        now: Virtual time (seconds).
        log: All calls of the engine, in order: the name of the method, the event or None, and the time (seconds).
        effects: All effects of the engine.
        trace: All records of the trace.
        fired: The rules that ran and did not resign, in the order in which they finished.
        failures: The failures of rules, each as the name of the rule and the exception.
        said: The values written to ``rawio.output``, in order.
    """

    def __init__(self, *modules: rs.Module | rs.Policy, patience: float = 1.0, trace: bool = True) -> None:
        policy = modules[0] if isinstance(modules[0], rs.Policy) else rs.compile(*modules)
        self.engine = Engine(policy, patience=patience, report_ends=True)
        self.trace: list[Record] = []
        if trace:
            self.engine.tracer = self.trace.append
        self.now = 0.0
        self.log: list[tuple[str, Event | None, float]] = []
        self.effects: list[Effect] = []
        self.fired: list[str] = []
        self.failures: list[tuple[str, BaseException]] = []
        self.said: list[str] = []
        self.engine.watched[OUTPUT] = 1
        self._sleepers: list[tuple[float, int, int]] = []
        self._runs: dict[int, Coroutine[float, None, Any]] = {}
        self._naps = 0

    def __enter__(self) -> Driver:
        self.tell(Start())
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, traceback: TracebackType | None
    ) -> None:
        if error is None:
            self.tell(Stop())
        for coroutine in self._runs.values():
            coroutine.close()

    def say(self, text: str) -> None:
        """Write ``rawio.input`` as a platform would."""
        self.put(rawio.input, text)

    def put(self, slot: rs.Slot[Any], value: Any) -> None:
        self.tell(Write(slot.name, value))

    def emit(self, signal: rs.Signal[Any], payload: Any = None) -> None:
        self.tell(Emit(signal.name, payload))

    def wipe(self, signal: rs.Signal[Any]) -> None:
        self.tell(Wipe(signal.name))

    def add_rule(self, rule: rs.Rule[Any, Any]) -> None:
        self.tell(AddRule(self.engine.policy.with_rule(rule)))

    def tell(self, event: Event) -> None:
        """Give the engine an event, and settle."""
        self.receive(event)
        self.settle()

    def advance(self, seconds: float) -> None:
        """Let virtual time pass. Stop and settle at each time at which something is due."""
        goal = self.now + seconds
        self.settle()
        while (due := self._next()) <= goal:
            self.now = due
            self.settle()
        self.now = goal
        self._advance()

    def settle(self) -> None:
        """Do everything that is due now."""
        while effects := self._asked() or self._due():
            self.effects += effects
            for effect in effects:
                self._perform(effect)

    def read(self, slot: rs.Slot[Any]) -> Any:
        return self.engine.read(self.engine.policy.slot_of[slot.name].index)

    def explain(self, rule: str) -> Explanation:
        return explain(self.engine, self.engine.policy.rule_plan(rule), self.trace)

    def snapshot(self) -> dict[str, Any]:
        return snapshot(self.engine)

    def receive(self, event: Event) -> None:
        """Give the engine an event, but perform no effects yet."""
        self.log.append(("receive", event, self.now))
        self.engine.receive(event, self.now)

    def _due(self) -> list[Effect]:
        """Advance the engine if a deadline is due; otherwise wake the next sleeping rule. Repeat until there are effects."""
        effects: list[Effect] = []
        while not effects and self._next() <= self.now:
            deadline = self.engine.next_deadline()
            if deadline is not None and deadline <= self.now:
                self._advance()
            else:
                self._step(heappop(self._sleepers)[2])
            effects = self._asked()
        return effects

    def _asked(self) -> list[Effect]:
        self.log.append(("effects", None, self.now))
        return self.engine.effects()

    def _advance(self) -> None:
        self.log.append(("advance", None, self.now))
        self.engine.advance(self.now)

    def _next(self) -> float:
        times = [self._sleepers[0][0]] if self._sleepers else []
        deadline = self.engine.next_deadline()
        return min(times if deadline is None else [*times, deadline], default=float("inf"))

    def _perform(self, effect: Effect) -> None:
        if isinstance(effect, Run):
            self._begin(effect)
        elif isinstance(effect, Cancel):
            if effect.run not in self._runs:
                return  # the run has ended meanwhile
            self._sleepers = [nap for nap in self._sleepers if nap[2] != effect.run]
            self._step(effect.run, asyncio.CancelledError())
        elif isinstance(effect, Spiked):
            self.said.append(effect.payload)
        elif isinstance(effect, Failed):
            self.failures.append((effect.rule, effect.exception))
        elif isinstance(effect, Ended) and effect.fired:
            self.fired.append(effect.rule)

    def _begin(self, effect: Run) -> None:
        try:
            result = effect.rule.function(View(self, effect))
        except Exception as raised:  # a rule can raise any exception
            self._finish(effect.run, raised)
            return
        if iscoroutine(result):
            self._runs[effect.run] = result
            self._step(effect.run)
        else:
            self._finish(effect.run, result)

    def _step(self, run: int, throw: BaseException | None = None) -> None:
        coroutine = self._runs[run]
        try:
            seconds = coroutine.send(None) if throw is None else coroutine.throw(throw)
        except StopIteration as end:
            result = end.value
        except asyncio.CancelledError:
            result = None  # the engine has cancelled the run
        except Exception as raised:
            result = raised
        else:
            self._naps += 1
            heappush(self._sleepers, (self.now + seconds, self._naps, run))
            return
        del self._runs[run]
        self._finish(run, result)

    def _finish(self, run: int, result: object) -> None:
        if result is None:
            self.receive(Finish(run, "done"))
        elif isinstance(result, rs.Resign):
            self.receive(Finish(run, "resigned", result.reason))
        elif isinstance(result, rs.Retire):
            self.receive(Finish(run, "retired", result.reason))
        else:
            failure = result if isinstance(result, Exception) else rs.RuleError(f"returned {result!r}")
            self.receive(Finish(run, "failed", str(failure), failure))


class View:
    """The argument of a rule function. It has the methods of `rs.RuleContext` for which the engine is enough."""

    def __init__(self, driver: Driver, effect: Run) -> None:
        self._driver = driver
        self._run = effect.run
        self._rule = effect.rule.name
        self._payloads = effect.payloads
        self._values = dict(effect.values)

    @property
    def now(self) -> float:
        return self._driver.now

    def __getitem__(self, slot: rs.Slot[Any]) -> Any:
        return self._values[slot.name]

    def __setitem__(self, slot: rs.Slot[Any], value: Any) -> None:
        self._driver.receive(Write(slot.name, value, self._run))
        self._values[slot.name] = value

    def payload(self, signal: rs.Signal[Any]) -> Any:
        clauses = self._driver.engine.policy.rule_plan(self._rule).clauses
        if all(signal not in clause.signals for clause in clauses):
            raise rs.UndeclaredError(f"the condition of {self._rule} does not name {signal}")
        return self._payloads.get(signal.name)

    def emit(self, signal: rs.Signal[Any], payload: Any = None) -> None:
        self._driver.receive(Emit(signal.name, payload, self._run))

    def wipe(self, signal: rs.Signal[Any]) -> None:
        self._driver.receive(Wipe(signal.name, self._run))

    def sleep(self, seconds: float) -> Nap:
        return Nap(seconds)


class Nap:
    """The awaitable that `View.sleep` returns. Awaiting it passes the seconds to the driver."""

    def __init__(self, seconds: float) -> None:
        self.seconds = seconds

    def __await__(self) -> Generator[float, None, None]:
        yield self.seconds
