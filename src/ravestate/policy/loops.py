"""Rules that trigger each other without time passing (law L23).

In a loop, each rule has a clause whose signals come from rules of the loop, and at least one rule or constraint is
detached. Without detachment, the causal group ends the loop (L19). A clause with a ``min_age`` or a predicate is not
part of a loop here, because it may end the loop. A rule that takes time is not part of a loop either. A rule takes time
if it awaits something. A plain function takes time if it uses a value that may block: one whose type is not in `QUICK`,
and that is no module of Ravestate.
"""

from __future__ import annotations

import dis
from collections import Counter
from collections.abc import Iterator
from types import CellType, FunctionType, ModuleType, NoneType

from ravestate.declare.condition import Condition
from ravestate.declare.module import Module
from ravestate.declare.signal import Signal
from ravestate.declare.slot import Slot
from ravestate.policy.components import components
from ravestate.policy.model import Clause, Need, RulePlan
from ravestate.policy.plans import Plans

QUICK = (Signal, Slot, Module, Condition, str, int, float, tuple, NoneType)
"""Types of values that take no time to use."""

HOME = "ravestate"  # a Python module whose name starts with this counts as taking no time to use


def endless_loops(policy: Plans) -> Iterator[tuple[list[RulePlan], list[str]]]:
    """Yield, for each loop, its rules and the names of the signals between them."""
    clauses = [
        clause
        for rule in policy.rule_plans
        for clause in rule.clauses
        if not (clause.guards or _takes_time(rule) or any(n.predicates or n.min_age for n in _wanted(clause)))
    ]
    clauses = _fed(policy, clauses)
    wanted: dict[int, list[Need]] = {}
    for clause in clauses:
        for need in _wanted(clause):
            wanted.setdefault(need.signal.index, []).append(need)
    edges: list[dict[int, list[Need]]] = [{} for _ in policy.rule_plans]
    for rule in {clause.rule.index: clause.rule for clause in clauses}.values():
        for signal in _raised(policy, rule):
            for need in wanted.get(signal, ()):
                edges[rule.index].setdefault(need.clause.rule.index, []).append(need)
    found = components([tuple(ahead) for ahead in edges])
    for members in found.members:
        inner = [
            (policy.rule_plans[member], need)
            for member in sorted(members)
            for other, needs in edges[member].items()
            if other in members
            for need in needs
        ]
        if any(rule.detached or need.detached for rule, need in inner):
            names = dict.fromkeys(need.signal.name for _, need in inner)
            yield [policy.rule_plans[member] for member in sorted(members)], list(names)


def _fed(policy: Plans, clauses: list[Clause]) -> list[Clause]:
    """Drop clauses until each remaining clause waits only for signals that rules of remaining clauses raise.

    Return the remaining clauses.
    """
    hearers: dict[int, list[Clause]] = {}
    raisers = Counter[int]()
    for clause in clauses:
        raisers.update(_raised(policy, clause.rule))
        for need in _wanted(clause):
            hearers.setdefault(need.signal.index, []).append(clause)
    left = dict.fromkeys(clauses)
    silent = [signal for signal in hearers if not raisers[signal]]
    while silent:
        for clause in hearers.get(silent.pop(), ()):
            if clause in left:
                del left[clause]
                raised = _raised(policy, clause.rule)
                raisers.subtract(raised)
                silent += [signal for signal in raised if not raisers[signal]]
    return list(left)


def _wanted(clause: Clause) -> list[Need]:
    """Return the needs of a clause that take a new spike for each run: the non-detached needs, or all if all are
    detached."""
    return [need for need in clause.needs if not need.detached] or list(clause.needs)


def _raised(policy: Plans, rule: RulePlan) -> list[int]:
    """Return the indices of the signals that a rule may raise, and that may immediately start the next rule of a loop.

    The signals of flags are left out: writing the present value of a flag raises no signal. The only signal
    of any other slot that counts is `changed`.
    """
    changes = [policy.slot_plans[s].signals[0].index for s in rule.slots if not policy.slot_plans[s].is_flag]
    return [*rule.emits, *changes]


def _takes_time(rule: RulePlan) -> bool:
    function = rule.rule.function
    if not isinstance(function, FunctionType) or "sleep" in function.__code__.co_names:
        return True
    steps = list(dis.get_instructions(function))
    if rule.rule.is_async:
        return any(step.opname == "GET_AWAITABLE" for step in steps)
    cells = dict(zip(function.__code__.co_freevars, function.__closure__ or (), strict=True))
    for step in steps:  # a plain function may block on any value that is not `QUICK`: a camera, a queue, a server
        if step.opname == "LOAD_DEREF" and step.argval in cells:
            used = next(iter(_content(cells[step.argval])), None)
        elif step.opname in ("LOAD_GLOBAL", "LOAD_NAME"):
            used = function.__globals__.get(step.argval, open if step.argval in ("input", "open") else None)
        else:
            continue
        if not isinstance(used, QUICK) and not (isinstance(used, ModuleType) and used.__name__.startswith(HOME)):
            return True
    return False


def _content(cell: CellType) -> list[object]:
    try:
        return [cell.cell_contents]
    except ValueError:  # the variable of the enclosing function has no value yet
        return []
