"""Building a diagram from declared rules.

The diagram shows a slot or a signal only if a rule uses it. It shows a signal of a slot only if a rule names this
signal itself, usually in its condition. Conditions are in disjunctive normal form, because each run of a rule is for
one clause (law L5). If a clause has several constraints, their lines meet in a conjunction node. If a rule has several
clauses, their lines meet in a disjunction node.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import Any

from ravestate.declare.condition import DEFAULT_MAX_AGE, Constraint, Holds
from ravestate.declare.rule import Rule
from ravestate.declare.settings import Number, SettingRef
from ravestate.draw.graph import Diagram, Edge, EdgeKind, Node, NodeKind
from ravestate.policy.clauses import normal_form


def build(rules: Iterable[Rule[Any, Any]]) -> Diagram:
    """Return the diagram of the given rules, with nodes in the order of the rules."""
    builder = _Builder()
    for rule in rules:
        builder.rule(rule)
    return Diagram(tuple(builder.nodes.values()), tuple(builder.edges))


class _Builder:
    def __init__(self) -> None:
        self.nodes: dict[str, Node] = {}
        self.edges: dict[Edge, None] = {}  # an ordered set

    def rule(self, rule: Rule[Any, Any]) -> None:
        clauses = [(*clause.constraints, *clause.guards) for clause in normal_form(rule.when)]
        for clause in clauses:
            for term in clause:
                self.term(term)
        name = self.named("rule", rule.name, _note(rule))
        target = name
        if len(clauses) > 1:
            target = self.junction("or", rule.name, 0)
            self.edge(target, name, "condition")
        for number, clause in enumerate(clauses):
            end = target
            if len(clause) > 1:
                end = self.junction("and", rule.name, number)
                self.edge(end, target, "condition")
            for term in clause:
                detached = isinstance(term, Constraint) and term.is_detached
                self.edge(self.term(term), end, "condition_detached" if detached else "condition", _label(term))
        for clause in normal_form(rule.until) if rule.until is not None else ():
            for term in (*clause.constraints, *clause.guards):
                self.edge(self.term(term), name, "condition_detached", f"until {_label(term)}".rstrip())
        for slot in rule.reads:
            self.edge(self.named("slot", slot.name), name, "reads")
        for slot in rule.writes:
            self.edge(name, self.named("slot", slot.name), "writes")
        for signal in rule.emits:
            self.edge(name, self.signal(signal.name), "emits_detached" if rule.detached else "emits")

    def term(self, term: Constraint | Holds) -> str:
        return self.signal(term.signal.name) if isinstance(term, Constraint) else self.named("slot", term.slot.name)

    def signal(self, name: str) -> str:
        owner = name.rpartition(":")[0]
        if ":" not in owner:
            return self.named("signal", name)
        slot = self.named("slot", owner)  # module:slot:changed is a signal of module:slot (L2)
        signal = self.named("signal", name)
        self.edge(slot, signal, "emits")
        return signal

    def named(self, kind: NodeKind, name: str, note: str = "") -> str:
        module, _, label = name.rpartition(":") if name.count(":") < 2 else name.partition(":")
        return self.node(Node(f"{kind} {name}", kind, label, module, note))

    def junction(self, kind: NodeKind, rule: str, number: int) -> str:
        return self.node(Node(f"{kind} {rule} {number}", kind))

    def node(self, node: Node) -> str:
        self.nodes.setdefault(node.id, node)
        return node.id

    def edge(self, source: str, target: str, kind: EdgeKind, label: str = "") -> None:
        self.edges.setdefault(Edge(source, target, kind, label))


def _note(rule: Rule[Any, Any]) -> str:
    words: list[str] = []
    if rule.weight != 1.0:
        words.append(f"×{_number(rule.weight)}")
    if rule.cooldown != 0.0:
        words.append(f"cooldown {_number(rule.cooldown)} s")
    if rule.detached:
        words.append("detached")
    if rule.background:
        words.append("background")
    return ", ".join(words)


def _label(term: Constraint | Holds) -> str:
    if isinstance(term, Holds):
        return _predicate("holds", term.predicate)
    words = [_ages(term.min_age_, term.max_age_), *(_predicate("where", predicate) for predicate in term.predicates)]
    return ", ".join(word for word in words if word)


def _ages(least: Number, most: Number | None) -> str:
    """Return the ages of a spike that a constraint accepts, as text; empty for the default ages (L4)."""
    if least == 0.0:
        if most is None:
            return "any age"
        return "" if most == DEFAULT_MAX_AGE else f"≤ {_number(most)} s"
    return f"≥ {_number(least)} s" if most is None else f"{_number(least)}–{_number(most)} s"


def _number(number: Number) -> str:
    return number.name if isinstance(number, SettingRef) else f"{number:g}"


def _predicate(what: str, predicate: Callable[[Any], object]) -> str:
    """Return the word `what`, followed by the name of the predicate if it has one."""
    name = getattr(predicate, "__name__", type(predicate).__name__)
    return what if name == "<lambda>" else f"{what} {name}"
