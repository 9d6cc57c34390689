"""Worlds: a policy, the work of its rules, and its inputs. The repr of a world is the code that makes it.

`compiled` makes the policy. `Play` plays the world on a bare engine in virtual time. Like the runtime, it performs the
first steps of a rule function immediately, and later steps at their time. A subprocess imports this file, so the file
does not import Hypothesis.
"""

from __future__ import annotations

import heapq
from collections.abc import Callable, Iterator
from dataclasses import MISSING, dataclass, field, fields, replace
from typing import Any

import ravestate as rs
from properties.counted import Counted, Endless
from ravestate.engine import events
from ravestate.engine.effects import Cancel, Effect, Ended, Run
from ravestate.engine.events import Event
from ravestate.policy.policy import Policy
from ravestate.runtime.journal import Taken

__all__ = [
    "PREDICATES",
    "Act",
    "Clause",
    "Gate",
    "Op",
    "Play",
    "RuleOf",
    "SignalOf",
    "SlotOf",
    "Want",
    "World",
    "compiled",
    "rule_of",
]

MODULES = ("m", "m1", "m2")
"""The names of the modules of a world."""

BUDGET = 8
"""The number of runs after which a rule retires, so that every loop ends."""

STEPS = 5_000
"""The number of moments after which a play counts as endless."""


def odd(value: Any) -> bool:
    """Return whether a number or an item is odd."""
    return bool(getattr(value, "item", value) in (1, 3, True))


def never(_: Any) -> bool:
    """Return false."""
    return False


def fussy(value: Any) -> bool:
    """Return true, but raise an error on 2."""
    if value == 2:
        raise ValueError("two")
    return True


def choosy(value: Any) -> bool:
    """Return whether a value is truthy, but raise an error on 1."""
    if value == 1:
        raise KeyError("one")
    return bool(value)


PREDICATES: dict[str, Callable[[Any], bool]] = {"odd": odd, "never": never, "fussy": fussy, "choosy": choosy}

Op = tuple[Any, ...]
"""One of (``emit``, signal, payload), (``write``, slot, value), (``store``, slot, key, item), (``discard``, slot, key),
(``wipe``, signal), (``start``,), (``stop``,) or (``add``, rule)."""


class Brief:
    """A record. Its repr is the call that makes it, without default values."""

    def __repr__(self) -> str:
        told: list[str] = []
        for one in fields(self):  # type: ignore[arg-type]  # every subclass is a dataclass
            value = getattr(self, one.name)
            if one.default is MISSING or value != one.default:
                told.append(f"{one.name}={value!r}")
        return f"{type(self).__name__}({', '.join(told)})"


@dataclass(frozen=True, repr=False)
class Want(Brief):
    """A constraint on a signal."""

    signal: str
    min_age: float = 0.0
    max_age: float | None = 5.0
    detached: bool = False
    where: str = ""
    """The names of predicates, with blanks between them."""


@dataclass(frozen=True, repr=False)
class Gate(Brief):
    """A predicate on a slot."""

    slot: str
    predicate: str = "odd"


Clause = tuple[Want | Gate, ...]


@dataclass(frozen=True, repr=False)
class Act(Brief):
    """The work of a rule's function: steps, each with a delay (seconds), and then an end."""

    steps: tuple[tuple[float, Op], ...] = ()
    seconds: float = 0.0
    end: str = "done"
    cleanup: float = 0.0
    last: tuple[Op, ...] = ()
    """The steps of the clean-up after a cancellation."""
    cancelled: str = "done"
    """The outcome after a cancellation."""


@dataclass(frozen=True, repr=False)
class RuleOf(Brief):
    """A rule, and the work of its function: each call does the next of `acts`, and starts again after the last one."""

    when: tuple[Clause, ...]
    writes: tuple[str, ...] = ()
    emits: tuple[str, ...] = ()
    acts: tuple[Act, ...] = (Act(),)
    detached: bool = False
    background: bool = False
    thread: bool = False
    weight: float = 1.0
    cooldown: float = 0.0
    patience: float | None = None
    until: tuple[Clause, ...] = ()
    timeout: float | None = None
    reads: tuple[str, ...] = ()


