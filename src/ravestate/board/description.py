"""A policy as plain values, for the board and for recorded traces.

JSON can express all these values, so a trace file is readable without its agent.
"""

from __future__ import annotations

import inspect
import math
from dataclasses import dataclass
from typing import Any, get_origin

from ravestate.draw.build import build
from ravestate.draw.graph import Diagram
from ravestate.policy.completion import UNIT
from ravestate.policy.model import Clause, Need, RulePlan, SignalPlan, SlotPlan
from ravestate.policy.policy import Policy

_Users = dict[str, list[str]]  # name of a slot → the rules that read it, or the rules that write it


@dataclass(frozen=True, slots=True)
class ConstraintView:
    """A signal in a clause, with ages in seconds (``max_age=None`` sets no limit) and the names of its predicates."""

    signal: str
    min_age: float
    max_age: float | None
    detached: bool
    predicates: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class GateView:
    """A slot predicate of a clause: the slot, and the predicate as text."""

    slot: str
    text: str


@dataclass(frozen=True, slots=True)
class Term:
    """One addend of a utility, in nats: −ln(rules / |Λ|). See law L9 in docs/explanation/utility.md.

    `rules` is the number of rules that have the signal on a pathway, and |Λ| is the number of all rules.
    """

    signal: str
    rules: int
    nats: float


@dataclass(frozen=True, slots=True)
class ClauseView:
    """A clause, and the parts of its utility (nats).

    Attributes:
        condition: The clause as text.
        terms: The addends of the pathway with the least utility. This pathway decides the clause's utility.
        pathways: The number of the clause's pathways; at most 256, even if the clause has more.
        predicates: The number of the clause's predicates. Each predicate adds ln 2 to the utility.
        utility: The sum of all addends.
        base: The effective utility (utility × weight) when the cooldown of the rule is over.
    """

    condition: str
    constraints: tuple[ConstraintView, ...]
    gates: tuple[GateView, ...]
    terms: tuple[Term, ...]
    pathways: int
    predicates: int
    utility: float
    base: float


@dataclass(frozen=True, slots=True)
class RuleView:
    """A rule as declared. Its times are in seconds, and its `origin` is a file and a line.

    `raises` has all signals that the rule may raise, including those of the slots that it writes.
    """

    name: str
    module: str
    doc: str
    origin: str
    when: str
    until: str
    clauses: tuple[ClauseView, ...]
    reads: tuple[str, ...]
    writes: tuple[str, ...]
    emits: tuple[str, ...]
    raises: tuple[str, ...]
    weight: float
    cooldown: float
    patience: float | None
    timeout: float | None
    detached: bool
    background: bool


@dataclass(frozen=True, slots=True)
class SignalView:
    """A signal: its module, slot and payload, whether it is an input, and the rules that wait for it or raise it."""

    name: str
    module: str
    slot: str | None
    payload: str
    input: bool
    hearers: tuple[str, ...]
    raisers: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class SlotView:
    """A slot: its kind (``value``, ``flag`` or ``collection``), type and signals, and the rules that use it."""

    name: str
    module: str
    kind: str
    type: str
    signals: tuple[str, ...]
    readers: tuple[str, ...]
    writers: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class Description:
    """A policy as plain values."""

    modules: tuple[str, ...]
    rules: tuple[RuleView, ...]
    signals: tuple[SignalView, ...]
    slots: tuple[SlotView, ...]
    diagram: Diagram

    def rule(self, name: str) -> RuleView | None:
        """Return the rule with this name, or None."""
        return next((rule for rule in self.rules if rule.name == name), None)

    def signal(self, name: str) -> SignalView | None:
        """Return the signal with this name, or None."""
        return next((signal for signal in self.signals if signal.name == name), None)


def describe(policy: Policy) -> Description:
    """Return the description of a policy. This takes several milliseconds for a hundred rules, so keep the result."""
    readers: _Users = {}
    writers: _Users = {}
    for name, rule in policy.rules.items():
        for slots, users in ((rule.reads, readers), (rule.writes, writers)):
            for slot in slots:
                users.setdefault(slot.name, []).append(name)
    return Description(
        tuple(module.name for module in policy.modules),
        tuple(_rule(policy, plan) for plan in policy.rule_plans),
        tuple(_signal(policy, plan) for plan in policy.signal_plans),
        tuple(_slot(plan, readers, writers) for plan in policy.slot_plans),
        build(policy.rules.values()),
    )


def _rule(policy: Policy, plan: RulePlan) -> RuleView:
    rule = plan.rule
    return RuleView(
        plan.name,
        _module(plan.name),
        inspect.cleandoc(rule.__doc__ or "").partition("\n\n")[0],
        rule.origin,
        str(rule.when),
        "" if rule.until is None else str(rule.until),
        tuple(_clause(policy, clause) for clause in plan.clauses),
        tuple(slot.name for slot in rule.reads),
        tuple(slot.name for slot in rule.writes),
        tuple(signal.name for signal in rule.emits),
        tuple(policy.signal_plans[signal].name for signal in plan.raises),
        plan.weight,
        plan.cooldown,
        plan.patience,
        plan.timeout,
        plan.detached,
        plan.background,
    )


def _clause(policy: Policy, clause: Clause) -> ClauseView:
    pathways = policy.pathways.of_clause(clause)
    predicates = len(clause.guards) + sum(len(need.predicates) for need in clause.needs)
    least = sorted(signal.name for signal in pathways[0]) if pathways else []
    return ClauseView(
        clause.source,
        tuple(_constraint(need) for need in clause.needs),
        tuple(GateView(slot.name, str(guard)) for slot, guard in clause.guards),
        tuple(_term(policy, clause, name) for name in least),
        len(pathways),
        predicates,
        clause.utility,
        clause.base,
    )


def _constraint(need: Need) -> ConstraintView:
    return ConstraintView(
        need.signal.name,
        need.min_age,
        None if need.max_age == math.inf else need.max_age,
        need.detached,
        tuple(getattr(p, "__name__", type(p).__name__) for p in need.predicates),
    )


def _term(policy: Policy, clause: Clause, name: str) -> Term:
    completion = policy.pathways.completion
    nats = completion.information[completion.place[policy.signal_of[name].index]] / UNIT
    return Term(name, round(len(policy.rule_plans) * math.exp(-nats)), round(nats, 12))


def _signal(policy: Policy, plan: SignalPlan) -> SignalView:
    rules = policy.causes.all_causes[plan.index]
    slot = None if plan.slot is None else policy.slot_plans[plan.slot].name
    return SignalView(
        plan.name,
        _module(plan.name),
        slot,
        _type(plan.signal.payload),
        plan.input or not rules,
        tuple(dict.fromkeys(need.clause.rule.name for need in plan.listeners)),
        tuple(rule.name for rule in rules),
    )


def _slot(plan: SlotPlan, readers: _Users, writers: _Users) -> SlotView:
    return SlotView(
        plan.name,
        _module(plan.name),
        plan.slot.kind,
        _type(plan.slot.declared),
        tuple(signal.name for signal in plan.signals),
        tuple(readers.get(plan.name, ())),
        tuple(writers.get(plan.name, ())),
    )


def _module(name: str) -> str:
    return name.partition(":")[0]


def _type(kind: Any) -> str:
    if kind is None or kind is type(None):
        return ""
    return kind.__name__ if isinstance(kind, type) and get_origin(kind) is None else str(kind)
