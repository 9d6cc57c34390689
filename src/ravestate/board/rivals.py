"""The other rules in an explanation of why a rule did not run: those it waited for, and the one that answered."""

from __future__ import annotations

from bisect import bisect_right

from ravestate.board.description import Description, RuleView
from ravestate.board.history import Attempt, History
from ravestate.engine.explain import join, seconds
from ravestate.engine.trace import GaveUp, Passed, Waits


class Rivals:
    """Phrases about other rules.

    Args:
        history: The history of the context, from its trace.
        description: The description of the context's policy.
    """

    def __init__(self, history: History, description: Description) -> None:
        self._history = history
        self._description = description
        self._first: dict[str, Attempt | None] = {}  # losing rule → the run that answered first

    def waited(self, rule: RuleView, attempt: Attempt) -> str:
        """Return which rules the attempt last waited for, as a phrase; empty if it did not wait."""
        if not attempt.waits:
            return ""
        return f"it was ready and waited for {self.names(rule, attempt, attempt.waits[-1])}"

    def names(self, rule: RuleView, attempt: Attempt, wait: Waits) -> str:
        """Return the names of the rules that the attempt waited for, each with the reason."""
        parts: list[str] = []
        for name in wait.for_:
            if name == rule.name:
                parts.append("another run of its own on the same spike")
            elif self._history.ran(name, wait.time):
                other = self._description.rule(name)
                common = [] if other is None else [slot for slot in rule.writes if slot in other.writes]
                parts.append(f"{name}, which was running and had taken {join(common) or 'the spike'}")
            else:
                parts.append(f"{name}{self.ahead(name, rule, attempt, wait.time)}")
        return join(parts)

    def ahead(self, name: str, rule: RuleView, attempt: Attempt, time: float) -> str:
        """Return, in brackets, by how much the utility of the rule `name` is ahead; empty if it is not ahead."""
        other = self._description.rule(name)
        if other is None or name == rule.name:
            return ""
        theirs = max((clause.base for clause in other.clauses), default=0.0) * self._recovered(other, time)
        nats = theirs - rule.clauses[attempt.clause].base * self._recovered(rule, time)
        if nats > 1e-8:
            return f" ({nats:.3f} nats ahead)"
        return " (equal utility, declared earlier)" if abs(nats) <= 1e-8 else ""

    def answerer(self, rule: RuleView, lost: GaveUp | Passed) -> tuple[str, str]:
        """Return the answering rule, and a path: that rule, preceded by the one that raised its input."""
        by, run = (lost.by, lost.run) if lost.by else self._answered(rule, lost.time)
        before = self._history.before(run)
        return by, f"{before} → {by}" if before else by

    def pressure(self, rule: RuleView, end: float) -> str:
        """Say which other rule waited until the patience of `rule` ran out, at the latest at `end` (seconds)."""
        pressed = self._history.pressed.get(rule.name, [])
        times = bisect_right(pressed, end, key=lambda one: one.until)  # sorted: a rule's patience never changes
        ended = f"this rule's patience ran out at {seconds(end)}"
        if not times:
            return ended
        last = pressed[times - 1]
        return f"{last.by} waited for it from {seconds(last.time)} on, and {ended}"

    def _recovered(self, rule: RuleView, time: float) -> float:
        """Return the share of its utility that a rule has recovered since its last run (L9)."""
        fired = self._history.fired.get(rule.name, [])
        times = bisect_right(fired, time)
        return min(1.0, (time - fired[times - 1]) / rule.cooldown) if rule.cooldown and times else 1.0

    def _answered(self, rule: RuleView, time: float) -> tuple[str, int]:
        """Return the first other rule that wrote one of `rule`'s slots before `time`, and the number of its run."""
        if rule.name not in self._first:
            slots = set(rule.writes)
            self._first[rule.name] = self._history.answered(
                {
                    other.name: [{c.signal for c in clause.constraints if not c.detached} for clause in other.clauses]
                    for other in self._description.rules
                    if other.name != rule.name and slots & set(other.writes)
                }
            )
        first = self._first[rule.name]
        if first is None or first.end is None or first.end > time:
            return "another rule", 0
        return first.rule, first.id
