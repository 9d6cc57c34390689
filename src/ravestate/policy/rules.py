"""The records of rules: each rule with an index, its slots, its signals and its clauses."""

from __future__ import annotations

import math
from typing import Any

from ravestate.declare.condition import Condition, Constraint
from ravestate.declare.core import activity, pressure
from ravestate.declare.rule import Rule
from ravestate.declare.settings import Number
from ravestate.errors import DeclarationError
from ravestate.policy.clauses import Conjunction, normal_form
from ravestate.policy.model import Clause, Need, RulePlan, SignalPlan
from ravestate.policy.names import Names
from ravestate.policy.numbers import Numbers

FLAGS = (f"{activity.name}:", f"{pressure.name}:")
"""The signals of the built-in flags, `core:activity` and `core:pressure`, have names that begin like this.

An activation whose clause names such a signal changes neither flag. Otherwise, an activation with a spike of
`activity.false` would make `activity` true, which withdraws that spike. Then `activity` would be false again, and so on
without end.
"""


class Rules:
    """The records of a policy's rules, in the order in which they were added. `faults` has the rules' faults."""

    def __init__(self, names: Names, numbers: Numbers, faults: list[str]) -> None:
        self.names = names
        self.numbers = numbers
        self.faults = faults
        self.plans: list[RulePlan] = []
        self._named: dict[str, Rule[Any, Any]] = {}
        self._count = 0  # the number of clauses so far

    def add(self, rule: Rule[Any, Any]) -> None:
        """Make the record of a rule, and add the rule's faults to `faults`."""
        other = self._named.setdefault(rule.name, rule)
        if other is not rule:
            self.names.twice("rule", rule.name, other.origin, rule.origin)
        plan = RulePlan(len(self.plans), rule)
        self.plans.append(plan)
        where = f"rule {rule.name} ({rule.origin})"
        plan.weight = self.numbers.number(rule, rule.weight, "weight", lambda n: n > 0, "above 0")
        plan.cooldown = self.numbers.number(rule, rule.cooldown, "cooldown", lambda n: n >= 0, "0 s or more")
        if rule.patience is not None:
            plan.patience = self.numbers.number(rule, rule.patience, "patience", lambda n: n >= 0, "0 s or more")
        if rule.timeout is not None:
            plan.timeout = self.numbers.number(rule, rule.timeout, "timeout", lambda n: n > 0, "more than 0 s")
        written = [self.names.slot(slot, f"{where}: writes") for slot in rule.writes]
        read = [self.names.slot(slot, f"{where}: reads") for slot in rule.reads]
        emitted = [self.names.signal(signal, f"{where}: emits") for signal in rule.emits]
        plan.slots = tuple(slot.index for slot in written if slot)
        plan.slotset = frozenset(plan.slots)
        plan.readable = frozenset((*plan.slots, *(slot.index for slot in read if slot)))
        views = {slot.index: slot for slot in (*written, *read) if slot}
        plan.views = tuple(views[slot] for slot in plan.readable)
        plan.emits = frozenset(signal.index for signal in emitted if signal)
        plan.raises = tuple(
            dict.fromkeys(
                (
                    *(signal.index for signal in emitted if signal),
                    *(signal.index for slot in written if slot for signal in slot.signals),
                )
            )
        )
        plan.clauses = self._clauses(plan, rule.when, where, "when")
        if rule.until is not None:
            plan.until = self._clauses(plan, rule.until, where, "until")

    def _clauses(self, plan: RulePlan, condition: Condition, where: str, what: str) -> tuple[Clause, ...]:
        try:
            conjunctions = normal_form(condition)
        except DeclarationError as fault:
            self.faults.append(f"{where}: {what}: {fault}")
            return ()
        return tuple(
            self._clause(plan, number, conjunction, f"{where}: {what}")
            for number, conjunction in enumerate(conjunctions)
        )

    def _clause(self, plan: RulePlan, number: int, conjunction: Conjunction, where: str) -> Clause:
        source = " & ".join(str(part) for part in (*conjunction.constraints, *conjunction.guards))
        clause = Clause(self._count, number, plan, source)
        self._count += 1
        needs: list[Need] = []
        for constraint in conjunction.constraints:
            signal = self.names.signal(constraint.signal, where)
            if signal is not None:
                needs.append(self._need(clause, len(needs), constraint, signal, plan.rule, where))
        if not conjunction.constraints:
            self.faults.append(
                f"{where}: {source!r} has no signal, and a predicate on a slot triggers no rule: write "
                f"{conjunction.guards[0].slot.name.split(':')[-1]}.changed & ..."
            )
        guards = [(self.names.slot(guard.slot, where), guard) for guard in conjunction.guards]
        clause.needs = tuple(needs)
        clause.guards = tuple((slot, guard) for slot, guard in guards if slot is not None)
        clause.signals = tuple(need.signal.signal for need in needs)
        clause.all_bits = (1 << len(needs)) - 1
        clause.firm_bits = sum(need.bit for need in needs if not need.detached)
        clause.reflexive = any(need.signal.name.startswith(FLAGS) for need in needs) or any(
            guard.slot in (activity, pressure) for guard in conjunction.guards
        )
        clause.simple = len(needs) == 1 and not clause.guards and not needs[0].min_age
        clause.asks_detached = 0 < clause.firm_bits < clause.all_bits
        return clause

    def _need(
        self, clause: Clause, index: int, constraint: Constraint, signal: SignalPlan, rule: Rule[Any, Any], where: str
    ) -> Need:
        def age(number: Number, what: str) -> float:
            return self.numbers.number(rule, number, f"{constraint.signal}.{what}", lambda n: n >= 0, "0 s or more")

        low = age(constraint.min_age_, "min_age")
        high = math.inf if constraint.max_age_ is None else age(constraint.max_age_, "max_age")
        if low > high:
            self.faults.append(
                f"{where}: {constraint.signal} can never be at least {low:g} s and at most {high:g} s old: write "
                f".min_age({low:g}).max_age(None)"
                + (" (max_age is 5 s by default)" if constraint.max_age_ == 5.0 else "")
            )
        return Need(clause, index, signal, low, high, constraint.is_detached, constraint.predicates)
