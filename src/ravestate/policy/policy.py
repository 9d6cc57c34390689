"""The policy: compiled modules, immutable, for any number of contexts (law L6)."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, Literal

from ravestate.declare.rule import Rule
from ravestate.errors import DeclarationError, DeclarationErrors, nearest
from ravestate.policy.model import ClauseView, RulePlan
from ravestate.policy.plans import Plans

if TYPE_CHECKING:
    from ravestate.policy.conflicts import Conflict
    from ravestate.policy.findings import Finding
    from ravestate.policy.source import Source


class Policy(Plans):
    """A set of compiled modules, made by ``rs.compile``.

    Attributes:
        modules: The modules, each after those that it requires.
        rules: Qualified name → rule, in declaration order.
        signals: Qualified name → signal, including the signals of slots.
        slots: Qualified name → slot.
    """

    def rule_plan(self, rule: str | Rule[Any, Any]) -> RulePlan:
        """Return the record of a rule; `rule` may be its qualified name.

        Raises:
            DeclarationError: The policy has no such rule.
        """
        name = rule if isinstance(rule, str) else str(getattr(rule, "name", rule))
        found = self.plan_of.get(name)
        if found is None:
            raise DeclarationError(f"the policy has no rule {name!r}{nearest(name, self.rules)}")
        return found

    def utility(self, rule: str | Rule[Any, Any]) -> float:
        """Return the utility of a rule in nats: the greatest utility of its clauses, without weight and cooldown (L9).

        The result is exact in almost all cases. It may be slightly too high if dozens of signals on a pathway each have
        several causes, which in turn share causes (``policy/least.py``).

        Raises:
            DeclarationError: The policy has no such rule.

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
        """Return remarks on probable mistakes, such as rules that cannot run or win, endless loops and ties.

        `Finding` lists all kinds. A rule has at most one finding of each kind. If it ties with several rules, the
        finding names the first of these.

        Args:
            source: A function that returns the source of a rule's function, such as ``inspect.getsource``. With it, the
                findings also name undeclared acts (e.g. reads and writes), unknown names, a forgotten ``await``, and a
                slot that the function replaces.
        """
        from ravestate.policy.findings import find_all

        return find_all(self, source)

    def diagram(self, format: Literal["svg", "dot", "mermaid"] = "svg") -> str:
        """Return the Signal-Rule-Slot diagram in the paper's notation, as text in the given format.

        Raises:
            ValueError: The format is unknown.
        """
        from ravestate.draw import draw

        return draw(self.rules.values(), format)

    def with_settings(self, settings: Mapping[str, Any]) -> Policy:
        """Return a policy with these modules and the given settings (module name → settings).

        If no rule uses a setting, or if this policy has equal settings already, return this policy.

        Raises:
            DeclarationErrors: The settings make a declaration impossible, e.g. a number is out of range.
        """
        if not self.refers or settings == self.settings:
            return self
        return Policy(self.modules, self.declared, settings)

    def with_rule(self, rule: Rule[Any, Any], settings: Mapping[str, Any] | None = None) -> Policy:
        """Return this policy with one more rule; the rule must use this policy's signals and slots.

        `settings` replaces the policy's settings, unless it is None.

        Raises:
            DeclarationErrors: The rule does not fit this policy.
        """
        if not isinstance(rule, Rule):  # pyright: ignore[reportUnnecessaryIsInstance]  # users may not check types
            fault = f"{rule!r} is not a rule: write @module.rule(when=...) above the function"
            raise DeclarationErrors([DeclarationError(fault)])
        if rule.name in self.rules:
            fault = f"rule {rule.name} ({rule.origin}) is in the policy already; give the new rule another name=..."
            raise DeclarationErrors([DeclarationError(fault)])
        return Policy(self.modules, (*self.declared, rule), self.settings if settings is None else settings)

    def __repr__(self) -> str:
        return f"<policy of {len(self.rules)} rules in {len(self.modules)} modules>"
