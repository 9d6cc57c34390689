"""The numbered form of a policy: what the engine works on.

Signals, slots, rules and clauses are numbered once per policy, in declaration order. A `Need` is one
constraint of one clause; the plan of a signal lists the needs that hear it, so that a spike costs by
what it concerns and never by how many rules there are.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from ravestate.declare.condition import Constraint, Holds, Predicate
from ravestate.declare.rule import Rule
from ravestate.declare.signal import Signal
from ravestate.declare.slot import Slot

if TYPE_CHECKING:
    from ravestate.policy.pathways import Pathways

__all__ = ["NO_INFORMATION", "Clause", "Need", "RulePlan", "SignalPlan", "SlotPlan"]

NO_INFORMATION = 1e-9
"""Nats at which a clause without information (U = 0) competes, so that its weight and cooldown still count."""


class SignalPlan:
    """A signal: who hears it, who causes it, how it is kept."""

    __slots__ = (
        "index",
        "input",
        "contests",
        "keep_latest",
        "limit",
        "listeners",
        "name",
        "retain",
        "signal",
        "slot",
        "uncontested",
        "watchers",
    )

    def __init__(self, index: int, signal: Signal[Any], slot: int | None, input: bool) -> None:
        self.index = index
        self.signal = signal
        self.name = signal.name
        self.slot = slot  # the slot whose signal it is, if any
        self.input = input  # L8
        self.keep_latest = signal.keep == "latest"
        self.limit = signal.limit
        self.listeners: tuple[Need, ...] = ()  # of rule conditions, in declaration order
        self.uncontested: tuple[Need, ...] = ()  # the listeners that are in none of the contests
        self.contests: tuple[
            tuple[Clause, ...], ...
        ] = ()  # clauses of which one can have a spike, best first
        self.watchers: tuple[Need, ...] = ()  # of `until` conditions (L21)
        self.retain = -1.0  # seconds for which a spike stays to be looked at by detached needs

    def __repr__(self) -> str:
        return self.name


class SlotPlan:
    """A slot, and its signals."""

    __slots__ = (
        "always",
        "heard",
        "index",
        "is_collection",
        "is_flag",
        "keep_latest",
        "name",
        "signals",
        "slot",
    )

    def __init__(self, index: int, slot: Slot[Any], signals: tuple[SignalPlan, ...]) -> None:
        self.index = index
        self.slot = slot
        self.name = slot.name
        self.signals = signals  # as in slot.signals: changed first
        self.always = slot.always
        self.is_flag = slot.kind == "flag"
        self.is_collection = slot.kind == "collection"
        self.keep_latest = slot.changed.keep == "latest"
        self.heard = False  # whether any rule hears one of its signals

    def __repr__(self) -> str:
        return self.name


class Need:
    """One constraint of a clause."""

    __slots__ = ("bit", "clause", "detached", "index", "kin", "max_age", "min_age", "predicates", "signal")

    def __init__(
        self,
        clause: Clause,
        index: int,
        constraint: Constraint,
        signal: SignalPlan,
        min_age: float,
        max_age: float,
    ) -> None:
        self.clause = clause
        self.index = index
        self.bit = 1 << index
        self.signal = signal
        self.min_age = min_age
        self.max_age = max_age
        self.detached = constraint.is_detached
        self.predicates: tuple[Predicate, ...] = constraint.predicates
        self.kin = self.bit  # bits of the needs that must hold spikes of the same causal group (L12)

    def __repr__(self) -> str:
        return f"{self.clause}:{self.signal}"


class Clause:
    """A conjunction by which a rule may fire.

    Attributes:
        signals: The signals of its constraints, as declared.
        pathways: The completed pathways (L8), the cheapest first. There may be exponentially many; at most
            `MAX_PATHWAYS` are told (``policy/pathways.py``), and the first is the least of all.
        utility: The least self-information among its pathways, in nats (L9).
    """

    __slots__ = (
        "_pathways",
        "all_bits",
        "asks_detached",
        "base",
        "completed",
        "cyclic",
        "firm_bits",
        "guards",
        "index",
        "least",
        "needs",
        "number",
        "reflexive",
        "rule",
        "signals",
        "simple",
        "source",
        "utility",
    )

    def __init__(self, index: int, number: int, rule: RulePlan, source: str) -> None:
        self.index = index
        self.number = number  # within its rule
        self.rule = rule
        self.source = source  # the conjunction as text
        self.needs: tuple[Need, ...] = ()
        self.guards: tuple[tuple[SlotPlan, Holds], ...] = ()
        self.signals: tuple[Signal[Any], ...] = ()
        self.completed: Pathways | None = None  # those of the policy
        self.least = 0  # the pathway whose utility it has, in the bits of `completed`
        self._pathways: tuple[frozenset[Signal[Any]], ...] | None = None
        self.utility = 0.0
        self.base = 0.0  # utility (or NO_INFORMATION) x weight
        self.all_bits = 0
        self.firm_bits = 0  # of the non-detached needs
        self.asks_detached = False  # some, but not all, of its needs are detached
        self.simple = False  # one need, of any age, and no gate: whoever takes a spike is ready
        self.reflexive = False  # it hears the built-in flags: what it does changes neither (L22)
        self.cyclic = False  # its rule may cause, without detachment, one of its own needs

    @property
    def pathways(self) -> tuple[frozenset[Signal[Any]], ...]:
        if self._pathways is None:
            self._pathways = () if self.completed is None else self.completed.of_clause(self)
        return self._pathways

    def __repr__(self) -> str:
        return self.rule.name if len(self.rule.clauses) <= 1 else f"{self.rule.name}[{self.number}]"


class RulePlan:
    """A rule, its numbers, and what they resolve to."""

    __slots__ = (
        "background",
        "clauses",
        "cooldown",
        "detached",
        "emits",
        "index",
        "interruptible",
        "name",
        "patience",
        "raises",
        "readable",
        "rule",
        "slots",
        "slotset",
        "timeout",
        "until",
        "weight",
    )

    def __init__(self, index: int, rule: Rule[Any, Any]) -> None:
        self.index = index
        self.rule = rule
        self.name = rule.name
        self.detached = rule.detached
        self.background = rule.background
        self.interruptible = rule.is_async  # a thread cannot be stopped
        self.weight = 1.0
        self.cooldown = 0.0
        self.patience: float | None = None
        self.timeout: float | None = None
        self.slots: tuple[int, ...] = ()  # written
        self.slotset: frozenset[int] = frozenset()
        self.readable: frozenset[int] = frozenset()  # read or written
        self.emits: frozenset[int] = frozenset()
        self.raises: tuple[int, ...] = ()  # signals it emits, and signals of the slots it writes (L7)
        self.clauses: tuple[Clause, ...] = ()
        self.until: tuple[Clause, ...] = ()

    def __repr__(self) -> str:
        return self.name
