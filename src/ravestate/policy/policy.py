"""The policy: compiled modules, immutable, for any number of contexts (law L6)."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import InitVar, dataclass
from types import MappingProxyType
from typing import TYPE_CHECKING, Any, Literal

from ravestate.declare.module import Module
from ravestate.declare.rule import Rule
from ravestate.declare.signal import Signal
from ravestate.declare.slot import Slot
from ravestate.errors import DeclarationError, DeclarationErrors, nearest
from ravestate.policy.causes import Causes
from ravestate.policy.completion import Completion
from ravestate.policy.model import ClauseView, RulePlan, SignalPlan, SlotPlan
from ravestate.policy.pathways import Pathways

if TYPE_CHECKING:
    from ravestate.policy.conflicts import Conflict
    from ravestate.policy.findings import Finding
    from ravestate.policy.source import Source


@dataclass(kw_only=True, eq=False, repr=False)
class Policy:
    """A set of compiled modules, made by ``rs.compile``.

    Attributes:
        modules: The modules, each after those that it requires.
        rules: Qualified name → rule, in declaration order.
        signals: Qualified name → signal, including the signals of slots.
        slots: Qualified name → slot.
    """

    modules: tuple[Module, ...]
    declared: tuple[Rule[Any, Any], ...]
    signal_plans: tuple[SignalPlan, ...]
    slot_plans: tuple[SlotPlan, ...]
    rule_plans: tuple[RulePlan, ...]
    causes: Causes
    completion: InitVar[Completion]
    refers: bool
    settings: Mapping[str, Any]

    def __post_init__(self, completion: Completion) -> None:
        self.pathways = Pathways(completion)
        self.spare: list[Any] = []
        """Parts of engines (``engine/parts.py``) that no engine uses at present."""
        clauses = [clause for rule in self.rule_plans for clause in (*rule.clauses, *rule.until)]
        self.clause_plans = {clause.index: clause for clause in clauses}
        self.plan_of = {plan.name: plan for plan in self.rule_plans}
        self.signal_of = {plan.name: plan for plan in self.signal_plans}
        self.slot_of = {plan.name: plan for plan in self.slot_plans}
        self.rules: Mapping[str, Rule[Any, Any]] = MappingProxyType({rule.name: rule for rule in self.declared})
        self.signals: Mapping[str, Signal[Any]] = MappingProxyType({p.name: p.signal for p in self.signal_plans})
        self.slots: Mapping[str, Slot[Any]] = MappingProxyType({p.name: p.slot for p in self.slot_plans})

    def rule_plan(self, rule: str | Rule[Any, Any]) -> RulePlan:
        """Return the record of a rule; `rule` may be its qualified name.

        Raises:
            DeclarationError: The policy has no such rule.
        """
        name = rule if isinstance(rule, str) else rule.name
        found = self.plan_of.get(name)
        if found is None:
            raise DeclarationError(f"the policy has no rule {name!r}{nearest(name, self.rules)}")
        return found

    def utility(self, rule: str | Rule[Any, Any]) -> float:
        """Return the utility of a rule in nats: the greatest utility of its clauses, without weight and cooldown (L9).

        The result is exact in almost all cases. It may be slightly too high if dozens of signals on a pathway each have
        several causes, which in turn share causes (``policy/least.py``). Raise a `DeclarationError` for an unknown
        rule.

        Example:
            >>> import ravestate as rs
            >>> demo = rs.Module("demo")
            >>> heard, seen = demo.signal("heard"), demo.signal("seen")
            >>> @demo.rule(when=heard)
            ... async def listen(ctx): ...
            >>> @demo.rule(when=heard & seen)
            ... async def fuse(ctx): ...
            >>> policy = rs.compile(demo)
            >>> policy.utility(listen), round(policy.utility("demo:fuse"), 6)
            (0.0, 0.693147)
        """
        return max((clause.utility for clause in self.rule_plan(rule).clauses), default=0.0)

    def clauses(self, rule: str | Rule[Any, Any]) -> tuple[ClauseView, ...]:
        """Return the clauses of a rule, each with its signals, pathways and utility.

        Args:
            rule: The rule, or its qualified name.

        Raises:
            DeclarationError: The policy has no such rule.

        Example:
            >>> import ravestate as rs
            >>> demo = rs.Module("demo")
            >>> heard, word = demo.signal("heard"), demo.signal("word")
            >>> @demo.rule(when=heard, emits=word)
            ... async def listen(ctx): ...
            >>> @demo.rule(when=word)
            ... async def answer(ctx): ...
            >>> (clause,) = rs.compile(demo).clauses("demo:answer")
            >>> clause.signals, [sorted(map(str, pathway)) for pathway in clause.pathways]
            ((demo:word,), [['demo:heard', 'demo:word']])
        """
        return tuple(
            ClauseView(clause.signals, self.pathways.of_clause(clause), clause.utility)
            for clause in self.rule_plan(rule).clauses
        )

    def conflicts(self) -> tuple[Conflict, ...]:
        """Return the pairs of rules that exclude each other for a common cause (L10), with the winner and its lead.

        A thousand rules on one slot make half a million pairs.
        """
        from ravestate.policy.conflicts import find_conflicts

        return find_conflicts(self)

    def findings(self, source: Source | None = None) -> tuple[Finding, ...]:
        """Return remarks on probable mistakes: rules that cannot run or win, endless loops, ties, signals without
        listeners.

        A rule has at most one finding of each kind. If several rules tie with it, the finding names the first of them.

        Args:
            source: A function that returns the source of a rule's function, such as ``inspect.getsource``. With it, the
                findings name undeclared reads, writes and emits, and a forgotten ``await``.
        """
        from ravestate.policy.findings import find_all

        return find_all(self, source)

    def diagram(self, format: Literal["svg", "dot", "mermaid"] = "svg") -> str:
        """Return the Signal-Rule-Slot diagram in the paper's notation, as text in the given format.

        Raises:
            ValueError: The format is unknown.
        """
        from ravestate.draw import draw

        return draw(self, format)

    def with_settings(self, settings: Mapping[str, Any]) -> Policy:
        """Return a policy with these modules and the given settings. If no rule uses a setting, return this policy.

        Raises:
            DeclarationErrors: The settings make a declaration impossible, e.g. a number is out of range.
        """
        if not self.refers or settings == self.settings:
            return self
        from ravestate.policy.compile import build

        return build(self.modules, self.declared, settings)

    def with_rule(self, rule: Rule[Any, Any], settings: Mapping[str, Any] | None = None) -> Policy:
        """Return this policy with one more rule; the rule must use this policy's signals and slots.

        Raises:
            DeclarationErrors: The rule does not fit this policy.
        """
        from ravestate.policy.compile import build

        if not isinstance(rule, Rule):  # pyright: ignore[reportUnnecessaryIsInstance]  # users may not check types
            fault = f"{rule!r} is not a rule: write @module.rule(when=...) above the function"
            raise DeclarationErrors([DeclarationError(fault)])
        if rule.name in self.rules:
            fault = f"rule {rule.name} ({rule.origin}) is in the policy already; give the new rule another name=..."
            raise DeclarationErrors([DeclarationError(fault)])
        return build(self.modules, (*self.declared, rule), self.settings if settings is None else settings)

    def __repr__(self) -> str:
        return f"<policy of {len(self.rules)} rules in {len(self.modules)} modules>"
