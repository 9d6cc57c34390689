"""Findings: declarations that compile but are probably mistakes."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import islice

from ravestate.declare.core import startup
from ravestate.declare.wording import few
from ravestate.policy.completion import each
from ravestate.policy.conflicts import Conflicts, writers
from ravestate.policy.loops import endless_loops
from ravestate.policy.model import Clause, RulePlan
from ravestate.policy.plans import Plans
from ravestate.policy.source import Source, acts_of, undeclared

BREAKING = frozenset(
    {"undeclared", "unknown", "await", "assignment"}
)  # findings of these kinds mean that a rule fails at run time, or does not do what its source says

MAX_PEERS = 64
"""The search for ties compares each rule with at most this many other rules, those declared first.

Without a limit the time would grow with the square of the number of rules; ``policy.conflicts()`` compares all rules.
"""


@dataclass(frozen=True, slots=True)
class Finding:
    """A remark on a probable mistake in a policy.

    Attributes:
        kind: ``"undeclared"``, ``"unknown"``, ``"await"``, ``"assignment"``, ``"unreachable"``, ``"unraised"``,
            ``"loop"``, ``"never-wins"``, ``"tie"``, ``"cooldown"`` or ``"unheard"``.
        subject: The qualified name of the rule or signal.
        message: The remark. It says what to change.
        rules: The names of the rules that wait for the signal, if the kind is ``"unraised"``; else empty.
    """

    kind: str
    subject: str
    message: str
    rules: tuple[str, ...] = ()

    def __str__(self) -> str:
        return f"{self.kind}: {self.message}"


def find_all(policy: Plans, source: Source | None = None) -> tuple[Finding, ...]:
    """Return all findings, at most one of each kind for a rule. Findings of the kinds in `BREAKING` come first.

    `source` returns the source of a function. Without it, the findings that need source code are left out.
    """
    return (
        *(_in_source(policy, source) if source else ()),
        *_unreachable(policy),
        *_unraised(policy),
        *_loops(policy),
        *_never_wins(policy),
        *_ties(policy),
        *_cooldowns(policy),
        *_unheard(policy),
    )


def _in_source(policy: Plans, source: Source) -> Iterator[Finding]:
    for rule in policy.rule_plans:
        acts = acts_of(rule, source)
        where = f"rule {rule.name} ({rule.rule.origin})"
        if faults := list(undeclared(rule, acts)):
            yield Finding("undeclared", rule.name, f"{where} {'; it '.join(faults)}")
        if acts.unknown:
            yield Finding("unknown", rule.name, f"{where} names {', and '.join(acts.unknown)}")
        for method, line in islice(acts.forgotten.items(), 1):
            mend = f"write await ctx.{method}(...)" + ("" if rule.rule.is_async else " in an async def")
            yield Finding("await", rule.name, f"{where} calls ctx.{method} in line {line} without effect: {mend}")
        for slot, line in islice(acts.replaced.items(), 1):
            why = f"replaces the slot {slot} in line {line}, for all agents: write ctx[{slot}] = ..."
            yield Finding("assignment", rule.name, f"{where} {why}")


def _unraised(policy: Plans) -> Iterator[Finding]:
    for signal in policy.signal_plans:
        waiting = [need.clause.rule.name for need in (*signal.listeners, *signal.watchers)]
        raised = signal.slot is not None or signal.signal.input or policy.causes.all_causes[signal.index]
        if waiting and not raised:
            yield Finding(
                "unraised",
                signal.name,
                f"signal {signal.name} has listeners ({few(waiting)}), and no rule raises it; if it comes from outside, "
                "declare it with input=True",
                tuple(waiting),
            )


def _loops(policy: Plans) -> Iterator[Finding]:
    for rules, signals in endless_loops(policy):
        names = few(rule.name for rule in rules)
        subject = f"rule {names} triggers itself" if len(rules) == 1 else f"rules {names} trigger each other"
        yield Finding(
            "loop",
            rules[0].name,
            f"{subject} through {few(signals)} without time passing, and may never end (law L23): add "
            ".min_age(seconds) to one of these signals",
        )


def _unreachable(policy: Plans) -> Iterator[Finding]:
    grounded = policy.causes.grounded(s.index for s in policy.signal_plans if s.input)
    known: dict[tuple[int, frozenset[int]], bool] = {}
    for rule in policy.rule_plans:
        lacking = [n.signal for c in rule.clauses for n in c.needs if n.signal.index not in grounded]
        if not any(all(n.signal.index in grounded for n in c.needs) for c in rule.clauses):
            names = few(s.name for s in lacking)
            yield Finding(
                "unreachable",
                rule.name,
                f"rule {rule.name} runs only if code outside the rules raises {names}: no input leads to the rule; "
                "if such code exists, declare the signal or its slot with input=True",
            )
        elif rule.slots and all(_starves(policy, clause, known) for clause in rule.clauses):
            slots = ", ".join(policy.slot_plans[s].name for s in rule.slots)
            yield Finding(
                "unreachable",
                rule.name,
                f"rule {rule.name} waits for a signal that only other writers of {slots} raise, and a causal group "
                "allows only one write of a slot (L19): add .detached() to this signal, or detached=True to the rule "
                "that raises it",
            )


def _starves(policy: Plans, clause: Clause, known: dict[tuple[int, frozenset[int]], bool]) -> bool:
    """Return whether a signal of the clause comes only from rules that write one of the clause's slots."""
    slots = clause.rule.slotset
    for need in clause.needs:
        if need.detached or need.signal.input:
            continue
        key = need.signal.index, slots
        if key not in known:
            raisers = policy.causes.all_causes[need.signal.index]
            known[key] = all(not r.detached and not r.slotset.isdisjoint(slots) for r in raisers)
        if known[key]:
            return True
    return False


