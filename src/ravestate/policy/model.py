"""The records of a policy: the numbered form of what a designer declares.

The compiler gives each signal, slot, rule and clause an index, in declaration order, and fills in the records. After
that, nothing changes the records, so any number of engines share them. A signal's record lists its listeners: the needs
(constraints of clauses) that take its spikes. So the cost of a spike depends only on the listeners of its signal.

The *best* of several clauses has the greatest `Clause.base`. Among equals, the clause declared first is the best.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

from ravestate.declare.condition import Holds, Predicate
from ravestate.declare.rule import Rule
from ravestate.declare.signal import Signal
from ravestate.declare.slot import Slot


@dataclass(frozen=True, slots=True)
class ClauseView:
    """A clause as `Policy.clauses` shows it.

    Attributes:
        signals: The signals of the clause's constraints, as declared.
        pathways: The clause's completed pathways (law L8); those with the least information come first. At most 256 are
            listed, because there may be exponentially many.
        utility: The least self-information among the clause's pathways, plus ln 2 for each predicate, in nats (L9).
    """

    signals: tuple[Signal[Any], ...]
    pathways: tuple[frozenset[Signal[Any]], ...]
    utility: float


@dataclass(slots=True, eq=False, repr=False)
class SignalPlan:
    """A signal, with its listeners and its limits."""

    index: int
    signal: Signal[Any]
    slot: int | None
    """The index of the slot that owns the signal; None if no slot does."""
    input: bool
    """Whether the signal is an input (L8)."""
    name: str = field(init=False)
    keep_latest: bool = field(init=False)
    limit: int = field(init=False)
    listeners: tuple[Need, ...] = ()
    """The needs for this signal in conditions of rules, in declaration order."""
    others: tuple[Need, ...] = ()
    """The listeners that are in no conflict set and in no half."""
    conflict_sets: tuple[tuple[Clause, ...], ...] = ()
    """Sets of clauses that compete for each spike of the signal; the best clause of a set comes first."""
    halves: tuple[Half, ...] = ()
    """Sets of listeners whose clauses take two spikes. The engine keeps the first spike of the two without an
    activation (``engine/halves.py``)."""
    watchers: tuple[Need, ...] = ()
    """The needs for this signal in `until` conditions (L21)."""
    retain: float = -1.0
    """The age (seconds) up to which detached needs can see a spike that nothing holds. Only clauses that have
    non-detached needs as well count; the age is negative if there are none."""

    def __post_init__(self) -> None:
        self.name = self.signal.name
        self.keep_latest = self.signal.keep == "latest"
        self.limit = self.signal.limit

    def __repr__(self) -> str:
        return self.name


@dataclass(slots=True, eq=False, repr=False)
class SlotPlan:
    """A slot, its index and its signals."""

    index: int
    slot: Slot[Any]
    signals: tuple[SignalPlan, ...]
    """The slot's signals in the order of `Slot.signals`: `changed` first."""
    name: str = field(init=False)
    always: bool = field(init=False)
    is_flag: bool = field(init=False)
    is_collection: bool = field(init=False)
    keep_latest: bool = field(init=False)
    heard: bool = False
    """Whether a condition of any rule names one of the slot's signals."""
    guarded: bool = False
    """Whether any rule has a predicate on the slot."""

    def __post_init__(self) -> None:
        self.name = self.slot.name
        self.always = self.slot.always
        self.is_flag = self.slot.kind == "flag"
        self.is_collection = self.slot.kind == "collection"
        self.keep_latest = self.slot.changed.keep == "latest"

    def __repr__(self) -> str:
        return self.name


@dataclass(slots=True, eq=False, repr=False)
class Need:
    """A constraint of a clause: the clause needs a spike that meets it. Ages are in seconds."""

    clause: Clause
    index: int
    signal: SignalPlan
    min_age: float
    max_age: float
    detached: bool
    predicates: tuple[Predicate, ...]
    bit: int = field(init=False)
    kin: int = field(init=False)
    """The bits of this need and of its kin: the clause's needs whose spikes must be in the same causal group as this
    need's spike (L12)."""
    half: Half | None = field(init=False, default=None)
    """The need's `Half`, if the clause gets no activation until both of its needs are met; else None."""

    def __post_init__(self) -> None:
        self.bit = self.kin = 1 << self.index

    def __repr__(self) -> str:
        return f"{self.clause}:{self.signal}"


