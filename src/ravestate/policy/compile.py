"""Compiling: modules become one immutable `Policy`, or every fault is reported at once (L6)."""

from __future__ import annotations

import copy
import math
from collections.abc import Callable, Iterable, Mapping, Sequence
from types import ModuleType
from typing import Any

from ravestate.declare.condition import Condition, Constraint
from ravestate.declare.core import activity, core, pressure
from ravestate.declare.module import Module, as_module
from ravestate.declare.rule import Rule
from ravestate.declare.settings import Number, SettingRef
from ravestate.declare.signal import Signal
from ravestate.declare.slot import Slot
from ravestate.errors import DeclarationError, DeclarationErrors, nearest
from ravestate.policy.causes import Causes
from ravestate.policy.clauses import Conjunction, normal_form
from ravestate.policy.pathways import assign_utilities
from ravestate.policy.plan import Clause, Need, RulePlan, SignalPlan, SlotPlan
from ravestate.policy.policy import Policy

__all__ = ["compile_policy"]


def compile_policy(*modules: Module | ModuleType) -> Policy:
    """Compile modules, and whatever they require, into a policy.

    Args:
        modules: `Module` values, or Python modules that hold one.

    Returns:
        The policy; any number of contexts may share it.

    Raises:
        DeclarationErrors: All faults that were found.

    Example:
        >>> import ravestate as rs
        >>> hello = rs.Module("hello")
        >>> rs.compile(hello).rules
        mappingproxy({})
    """
    faults: list[DeclarationError] = []
    given: list[Module] = []
    for value in modules:
        try:
            given.append(as_module(value))
        except DeclarationError as fault:
            faults.append(fault)
    ordered = _in_order(given, faults)
    rules = [rule for module in ordered for rule in module.rules]
    policy = build(tuple(ordered), rules, {}, faults)
    if policy is None:
        raise DeclarationErrors(faults)
    return policy


def build(
    modules: Sequence[Module],
    rules: Sequence[Rule[Any, Any]],
    settings: Mapping[str, Any],
    faults: list[DeclarationError] | None = None,
) -> Policy | None:
    """Number everything; `settings` maps a module's name to the values that its `SettingRef`s resolve to."""
    work = _Compilation(modules, rules, settings, [] if faults is None else faults)
    policy = work.run()
    if faults is None and policy is None:
        raise DeclarationErrors(work.faults)
    return policy


def _in_order(given: Iterable[Module], faults: list[DeclarationError]) -> list[Module]:
    """Core first, then every module behind those that it requires; otherwise as given."""
    ordered: dict[int, Module] = {id(core): core}
    names: dict[str, Module] = {core.name: core}

    def visit(module: Module, path: tuple[Module, ...]) -> None:
        if module in path:
            cycle = " -> ".join(m.name for m in (*path[path.index(module) :], module))
            faults.append(
                DeclarationError(
                    f"modules require each other in a cycle: {cycle}; take one `requires` out, or put what both "
                    "need into a module of its own"
                )
            )
            return
        if id(module) in ordered:
            return
        for required in module.requires:
            visit(required, (*path, module))
        if id(module) in ordered:  # reached again on the way round a cycle
            return
        other = names.setdefault(module.name, module)
        if other is not module:
            faults.append(
                DeclarationError(
                    f"two modules are named {module.name!r}: {other.origin} and {module.origin}; rename one"
                )
            )
        ordered[id(module)] = module

    for module in given:
        visit(module, ())
    return list(ordered.values())


FLAGS = (f"{activity.name}:", f"{pressure.name}:")
"""How the signals of the built-in flags begin. An activation that stands on one of them is neither activity nor pressure:
else it would withdraw what it stands on, come back, and so on, all in one instant."""