def _never_wins(policy: Plans) -> Iterator[Finding]:
    winners = _winners(policy)
    for rule in policy.rule_plans:
        if not rule.slots or not rule.clauses:
            continue
        losers = [_winner(winners, clause) for clause in rule.clauses]
        if all(losers):
            once = all(need.signal.signal is startup for clause in rule.clauses for need in clause.needs)
            advice = (
                "core:startup comes only once: if both should run, write rs.startup.detached()"
                if once
                else "give it one more signal or a greater weight, or give the other rule a cooldown"
            )
            yield Finding(
                "never-wins",
                rule.name,
                f"rule {rule.name} runs only when {few(w.rule.name for w in losers if w is not None)} resigns: the same "
                f"signals trigger both, and {rule.name} has no greater utility; {advice}",
            )


def _winners(policy: Plans) -> dict[tuple[int, int], list[Clause]]:
    """Return the clauses without predicates and without detached needs, by slot and by rarest signal.

    The rarest signal of a clause is the one with the fewest listeners. In each list, the best clause comes first.
    Clauses of a rule with a cooldown are left out, unless they wait only for ``core:startup``.
    """
    found: dict[tuple[int, int], list[Clause]] = {}
    for rule in policy.rule_plans:
        for clause in rule.clauses:
            if clause.guards or not clause.needs or any(n.detached or n.predicates for n in clause.needs):
                continue
            if rule.cooldown and not all(need.signal.signal is startup for need in clause.needs):
                continue
            rarest = min((need.signal for need in clause.needs), key=lambda s: (len(s.listeners), s.index))
            for slot in rule.slots:
                found.setdefault((slot, rarest.index), []).append(clause)
    for clauses in found.values():
        clauses.sort(key=_order)
    return found


def _winner(winners: dict[tuple[int, int], list[Clause]], loser: Clause) -> Clause | None:
    """Return a clause that is ahead of `loser`, and ready whenever `loser` is; None if there is no such clause."""
    for slot in loser.rule.slots:
        for need in loser.needs:
            for winner in winners.get((slot, need.signal.index), ()):
                if _order(winner) > _order(loser):
                    break
                if winner.rule is not loser.rule and _covers(winner, loser):
                    return winner
    return None


def _order(clause: Clause) -> tuple[float, int]:
    return -clause.base, clause.index


def _covers(winner: Clause, loser: Clause) -> bool:
    """Return whether `winner` is ready whenever `loser` is."""
    return all(
        any(
            not theirs.detached
            and theirs.signal is mine.signal
            and theirs.min_age >= mine.min_age
            and theirs.max_age <= mine.max_age
            for theirs in loser.needs
        )
        for mine in winner.needs
    )


def _ties(policy: Plans) -> Iterator[Finding]:
    conflicts = Conflicts(policy)
    # Two rules can tie only if they share a slot, a root and a base utility. A root is a signal or a cycle of signals
    # at which the causes of a rule begin.
    peers: dict[tuple[int, int, float], list[RulePlan]] = {}
    for second in policy.rule_plans:
        keys = {
            (slot, root, clause.base): None
            for clause in second.clauses
            for slot in second.slots
            for root in islice(each(conflicts.roots(clause)), MAX_PEERS)
        }
        others = {rule.index: rule for key in keys for rule in peers.get(key, ())[:MAX_PEERS]}
        for index in sorted(others)[:MAX_PEERS]:
            first = others[index]
            best = conflicts.best(first, second)
            if best is not None and best[0].base == best[1].base and not _apart(first, second):
                slots = (policy.slot_plans[s].name for s in sorted(first.slotset & second.slotset))
                yield Finding(
                    "tie",
                    second.name,
                    f"rules {first.name} and {second.name} have the same utility for {few(slots)}. {first.name} goes "
                    "first because it is declared first; to choose yourself, give one of the rules a weight",
                )
                break
        for key in keys:
            peers.setdefault(key, []).append(second)


def _apart(first: RulePlan, second: RulePlan) -> bool:
    """Return whether two rules have different predicates on the same signal, so that the payload decides which runs."""
    mine = {need.signal.index: need.predicates for clause in first.clauses for need in clause.needs}
    theirs = {need.signal.index: need.predicates for clause in second.clauses for need in clause.needs}
    return any(mine[s] and theirs[s] and mine[s] != theirs[s] for s in mine.keys() & theirs.keys())


def _cooldowns(policy: Plans) -> Iterator[Finding]:
    conflicts = Conflicts(policy)
    writing = writers(policy)
    for rule in policy.rule_plans:
        if rule.cooldown and not any(
            len(writing[slot]) > MAX_PEERS or any(o is not rule and conflicts.best(rule, o) for o in writing[slot])
            for slot in rule.slots
        ):
            yield Finding(
                "cooldown",
                rule.name,
                f"rule {rule.name} has a cooldown of {rule.cooldown:g} s, but no rival: a cooldown only lets other rules "
                "go first; to let the rule rest, write the time of each run to a slot, and resign while that time is "
                "recent",
            )


def _unheard(policy: Plans) -> Iterator[Finding]:
    for signal in policy.signal_plans:
        if signal.slot is None and not signal.listeners and not signal.watchers and not signal.name.startswith("core:"):
            raisers = policy.causes.all_causes[signal.index]
            if raisers:
                yield Finding(
                    "unheard",
                    signal.name,
                    f"no rule hears signal {signal.name}, which {few(r.name for r in raisers)} may raise; remove it, or write a "
                    "rule that hears it",
                )
