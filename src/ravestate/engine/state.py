"""The state of an engine: its tables, and the questions that they answer. No decision is made here.

Each table is indexed by what an event concerns: live spikes by signal, activations by rule, and incomplete activations
by the need that they lack. So the cost of an event does not grow with the number of rules.
"""

from __future__ import annotations

import copy
from collections import OrderedDict
from types import MappingProxyType
from typing import Any

from ravestate.declare.condition import Holds
from ravestate.declare.core import RuleFailure
from ravestate.engine.activation import Activation
from ravestate.engine.deadlines import Deadlines
from ravestate.engine.effects import Effect, Failed
from ravestate.engine.free import Free
from ravestate.engine.group import Group
from ravestate.engine.horizon import OUTSIDE, RULE
from ravestate.engine.loops import Lineage, Loops
from ravestate.engine.spike import Spike
from ravestate.engine.trace import Tracer
from ravestate.engine.watch import Watch
from ravestate.policy.model import Clause, Half, Need, RulePlan, SlotPlan
from ravestate.policy.policy import Policy

PASSIVE = (int, float, str, bytes, bool, type(None), MappingProxyType)
"""Types whose values contexts may share. A slot's default of any other type is copied for each context."""


class State:
    """The slots, live spikes and activations of an engine, and the work that is still to be done."""

    __slots__ = (
        "_activations",
        "_acts",
        "_asking",
        "_blamed",
        "_busy",
        "_deadlines",
        "_dirty",
        "_errors",
        "_free",
        "_groups",
        "_hope_counts",
        "_loops",
        "_out",
        "_refused",
        "_spikes",
        "_stirred",
        "_stuck",
        "_unseen",
        "_watched_by",
        "_watches",
        "active",
        "alternatives",
        "dropped",
        "gated",
        "halves",
        "hoping",
        "lacking",
        "live",
        "now",
        "policy",
        "retired",
        "running",
        "tracer",
        "values",
        "waiting",
        "watched",
    )

    def __init__(self, policy: Policy) -> None:
        self.policy = policy
        self.now = 0.0
        self.tracer: Tracer | None = None
        self.values: dict[int, Any] = {}
        """Number of a slot that was written or read → its value."""
        self._unseen: dict[int, dict[str, Any]] = {}
        """Number of a collection that was not read since its last change → its items. Changing them needs no copy."""
        self.live: dict[int, dict[Spike, None]] = {}
        """Number of a signal → its live spikes, oldest first."""
        self.active: dict[int, dict[Activation, None]] = {}
        """Number of a rule → its activations that hold a spike or run."""
        self.lacking: dict[Need, dict[Activation, None]] = {}
        """Need → the activations that hold a spike, but none for this need."""
        self.halves: dict[Half, OrderedDict[Spike, int]] = {}
        """Half → the spikes that it holds without an activation, oldest first, each with the activation number just
        before theirs (``halves.py``)."""
        self.gated: dict[Activation, None] = {}
        """Activations that hold all their spikes while a predicate on a slot is false."""
        self.waiting: dict[Activation, None] = {}
        """Ready activations that were refused consent."""
        self.alternatives: dict[Activation, tuple[tuple[Clause, ...], int, int]] = {}
        """Activation with a queue of alternatives (``conflict_sets.py``) → the clauses of its conflict set; how many of
        them have had an activation; the activation number just before theirs."""
        self.hoping: dict[tuple[int, int], dict[Activation, None]] = {}
        """Thing outside their groups on which waiting activations depend (`Horizon.hopes`) → these activations."""
        self._hope_counts: dict[tuple[int, int], int] = {}  # the same keys → the greatest count in `Horizon.hopes`
        self.running: dict[int, Activation] = {}
        """Number of a run → the activation whose function runs."""
        self.retired: set[int] = set()
        """The numbers of the rules that have retired."""
        self.dropped: dict[str, int] = {}
        """Signal's name → how many of its spikes were dropped by its limit (L23)."""
        self.watched: dict[str, int] = {}
        """The names of the signals whose spikes are reported as effects, as the keys of a table."""
        self._out: list[Effect] = []
        self._acts = False  # whether one of these effects starts or cancels a run
        self._free = Free()
        self._asking: dict[Activation, None] = {}  # ready or waiting activations that are about to ask for consent
        self._refused: dict[Activation, None] = {}  # activations refused since the last search for a stalemate
        self._stuck: dict[Activation, None] = {}  # activations found in a stalemate since they were refused
        self._dirty: dict[Group, None] = {}  # groups in which something ended
        self._stirred: dict[tuple[int, int], None] = {}  # the keys of `hoping` that have changed
        self._watches: dict[Clause, dict[Activation, Watch]] = {}
        self._watched_by: dict[Spike, dict[Watch, None]] = {}  # spike → the watches that hold it
        # Failures that ``core:error`` has not reported yet, each with the rules that led to it.
        self._errors: list[tuple[RuleFailure, Lineage | None]] = []
        self._loops = Loops()
        self._blamed: set[int] = set()  # the ids of predicates whose failure was reported
        self._deadlines: Deadlines
        self._busy: int = 0  # how many activations count for `core:activity`
        self._activations: int = 0  # the number of the newest activation
        self._spikes = 0
        self._groups = 0

    def _new_activation(self, clause: Clause, number: int) -> Activation:
        """Create an activation of a clause; it is about to take its first spike."""
        activation = Activation(number, clause)
        rule = clause.rule
        active = self.active.get(rule.index)
        if active is None:
            active = self.active[rule.index] = {}
        active[activation] = None
        if not (rule.background or clause.reflexive):
            self._busy += 1
        if self.hoping:
            self.stir_rule(rule)
        return activation

    def stir_rule(self, rule: RulePlan) -> None:
        """Note that an activation of a rule has come, changed or gone: activations in other groups may depend on it."""
        others = len(self.active.get(rule.index, ())) - 1
        for kind, number in self.hoping:
            if (
                number == rule.index
                if kind == RULE
                else kind == OUTSIDE
                and others <= self._hope_counts[kind, number]
                and rule.index in self.policy.causes.wide_ancestors(number)
            ):
                self._stirred[kind, number] = None

    def is_live(self, spike: Spike) -> bool:
        """Return whether a spike is live: something holds it, or detached needs may look at it."""
        return spike in self.live.get(spike.signal.index, ())

    def read(self, slot: int) -> Any:
        """Return the value of the slot with this number."""
        if self._unseen:
            self._unseen.pop(slot, None)
        try:
            return self.values[slot]
        except KeyError:
            default: Any = self.policy.slot_plans[slot].slot.default
            if not isinstance(default, PASSIVE):
                default = copy.deepcopy(default)  # contexts share no state
            self.values[slot] = default
            return self.values[slot]

    def newest(self, need: Need) -> Spike | None:
        """Return the newest live spike that fits a need, or None."""
        return next(
            (spike for spike in reversed(self.live.get(need.signal.index, {})) if self._fits(need, spike)), None
        )

    def _fits(self, need: Need, spike: Spike) -> bool:
        """Return whether a live spike may meet a need: age and payload fit, and the rule has not lost it for good."""
        rule = need.clause.rule
        if spike.born + need.max_age <= self.now and (need.max_age or spike.born < self.now):
            return False
        if not need.detached:
            if spike.refused is not None and rule.index in spike.refused:
                return False
            if spike.group.root().finished(rule.slots):
                return False
            if need.clause.cyclic and spike.descends_from(rule.index):
                return False
        return all(self._test(predicate, spike.payload, rule) for predicate in need.predicates)

    def holds(self, slot: SlotPlan, guard: Holds, rule: RulePlan) -> bool:
        """Return whether a predicate on a slot's value is true. A predicate that raises is false, and is reported."""
        return self._test(guard.predicate, self.read(slot.index), rule)

    def opens(self, slot: SlotPlan, guard: Holds) -> bool:
        """Return the result of `holds` for a debugger: a predicate that raises counts as false, but is not reported."""
        try:
            return bool(guard.predicate(self.read(slot.index)))
        except Exception:  # the designer's predicate may raise anything
            return False

    def _test(self, predicate: Any, value: Any, rule: RulePlan) -> bool:
        try:
            return bool(predicate(value))
        except Exception as exception:  # a predicate is the designer's code: it may raise anything
            if id(predicate) not in self._blamed:
                self._blamed.add(id(predicate))
                self._fail(rule, exception, signal=True)
            return False

    def _fail(self, rule: RulePlan, exception: BaseException, *, signal: bool, lineage: Lineage | None = None) -> None:
        """Report a failure of a rule to the runtime; with `signal`, ``core:error`` occurs next."""
        self._out.append(Failed(rule.name, exception))
        if signal:
            self._errors.append((RuleFailure(rule.name, exception), lineage))