@dataclass(frozen=True, repr=False)
class SignalOf(Brief):
    """A signal."""

    keep: str = "all"
    limit: int = 100
    input: bool = False


@dataclass(frozen=True, repr=False)
class SlotOf(Brief):
    """A slot: a ``value``, a ``flag`` or a ``collection``."""

    kind: str = "value"
    always: bool = False
    keep: str = "all"
    limit: int = 100
    input: bool = False


@dataclass(frozen=True, repr=False)
class World(Brief):
    """Signals ``s0, s1, ...``, slots ``v0, v1, ...``, rules ``r0, r1, ...``, and inputs, each with a delay (seconds).

    The modules ``m, m1, m2, ...`` declare these signals, slots and rules in turn.
    """

    signals: tuple[SignalOf, ...] = ()
    slots: tuple[SlotOf, ...] = ()
    rules: tuple[RuleOf, ...] = ()
    inputs: tuple[tuple[float, Op], ...] = ()
    patience: float = 1.0
    together: bool = False
    """Whether the engine receives all events of one moment before its effects are taken."""
    modules: int = 1

    def home(self, name: str) -> int:
        """Return the number of the module that declares a signal, a slot or a rule."""
        number = name[1:].partition(":")[0]
        return int(number) % self.modules if number.isdecimal() else 0

    def full(self, name: str) -> str:
        """Return the qualified name of a signal, a slot or a rule."""
        return name if name.startswith("core:") else f"{MODULES[self.home(name)]}:{name}"


class Names:
    """The signals and slots of a world's modules by name."""

    def __init__(self, world: World) -> None:
        self.world = world
        self.added: dict[tuple[Policy, RuleOf], Policy | None] = {}
        self.modules = [rs.Module(name) for name in MODULES[: world.modules]]
        self.signals: dict[str, Any] = {}
        self.slots: dict[str, Any] = {}
        for number, signal in enumerate(world.signals):
            name = f"s{number}"
            self.signals[name] = self.home(name).signal(name, keep=signal.keep, limit=signal.limit, input=signal.input)
        for number, slot in enumerate(world.slots):
            name = f"v{number}"
            module = self.home(name)
            options: dict[str, Any] = {"keep": slot.keep, "limit": slot.limit, "input": slot.input}
            if slot.kind == "value":
                made: Any = module.slot(name, 0, always=slot.always, **options)
            elif slot.kind == "flag":
                made = module.flag(name, always=slot.always, **options)
            else:
                made = module.collection(name, **options)
            self.slots[name] = made
            for own in made.signals:
                self.signals[own.name.removeprefix(f"{module.name}:")] = own
        self.signals["never"] = self.modules[0].signal("never", input=True)
        for own in (rs.startup, rs.shutdown, rs.error, *rs.activity.signals, *rs.pressure.signals):
            self.signals[own.name] = own

    def home(self, name: str) -> rs.Module:
        """Return the module that declares a signal, a slot or a rule."""
        return self.modules[self.world.home(name)]

    def extended(self, policy: Policy, spec: RuleOf, name: str) -> Policy | None:
        """Return a policy with one more rule, or None if the rule does not fit. Plays of the same world share it."""
        if (policy, spec) not in self.added:
            try:
                self.added[policy, spec] = policy.with_rule(rule_of(self, spec, name))
            except rs.DeclarationErrors:
                self.added[policy, spec] = None
        return self.added[policy, spec]

    def condition(self, clauses: tuple[Clause, ...]) -> Any:
        found: Any = None
        for clause in clauses:
            whole: Any = None
            for part in clause:
                if isinstance(part, Gate):
                    one: Any = self.slots[part.slot].holds(PREDICATES[part.predicate])
                else:
                    one = self.signals[part.signal].min_age(part.min_age).max_age(part.max_age)
                    one = one.detached() if part.detached else one
                    for predicate in part.where.split():
                        one = one.where(PREDICATES[predicate])
                whole = one if whole is None else whole & one
            found = whole if found is None else found | whole
        return found