class _Compilation:
    """One run of the compiler: what it has numbered so far, and the faults."""

    def __init__(
        self,
        modules: Sequence[Module],
        rules: Sequence[Rule[Any, Any]],
        settings: Mapping[str, Any],
        faults: list[DeclarationError],
    ) -> None:
        self.modules = modules
        self.declared = rules
        self.settings = settings
        self.faults = faults
        self.module_names = {module.name: module for module in modules}
        self.signals: list[SignalPlan] = []
        self.slots: list[SlotPlan] = []
        self.rules: list[RulePlan] = []
        self.signal_of: dict[str, SignalPlan] = {}
        self.slot_of: dict[str, SlotPlan] = {}
        self.rule_named: dict[str, Rule[Any, Any]] = {}
        self.clause_count = 0
        self.refers = False  # to a setting

    def run(self) -> Policy | None:
        self.number_names()
        for rule in self.declared:
            self.number_rule(rule)
        self.connect()
        causes = Causes(self.signals, self.rules)
        self.check_reachable(causes)
        if self.faults:
            return None
        assign_utilities(self.signals, self.rules, causes)
        self.find_contests()
        return Policy(
            modules=tuple(self.modules),
            declared=tuple(self.declared),
            signal_plans=tuple(self.signals),
            slot_plans=tuple(self.slots),
            rule_plans=tuple(self.rules),
            causes=causes,
            refers=self.refers,
            settings=self.settings,
        )

    # ---------------------------------------------------------------- names

    def number_names(self) -> None:
        for module in self.modules:
            for signal in module.signals:
                self.number_signal(signal, None)
            for slot in module.slots:
                other = self.slot_of.get(slot.name)
                if other is not None:
                    if other.slot is not slot:
                        self.twice("slot", slot.name, other.slot.origin, slot.origin)
                    continue
                index = len(self.slots)
                plan = SlotPlan(index, slot, tuple(self.number_signal(s, index) for s in slot.signals))
                self.slots.append(plan)
                try:
                    if slot.kind != "collection":
                        copy.deepcopy(slot.default)
                except Exception as error:  # whatever the value's own code raises
                    self.faults.append(
                        DeclarationError(
                            f"slot {slot.name} ({slot.origin}): its default cannot be copied for each context ({error}): "
                            "write default=None, and set it in a rule on rs.startup"
                        )
                    )
                self.slot_of[slot.name] = plan

    def number_signal(self, signal: Signal[Any], slot: int | None) -> SignalPlan:
        other = self.signal_of.get(signal.name)
        if other is not None:
            if other.signal is not signal:
                self.twice("signal", signal.name, other.signal.origin, signal.origin)
            return other
        plan = SignalPlan(len(self.signals), signal, slot, signal.input)
        self.signals.append(plan)
        self.signal_of[signal.name] = plan
        return plan

    def twice(self, what: str, name: str, first: str, second: str) -> None:
        if [m.name for m in self.modules].count(
            name.split(":")[0]
        ) < 2:  # else the modules' names are the fault
            self.faults.append(
                DeclarationError(f"two {what}s are named {name!r}: {first} and {second}; rename one")
            )

    # ---------------------------------------------------------------- rules

    def number_rule(self, rule: Rule[Any, Any]) -> None:
        other = self.rule_named.setdefault(rule.name, rule)
        if other is not rule:
            self.twice("rule", rule.name, other.origin, rule.origin)
        plan = RulePlan(len(self.rules), rule)
        self.rules.append(plan)
        where = f"rule {rule.name} ({rule.origin})"
        plan.weight = self.number(rule, rule.weight, "weight", lambda n: n > 0, "above 0")
        plan.cooldown = self.number(rule, rule.cooldown, "cooldown", lambda n: n >= 0, "0 s or more")
        if rule.patience is not None:
            plan.patience = self.number(rule, rule.patience, "patience", lambda n: n >= 0, "0 s or more")
        if rule.timeout is not None:
            plan.timeout = self.number(rule, rule.timeout, "timeout", lambda n: n > 0, "more than 0 s")
        written = [self.slot(slot, f"{where}: writes") for slot in rule.writes]
        read = [self.slot(slot, f"{where}: reads") for slot in rule.reads]
        emitted = [self.signal(signal, f"{where}: emits") for signal in rule.emits]
        plan.slots = tuple(slot.index for slot in written if slot)
        plan.slotset = frozenset(plan.slots)
        plan.readable = frozenset((*plan.slots, *(slot.index for slot in read if slot)))
        plan.emits = frozenset(signal.index for signal in emitted if signal)
        plan.raises = tuple(
            dict.fromkeys(
                (
                    *(signal.index for signal in emitted if signal),
                    *(signal.index for slot in written if slot for signal in slot.signals),
                )
            )
        )
        plan.clauses = self.clauses(plan, rule.when, where, "when")
        if rule.until is not None:
            plan.until = self.clauses(plan, rule.until, where, "until")

    def clauses(self, plan: RulePlan, condition: Condition, where: str, what: str) -> tuple[Clause, ...]:
        try:
            conjunctions = normal_form(condition)
        except DeclarationError as fault:
            self.faults.append(DeclarationError(f"{where}: {what}: {fault}"))
            return ()
        return tuple(
            self.clause(plan, number, conjunction, f"{where}: {what}")
            for number, conjunction in enumerate(conjunctions)
        )

    def clause(self, plan: RulePlan, number: int, conjunction: Conjunction, where: str) -> Clause:
        source = " & ".join(str(part) for part in (*conjunction.constraints, *conjunction.guards))
        clause = Clause(self.clause_count, number, plan, source)
        self.clause_count += 1
        needs: list[Need] = []
        for constraint in conjunction.constraints:
            signal = self.signal(constraint.signal, where)
            if signal is not None:
                needs.append(self.need(clause, len(needs), constraint, signal, plan.rule, where))
        if not conjunction.constraints:
            self.faults.append(
                DeclarationError(
                    f"{where}: {source!r} waits for no signal; a predicate on a slot only gates: write "
                    f"{conjunction.guards[0].slot.name.split(':')[-1]}.changed & ..."
                )
            )
        guards = [(self.slot(guard.slot, where), guard) for guard in conjunction.guards]
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

    def need(
        self,
        clause: Clause,
        index: int,
        constraint: Constraint,
        signal: SignalPlan,
        rule: Rule[Any, Any],
        where: str,
    ) -> Need:
        def positive(n: float) -> bool:
            return n >= 0

        low = self.number(rule, constraint.min_age_, f"{constraint.signal}.min_age", positive, "0 s or more")
        high = math.inf
        if constraint.max_age_ is not None:
            high = self.number(
                rule, constraint.max_age_, f"{constraint.signal}.max_age", positive, "0 s or more"
            )
        if low > high:
            self.faults.append(
                DeclarationError(
                    f"{where}: {constraint.signal} can never be at least {low:g} s and at most {high:g} s old: write "
                    f".min_age({low:g}).max_age(None)"
                    + (" (max_age is 5 s unless you say otherwise)" if constraint.max_age_ == 5.0 else "")
                )
            )
        return Need(clause, index, constraint, signal, low, high)

    # ---------------------------------------------------------------- looking up

    def signal(self, signal: Signal[Any], where: str) -> SignalPlan | None:
        plan = self.signal_of.get(signal.name)
        if plan is not None and plan.signal is signal:
            return plan
        self.unknown("signal", signal.name, signal.origin, self.signal_of, where)
        return None

    def slot(self, slot: Slot[Any], where: str) -> SlotPlan | None:
        plan = self.slot_of.get(slot.name)
        if plan is not None and plan.slot is slot:
            return plan
        self.unknown("slot", slot.name, slot.origin, self.slot_of, where)
        return None

    def unknown(self, what: str, name: str, origin: str, names: Iterable[str], where: str) -> None:
        module = name.split(":")[0]
        if name in names:
            hint = f"another {what} of that name is in the policy: two modules are named {module!r}"
        elif module in self.module_names:
            hint = f"module {module} does not hold it{nearest(name, names)}"
        else:
            hint = f"write requires=[{module}] in the module of the rule, or compile module {module} as well"
        self.faults.append(DeclarationError(f"{where}: unknown {what} {name} (declared at {origin}): {hint}"))

    def number(
        self, rule: Rule[Any, Any], number: Number, what: str, valid: Callable[[float], bool], wanted: str
    ) -> float:
        where = f"rule {rule.name} ({rule.origin}): {what}"
        source = repr(number)
        if isinstance(number, SettingRef):
            self.refers = True
            found = self.setting(rule, number, where)
            if found is None:
                return 1.0
            source = f"{number!r} = {found!r}"
            number = found
        if math.isnan(number) or math.isinf(number) or not valid(number):
            self.faults.append(DeclarationError(f"{where}={source} must be {wanted}"))
            return 1.0
        return float(number)

    def setting(self, rule: Rule[Any, Any], ref: SettingRef, where: str) -> float | None:
        """The value of a named setting: of the class it was taken from, else of the rule's own module."""
        own = self.module_names.get(rule.name.split(":")[0])
        module = own
        if ref.owner is not None and (own is None or own.settings is not ref.owner):
            module = next((m for m in self.modules if m.settings is ref.owner), own)
        if module is None or module.settings is None:
            self.faults.append(
                DeclarationError(
                    f"{where}={ref!r}: module {rule.name.split(':')[0]} has no settings: write "
                    f"rs.Module({rule.name.split(':')[0]!r}, settings=Settings) with a field {ref.name}"
                )
            )
            return None
        values = self.settings.get(module.name)
        if values is None:
            fields: Mapping[str, Any] = getattr(module.settings, "model_fields", {})
            if ref.name not in fields:
                self.faults.append(
                    DeclarationError(
                        f"{where}={ref!r}: settings of module {module.name} have no field {ref.name!r}"
                        f"{nearest(ref.name, fields)}"
                    )
                )
                return None
            value = fields[ref.name].get_default(call_default_factory=True)
        else:
            value = getattr(values, ref.name, None)
        if isinstance(value, bool) or not isinstance(value, (int, float)):
            self.faults.append(
                DeclarationError(
                    f"{where}={ref!r}: the setting is {value!r}, not a number; give it a number as its default"
                )
            )
            return None
        return float(value)

    # ---------------------------------------------------------------- connecting

    def connect(self) -> None:
        """Fill in who hears what, and which needs of a clause must be met by one causal group (L12)."""
        raised = {signal for rule in self.rules for signal in rule.raises}
        listeners: list[list[Need]] = [[] for _ in self.signals]
        watchers: list[list[Need]] = [[] for _ in self.signals]
        for rule in self.rules:
            for clause in rule.clauses:
                for need in clause.needs:
                    listeners[need.signal.index].append(need)
                    if need.detached and clause.asks_detached:
                        need.signal.retain = max(need.signal.retain, need.max_age)
            for clause in rule.until:
                for need in clause.needs:
                    watchers[need.signal.index].append(need)
        for signal in self.signals:
            signal.listeners = tuple(listeners[signal.index])
            signal.watchers = tuple(watchers[signal.index])
            signal.input = signal.input or signal.index not in raised
        for slot in self.slots:
            slot.heard = any(signal.listeners or signal.watchers for signal in slot.signals)
        self.find_kin()

    def find_kin(self) -> None:
        causes = Causes(self.signals, self.rules)
        roots: dict[int, frozenset[int]] = {}

        def family(signal: int) -> frozenset[int]:
            """The signal and all that may lead to it: what its pathways consist of."""
            found = roots.get(signal)
            if found is None:
                seen = {signal}
                for index in causes.ancestors(signal):
                    for clause in self.rules[index].clauses:
                        seen.update(need.signal.index for need in clause.needs if not need.detached)
                found = roots[signal] = frozenset(seen)
            return found

        for rule in self.rules:
            for clause in rule.clauses:
                firm = [need for need in clause.needs if not need.detached]
                if len(firm) < 2:
                    continue
                for need in firm:
                    for other in firm:
                        if need.signal is other.signal or not family(need.signal.index).isdisjoint(
                            family(other.signal.index)
                        ):
                            joined = need.kin | other.kin
                            for member in firm:
                                if member.bit & joined:
                                    member.kin |= joined

    def find_contests(self) -> None:
        """Set apart the needs of clauses that differ in nothing but who comes first.

        If several clauses are ready with one spike of the same signal, write the same slots, and keep their
        order for good, then only the first can have consent, until it resigns or fails. The engine need not make
        activations of the others before that (``engine/contests.py``).
        """
        for signal in self.signals:
            contests: dict[tuple[frozenset[int], bool], list[Clause]] = {}
            for need in signal.listeners:
                clause, rule = need.clause, need.clause.rule
                fixed = not (need.detached or clause.cyclic or rule.cooldown)
                if clause.simple and rule.slots and fixed:
                    contests.setdefault((rule.slotset, rule.background), []).append(clause)
            signal.contests = tuple(
                tuple(sorted(clauses, key=lambda c: (-c.base, c.index)))
                for clauses in contests.values()
                if len(clauses) > 1
            )
            contested = {clause for clauses in signal.contests for clause in clauses}
            signal.uncontested = tuple(need for need in signal.listeners if need.clause not in contested)

    def check_reachable(self, causes: Causes) -> None:
        """Refuse rules that wait, directly or not, for an effect of their own, with no way in from outside.

        Slots may be put from outside and detached effects make loops on purpose: those are findings.
        """
        given = {s.index for s in self.signals if s.input or s.slot is not None}
        given |= {signal for rule in self.rules if rule.detached for signal in rule.raises}
        grounded = causes.grounded(given)
        for rule in self.rules:
            if any(all(n.signal.index in grounded for n in clause.needs) for clause in rule.clauses):
                continue
            lacking = [
                n.signal for clause in rule.clauses for n in clause.needs if n.signal.index not in grounded
            ]
            if not lacking:
                continue
            raisers = ", ".join(dict.fromkeys(r.name for s in lacking for r in causes.all_causes[s.index]))
            self.faults.append(
                DeclarationError(
                    f"rule {rule.name} ({rule.rule.origin}) is unreachable: it waits for "
                    f"{', '.join(dict.fromkeys(s.name for s in lacking))}, raised only by {raisers}, which wait for each "
                    f"other; if it comes from outside, declare it with input=True"
                )
            )
