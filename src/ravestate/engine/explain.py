"""Why a rule runs, waits, or did not fire (L25), in data and in words."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

from ravestate.engine.activation import GATHERING, NEVER, WAITING, Activation
from ravestate.engine.trace import Born, GaveUp, Held, Passed, Pressed, Record, Settled, Started, Waits
from ravestate.policy.model import Clause, RulePlan

if TYPE_CHECKING:
    from ravestate.engine.engine import Engine

__all__ = [
    "GAVE_UP", "PASSED", "ActivationState", "ClauseState", "Explanation", "explain", "how_ended", "why_given_up",
]  # fmt: skip


@dataclass(frozen=True, slots=True)
class ClauseState:
    """A clause: its condition as declared, its utility and its effective utility now (nats)."""

    condition: str
    signals: tuple[str, ...]
    pathways: tuple[tuple[str, ...], ...]
    utility: float
    effective: float
    gates: tuple[tuple[str, bool], ...]


@dataclass(frozen=True, slots=True)
class ActivationState:
    """An activation: what it holds, what it lacks, whom it waits for.

    Attributes:
        state: ``gathering``, ``ripening``, ``gated``, ``ready``, ``waiting``, ``running`` or ``cancelling``.
        holds: Signal and age (seconds) of each spike.
        lacks: The signals that are missing.
        waits_for: The rules that it waits for, each with how many nats it loses by (0: slot taken, or a tie).
        until: When it will be given consent or give up at the latest, if that is bounded (seconds).
    """

    id: int
    state: str
    condition: str
    holds: tuple[tuple[str, float], ...]
    lacks: tuple[str, ...]
    waits_for: tuple[tuple[str, float], ...]
    until: float | None


@dataclass(frozen=True, slots=True, repr=False)
class Explanation:
    """What can be said of a rule at a moment. Printed, or looked at in an interpreter, it says it in words.

    Attributes:
        rule: The rule's name.
        retired: Whether it has left the context.
        clauses: Its clauses.
        activations: What is alive of it.
        missing: For each of its signals that has not occurred while the trace was kept: who may raise it, and how that
            ended last; empty when nothing is traced.
        history: What the trace has of it lately, in words; empty when nothing is traced.
    """

    rule: str
    now: float
    retired: bool
    clauses: tuple[ClauseState, ...]
    activations: tuple[ActivationState, ...]
    missing: tuple[str, ...]
    history: tuple[str, ...]

    def __str__(self) -> str:
        lines = [f"{self.rule} at {self.now:.3f} s" + (": has retired" if self.retired else "")]
        for clause in self.clauses:
            sums = " or ".join(" + ".join(pathway) for pathway in clause.pathways[:3])
            lines.append(f"  when {clause.condition}")
            lines.append(f"    utility {clause.utility:.6f} nats, now {clause.effective:.6f}; pathway {sums}")
            lines += [
                f"    {gate}: {'true' if open_ else 'false, so it may not run'}"
                for gate, open_ in clause.gates
            ]
        if not self.activations:
            lines.append("  stands by: it holds no spike")
        for one in self.activations:
            lines.append(f"  {one.state} (activation {one.id})")
            lines += [f"    holds {signal}, {age:.3f} s old" for signal, age in one.holds]
            lines += [f"    lacks {signal}" for signal in one.lacks]
            lines += [
                f"    waits for {name}" + (f", which is ahead by {nats:.6f} nats" if nats else "")
                for name, nats in one.waits_for
            ]
            if one.until is not None:
                lines.append(f"    until {one.until:.3f} s at the latest")
        lines += [f"  {line}" for line in self.missing]
        if self.history:
            lines.append("  lately:")
            lines += [f"    {line}" for line in self.history]
        return "\n".join(lines)

    __repr__ = __str__


def explain(engine: Engine, rule: RulePlan, records: Iterable[Record] = (), limit: int = 12) -> Explanation:
    """Explain a rule of an engine; `records` is the trace to tell its recent history from."""
    engine.look()
    return Explanation(
        rule.name,
        engine.now,
        rule.index in engine.retired,
        tuple(_clause(engine, clause) for clause in rule.clauses),
        tuple(_activation(engine, activation) for activation in engine.active.get(rule.index, ())),
        tuple(_missing(engine, rule, list(records))),
        tuple(_history(rule.name, records))[-limit:],
    )


def _clause(engine: Engine, clause: Clause) -> ClauseState:
    return ClauseState(
        clause.source,
        tuple(signal.name for signal in clause.signals),
        tuple(tuple(sorted(signal.name for signal in pathway)) for pathway in engine.policy.pathways.of_clause(clause)),
        clause.utility,
        engine.effective(clause),
        tuple((str(guard), engine.opens(slot, guard)) for slot, guard in clause.guards),
    )


def _activation(engine: Engine, activation: Activation) -> ActivationState:
    clause = activation.clause
    state = activation.state.name.lower()
    if activation.state is GATHERING and not activation.missing:
        state = "gated" if activation in engine.gated else "ripening"
    waits: list[tuple[str, float]] = []
    if activation.state is WAITING:
        mine = engine.effective(clause)
        for name in activation.waits_for:
            theirs = max(engine.effective(c) for c in engine.policy.rule_plan(name).clauses)
            waits.append((name, max(0.0, theirs - mine)))
    bounds = [activation.ripens, activation.pressed, activation.deadline]
    if activation.state is GATHERING:
        held = zip(activation.spikes, clause.needs, strict=True)
        bounds += [spike.born + need.max_age for spike, need in held if spike is not None]
    until = min(bounds)
    if activation.state is WAITING:
        latest = engine.patience_of_rivals(activation)
        until = NEVER if latest is None or activation.blockers else latest
    return ActivationState(
        activation.id,
        state,
        clause.source,
        tuple(
            (spike.signal.name, engine.now - spike.born) for spike in activation.spikes if spike is not None
        ),
        tuple(need.signal.name for need in clause.needs if need.bit & activation.missing),
        tuple(waits),
        None if until == NEVER else until,
    )


def how_ended(settled: Settled) -> str:
    """How a run ended, as a verb of the past: ``was done``, ``resigned``, ``failed``, ``was interrupted``, ..."""
    past = settled.outcome in ("resigned", "failed", "retired")
    return settled.outcome if past else f"was {settled.outcome}"


def why_given_up(lost: GaveUp, behind: str = "") -> str:
    """Why a spike was given up: as ``rule answered it``, or ``behind → rule answered it``, if another rule did."""
    if lost.reason != "consumed" or not lost.by:
        return GAVE_UP.get(lost.reason, lost.reason)
    return f"{f'{behind} → ' if behind else ''}{lost.by} answered it"


def _missing(engine: Engine, rule: RulePlan, records: Sequence[Record]) -> Iterator[str]:
    """What has not occurred of the signals of a rule, and why not."""
    if not records:
        return
    occurred = {record.signal for record in records if isinstance(record, Born)}
    ends = {record.rule: record for record in records if isinstance(record, Settled)}
    for signal in dict.fromkeys(need.signal for clause in rule.clauses for need in clause.needs):
        if signal.name in occurred:
            continue
        raisers = [
            f"{cause.name} may raise it, and "
            + (
                f"{how_ended(end)} at {end.time:.3f} s without"
                if (end := ends.get(cause.name))
                else "has not run"
            )
            for cause in engine.policy.causes.all_causes[signal.index]
        ]
        yield f"{signal.name} has not occurred" + (f": {'; '.join(raisers)}" if raisers else "")


def _history(rule: str, records: Iterable[Record]) -> Iterator[str]:
    """The story of a rule, from a trace."""
    for record in records:
        match record:
            case Held(rule=name) if name == rule:
                lacking = (
                    f", still lacking {', '.join(record.lacks)}" if record.lacks else ": it has all it needs"
                )
                yield f"{record.time:.3f} s: took {record.signal}{lacking}"
            case GaveUp(rule=name) if name == rule:
                yield f"{record.time:.3f} s: gave {record.signal} up: {why_given_up(record)}"
            case Passed(rule=name) if name == rule:
                yield f"{record.time:.3f} s: did not take {record.signal}: {PASSED[record.reason]}"
            case Waits(rule=name) if name == rule:
                until = f" until {record.until:.3f} s at the latest" if record.until is not None else ""
                yield f"{record.time:.3f} s: was ready, and waited for {', '.join(record.for_)}{until}"
            case Pressed(rule=name) if name == rule:
                yield (
                    f"{record.time:.3f} s: {record.by} waited for it; lacking {', '.join(record.lacks)}, it had patience "
                    f"until {record.until:.3f} s"
                )
            case Started(rule=name) if name == rule:
                yield f"{record.time:.3f} s: ran"
            case Settled(rule=name) if name == rule:
                yield f"{record.time:.3f} s: {how_ended(record)}" + (
                    f": {record.reason}" if record.reason else ""
                )
            case _:
                pass


PASSED = {
    "payload": "its payload did not fit the predicate",
    "consumed": "another rule had answered its cause",
    "caused": "the rule itself was among its causes",
}
"""Why a rule did not take a spike."""

GAVE_UP = {
    "age": "the spike was too old",
    "consumed": "another rule answered it",
    "resigned": "the rule resigned for it",
    "eliminated": "its patience ran out while others waited",
    "withdrawn": "the spike was withdrawn",
    "retired": "the rule retired",
}
"""Why an activation gave a spike up. The board's page says it in the same words (``frontend/src/board/words.ts``)."""