def rule_of(names: Names, spec: RuleOf, name: str) -> rs.Rule[Any, Any]:
    """Declare a rule."""

    async def coroutine(ctx: Any) -> None:
        raise AssertionError("a bare engine does not call rule functions")

    def plain(ctx: Any) -> None:
        raise AssertionError("a bare engine does not call rule functions")

    declare = names.home(name).rule(
        when=names.condition(spec.when),
        reads=[names.slots[slot] for slot in spec.reads],
        writes=[names.slots[slot] for slot in spec.writes],
        emits=[names.signals[signal] for signal in spec.emits],
        weight=spec.weight,
        cooldown=spec.cooldown,
        patience=spec.patience,
        until=names.condition(spec.until) if spec.until else None,
        timeout=spec.timeout,
        detached=spec.detached,
        background=spec.background,
        name=name,
    )
    return declare(plain if spec.thread else coroutine)


def compiled(world: World) -> tuple[Names, Policy]:
    """Compile a world's modules. The returned `Names` can later declare more rules."""
    names = Names(world)
    for number, rule in enumerate(world.rules):
        rule_of(names, rule, f"r{number}")
    return names, rs.compile(*names.modules)


@dataclass
class Play:
    """A play of a world.

    Attributes:
        heard: The events and the effects as text, each with its time (seconds).
        taken: The effects that each call of `take` got.
        journal: The events and the calls of `take`, each with its time (seconds).
    """

    world: World
    policy: Policy | None = None
    names: Names | None = None
    traced: bool = False
    before: Callable[[Play], None] | None = None
    """A callback before time passes. The engine has settled, and nothing happens until `self.next_time()`."""
    started: Callable[[Play, Effect], None] | None = None
    """A callback that gets each effect of a batch before any of them is performed."""
    budget: int = BUDGET
    """The number of calls after which a rule retires."""
    machine: Callable[..., Any] = Counted
    """The class of the engine, or of an interpreter in its place."""
    now: float = 0.0
    heard: list[str] = field(default_factory=list)
    taken: list[list[Effect]] = field(default_factory=list)
    journal: list[tuple[float, Event | Taken]] = field(default_factory=list)
    trace: list[str] = field(default_factory=list)

    def __post_init__(self) -> None:
        if self.policy is None:
            self.names, self.policy = compiled(self.world)
        self.engine: Any = self.machine(self.policy, patience=self.world.patience, report_ends=True)
        if self.traced:
            self.engine.tracer = lambda record: self.trace.append(repr(record))
        self.specs = {self.world.full(f"r{number}"): rule for number, rule in enumerate(self.world.rules)}
        self.calls: dict[str, int] = {}
        self.acts: dict[int, tuple[str, Act]] = {}  # for each run that has not ended: its rule and its work
        self.todo: list[tuple[float, int, int, Op]] = []  # time, number, run, operation
        self.count = 0
        time = 0.0
        for seconds, op in self.world.inputs:
            time += seconds
            self.plan(time, 0, op)

    # -------------------------------------------------------------------------------- time

    def play(self) -> Play:
        """Play from the first input until nothing is left to happen."""
        for _ in range(STEPS + len(self.todo)):
            if not self.step():
                return self
        raise Endless(f"the play does not end; it has come to {self.now} s")

    def next_time(self) -> float | None:
        """Return when something happens next (seconds)."""
        times = [self.todo[0][0]] if self.todo else []
        due = self.engine.next_deadline()
        if due is not None:
            times.append(due)
        return min(times, default=None)

    def step(self) -> bool:
        """Play the next moment; return False if there is none."""
        time = self.next_time()
        if time is None:
            return False
        if self.before is not None:
            self.before(self)
        self.now = max(self.now, time)
        self.engine.births = 0
        self.engine.advance(self.now)
        self.pump()
        while self.todo and self.todo[0][0] <= self.now:
            _, _, run, op = heapq.heappop(self.todo)
            self.do(run, op)
            if not self.world.together:
                self.pump()
        self.pump()
        return True

    def settle(self, seconds: float) -> None:
        """Let time pass without inputs."""
        end = self.now + seconds
        for _ in range(STEPS):
            time = self.next_time()
            if time is None or time > end:
                break
            self.step()
        else:
            raise Endless(f"the play does not end; it has come to {self.now} s")
        self.now = end
        self.engine.advance(end)
        self.pump()

    def tell(self, *ops: Op) -> None:
        """Perform operations from outside now."""
        for op in ops:
            self.do(0, op)
            self.pump()

    # -------------------------------------------------------------------------------- events in

    def plan(self, time: float, run: int, op: Op) -> None:
        self.count += 1
        heapq.heappush(self.todo, (time, self.count, run, op))

    def receive(self, event: Event) -> None:
        self.journal.append((self.now, replace(event)))
        self.heard.append(f"{self.now:g} s > {event!r}")
        self.engine.receive(event, self.now)

    def do(self, run: int, op: Op) -> None:
        """Do one step of the run with this number, or of code outside (0)."""
        if run and run not in self.acts:
            return  # the run has ended, or was cancelled
        by = run or None
        match op:
            case ("emit", name, payload):
                self.receive(events.Emit(self.world.full(name), payload, by))
            case ("write", name, value):
                self.receive(
                    events.Write(self.world.full(name), dict(value) if isinstance(value, tuple) else value, by)
                )
            case ("store", name, key, item):
                self.receive(events.Store(self.world.full(name), key, item, by))
            case ("discard", name, key):
                self.receive(events.Discard(self.world.full(name), key, by))
            case ("wipe", name):
                self.receive(events.Wipe(self.world.full(name), by))
            case ("start",):
                self.receive(events.Start())
            case ("stop",):
                self.receive(events.Stop())
            case ("add", spec):
                assert self.names is not None
                name = f"r{len(self.engine.policy.declared)}"
                more = self.names.extended(self.engine.policy, spec, name)
                if more is None:
                    return  # the rule does not fit the policy
                self.specs[self.world.full(name)] = spec
                self.receive(events.AddRule(more))
            case ("finish", kind, reason):
                self.finish(run, kind, reason)
            case _:
                raise ValueError(op)

    def finish(self, run: int, kind: str, reason: str = "") -> None:
        del self.acts[run]
        exception = ValueError("failed on purpose") if kind == "failed" else None
        self.receive(events.Finish(run, kind, reason, exception))  # type: ignore[arg-type]

    # -------------------------------------------------------------------------------- effects out

    def pump(self) -> None:
        while effects := self.take():
            self.heard += [f"{self.now:g} s < {effect!r}" for effect in effects]
            if self.started is not None:
                for effect in effects:
                    self.started(self, effect)
            for effect in effects:
                if isinstance(effect, Run):
                    self.run(effect)
                elif isinstance(effect, Cancel):
                    self.cancel(effect)
                else:
                    assert not isinstance(effect, Ended) or effect.run not in self.acts

    def take(self) -> list[Effect]:
        """Take the effects, and record this in the journal."""
        self.journal.append((self.now, Taken()))
        effects = self.engine.effects()
        self.taken.append(effects)
        return effects

    def run(self, effect: Run) -> None:
        name = effect.rule.name
        spec = self.specs[name]
        calls = self.calls[name] = self.calls.get(name, 0) + 1
        act = spec.acts[(calls - 1) % len(spec.acts)] if calls <= self.budget else Act(end="retired")
        run = effect.run
        self.acts[run] = (name, act)
        time = self.now
        suspended = spec.thread  # a thread always reports later, even without a delay
        for seconds, op in act.steps:
            suspended = suspended or seconds > 0
            time += seconds
            if suspended:
                self.plan(time, run, op)
            else:
                self.do(run, op)
        end: Op = ("finish", act.end, "")
        if suspended or act.seconds:
            self.plan(time + act.seconds, run, end)
        else:
            self.do(run, end)

    def cancel(self, effect: Cancel) -> None:
        held = self.acts.get(effect.run)
        if held is None:
            return  # the run has ended in the meantime
        name, act = held
        if self.specs[name].thread:
            self.finish(effect.run, "done", effect.reason)
            return
        self.todo = [entry for entry in self.todo if entry[2] != effect.run]
        heapq.heapify(self.todo)
        for op in act.last:
            self.plan(self.now, effect.run, op)
        self.plan(self.now + act.cleanup, effect.run, ("finish", act.cancelled, effect.reason))

    def wipe_all(self) -> None:
        """Wipe every signal."""
        for signal in list(self.engine.policy.signals):
            self.engine.births = 0
            self.receive(events.Wipe(signal))
            self.pump()

    def active(self) -> Iterator[Any]:
        """Yield all activations."""
        for activations in self.engine.state.active.values():
            yield from activations
