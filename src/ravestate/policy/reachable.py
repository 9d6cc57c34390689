"""Rules that can never run."""

from __future__ import annotations

from ravestate.policy.causes import Causes
from ravestate.policy.wording import few


def check_reachable(causes: Causes, faults: list[str]) -> None:
    """Add a fault for each rule that waits for its own effects, directly or not, and that no input can start.

    A rule that lacks only the signal of a slot, or a detached effect, gets a finding instead. Code outside the rules
    may write slots, and detached effects make loops on purpose.
    """
    given = {s.index for s in causes.signals if s.input or s.slot is not None}
    given |= {signal for rule in causes.rules if rule.detached for signal in rule.raises}
    grounded = causes.grounded(given)
    for rule in causes.rules:
        if any(all(n.signal.index in grounded for n in clause.needs) for clause in rule.clauses):
            continue
        lacking = [n.signal for clause in rule.clauses for n in clause.needs if n.signal.index not in grounded]
        if not lacking:
            continue
        raisers = few(r.name for s in lacking for r in causes.all_causes[s.index])
        faults.append(
            f"rule {rule.name} ({rule.rule.origin}) is unreachable: it waits for {few(s.name for s in lacking)}; "
            f"only {raisers} may raise it, and they wait for each other; if it comes from outside, declare it "
            "with input=True"
        )