@dataclass(slots=True, eq=False, repr=False)
class Clause:
    """One conjunction of a rule's condition. If the conjunction is met, the rule may run."""

    index: int
    number: int
    """The clause's index within its rule."""
    rule: RulePlan
    source: str
    """The conjunction as text."""
    needs: tuple[Need, ...] = ()
    guards: tuple[tuple[SlotPlan, Holds], ...] = ()
    """The clause's predicates on slots, each with its slot."""
    signals: tuple[Signal[Any], ...] = ()
    """The signals of the clause's constraints, as declared."""
    least: int = 0
    """The pathway with the least information, as an integer with one bit for each signal (see `Completion`)."""
    utility: float = 0.0
    """The information of the pathway `least` and of the clause's predicates, in nats (L9)."""
    base: float = 0.0
    """The utility times the rule's weight; a utility of 0 counts as `NO_INFORMATION` (``plans.py``)."""
    all_bits: int = 0
    firm_bits: int = 0
    """The bits of the clause's non-detached needs."""
    asks_detached: bool = False
    """Whether some, but not all, of the clause's needs are detached."""
    simple: bool = False
    """Whether one spike is enough to make the clause ready: it has a single need, without `min_age`, and no guard."""
    apart: bool = False
    """Whether all non-detached needs of the clause are kin (L12). If so, the non-detached spikes of an activation are
    all in one causal group."""
    reflexive: bool = False
    """Whether the clause names a built-in flag (`core:activity` or `core:pressure`) in a need or in a predicate. If so,
    the clause's activations change no built-in flag (L22)."""
    unrivalled: bool = False
    """Whether the clause always goes before all other clauses that write one of its slots."""
    cyclic: bool = False
    """Whether a signal that the clause's rule raises leads to a non-detached need of the clause. False for a detached
    rule."""

    def __repr__(self) -> str:
        return self.rule.name if len(self.rule.clauses) <= 1 else f"{self.rule.name}[{self.number}]"


@dataclass(slots=True, eq=False, repr=False)
class RulePlan:
    """A rule with its index and arguments, and the indices of the slots and signals that it names. Times are in
    seconds."""

    index: int
    rule: Rule[Any, Any]
    name: str = field(init=False)
    detached: bool = field(init=False)
    background: bool = field(init=False)
    interruptible: bool = field(init=False)
    """Whether the engine can cancel a run: true for an `async def`; a plain function's thread cannot be stopped."""
    weight: float = 1.0
    cooldown: float = 0.0
    patience: float | None = None
    timeout: float | None = None
    slots: tuple[int, ...] = ()
    """The indices of the slots that the rule writes."""
    slotset: frozenset[int] = frozenset()
    readable: frozenset[int] = frozenset()
    """The indices of the slots that the rule reads or writes."""
    views: tuple[SlotPlan, ...] = ()
    """The records of the slots in `readable`."""
    emits: frozenset[int] = frozenset()
    """The indices of the signals that the rule declares in ``emits``."""
    raises: tuple[int, ...] = ()
    """The indices of the signals that the rule emits, and of the signals of the slots that it writes (L7)."""
    clauses: tuple[Clause, ...] = ()
    until: tuple[Clause, ...] = ()

    def __post_init__(self) -> None:
        self.name = self.rule.name
        self.detached = self.rule.detached
        self.background = self.rule.background
        self.interruptible = self.rule.is_async

    def __repr__(self) -> str:
        return self.name


@dataclass(slots=True, eq=False, repr=False)
class Half:
    """Needs for one signal, all of which the engine treats alike. Each need belongs to a clause with two needs.

    The half holds the first spike of such a clause without an activation (``engine/halves.py``).

    Attributes:
        needs: The needs, in declaration order.
        best: The same needs; the need of the best clause comes first.
        ranks: For the clause of each need in `best`: its negated base utility, and its index.
        rank: Index of a clause → the position of its need in `best`.
        patience: The patience of the rules in seconds; None if they have the context's patience (L16).
        kin: Whether both spikes of a clause must belong to one causal group (L12).
        max_age: The age (seconds) at which the needs give a spike up.
        slotset: The indices of the slots that the rules write; all of these rules write the same slots.
        busy: Whether a spike in the half makes ``core:activity`` true.
        places: Index of a rule → the position of its need in `needs`.
        sole: Whether first spikes wait in *benches*: of all complete pairs in a bench, only the oldest gets an
            activation (``engine/benches.py``). Such a half has a single need. The signals of the need's clause come
            only from outside or from detached rules. No better clause writes the slots of this clause for the same
            cause.
    """

    needs: tuple[Need, ...]
    best: tuple[Need, ...] = field(init=False)
    ranks: list[tuple[float, int]] = field(init=False)
    rank: dict[int, int] = field(init=False)
    patience: float | None = field(init=False)
    kin: bool = field(init=False)
    max_age: float = field(init=False)
    slotset: frozenset[int] = field(init=False)
    busy: bool = field(init=False)
    places: dict[int, int] = field(init=False)
    sole: bool = field(init=False, default=False)

    def __post_init__(self) -> None:
        first = self.needs[0]
        self.best = tuple(sorted(self.needs, key=lambda need: (-need.clause.base, need.clause.index)))
        self.ranks = [(-need.clause.base, need.clause.index) for need in self.best]
        self.rank = {need.clause.index: place for place, need in enumerate(self.best)}
        self.patience = first.clause.rule.patience
        self.kin = first.kin != first.bit
        self.max_age = first.max_age
        self.slotset = first.clause.rule.slotset
        self.busy = not first.clause.rule.background
        self.places = {need.clause.rule.index: place for place, need in enumerate(self.needs)}
        for need in self.needs:
            need.half = self

    def __repr__(self) -> str:
        return f"{self.needs[0].signal}/{len(self.needs)}"
