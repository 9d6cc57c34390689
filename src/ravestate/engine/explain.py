"""Explanations (law L25), as data and as text: the reasons why a rule runs, waits, or did not fire.

`ravestate.board.why_not` explains one input in detail and builds on the phrases here.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

from ravestate.engine.activation import GATHERING, NAMES, NEVER, READY, RUNNING, WAITING, Activation, Refusal, by_age
from ravestate.engine.reasons import LossReason, Outcome, PassReason, StopReason
from ravestate.engine.state import State
from ravestate.engine.trace import Born, GaveUp, Held, Passed, Pressed, Record, Settled, Started, Told, Waits
from ravestate.engine.waits import patience_of_rivals
from ravestate.policy.model import Clause, RulePlan

if TYPE_CHECKING:
    from ravestate.engine.engine import Engine


@dataclass(frozen=True, slots=True)
class ClauseState:
    """A clause: its condition as text, its signals and pathways, its utility, and its effective utility now (nats).

    `gates` has the text of each slot predicate, and whether the predicate is true now.
    """

    condition: str
    signals: tuple[str, ...]
    pathways: tuple[tuple[str, ...], ...]
    utility: float
    effective: float
    gates: tuple[tuple[str, bool], ...]


@dataclass(frozen=True, slots=True)
class ActivationState:
    """An activation: the spikes that it holds, the signals that it lacks, and the rules that it waits for.

    Attributes:
        state: ``gathering``, ``ripening`` (a spike is too young), ``gated`` (a slot predicate is false), ``ready``,
            ``waiting``, ``running`` or ``cancelling``.
        holds: The signal and the age (seconds) of each spike that the activation holds.
        lacks: The signals of the spikes that it lacks.
        waits_for: The rules that it waits for, and by how many nats each is ahead. This lead is 0 for a tie, for
            utilities of 0, and for a rule that has taken a slot without being ahead.
        until: The time (seconds) by which the activation runs, times out or gives a spike up; None without a limit.
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
    """The state of a rule at one moment. ``str`` and ``print`` show it as text.

    Attributes:
        rule: The rule's name.
        now: The time of the explanation (seconds).
        retired: Whether the rule has left the context.
        clauses: The rule's clauses.
        activations: The rule's live activations.
        missing: A sentence for each of the rule's signals that did not occur in the trace: the rules that may raise the
            signal, and how the last run of each rule ended. Empty without a trace.
        history: The rule's latest records in the trace, as text. Empty without a trace.
        inputs: The rule's signals that are inputs. An input may come at any time, so only patience limits the wait for
            it.
    """

    rule: str
    now: float
    retired: bool
    clauses: tuple[ClauseState, ...]
    activations: tuple[ActivationState, ...]
    missing: tuple[str, ...]
    history: tuple[str, ...]
    inputs: frozenset[str] = frozenset()

    def __str__(self) -> str:
        lines = [f"{self.rule} at {self.now:.3f} s" + (": retired" if self.retired else "")]
        for clause in self.clauses:
            sums = " or ".join(" + ".join(pathway) for pathway in clause.pathways[:3])
            lines.append(f"  when {clause.condition}")
            lines.append(f"    utility {clause.utility:.6f} nats, now {clause.effective:.6f}; pathway {sums}")
            lines += [
                f"    {gate}: {'true' if open_ else 'false, so this clause cannot run'}" for gate, open_ in clause.gates
            ]
        if not self.activations:
            lines.append("  idle: no spike is left for it to act on")
        for one in self.activations:
            lines.append(f"  {one.state} (activation {one.id})")
            lines += [f"    holds {signal}, {age:.3f} s old" for signal, age in one.holds]
            lines += [f"    lacks {signal}" + ", an input" * (signal in self.inputs) for signal in one.lacks]
            lines += [
                f"    waits for {name}" + (f", which is ahead by {nats:.6f} nats" if nats else "")
                for name, nats in one.waits_for
            ]
            if one.until is not None:
                lines.append(f"    until {one.until:.3f} s at the latest")
        lines += [f"  {line}" for line in self.missing]
        if self.history:
            lines.append("  recently:")
            lines += [f"    {line}" for line in self.history]
        return "\n".join(lines)

    __repr__ = __str__


def explain(engine: Engine, rule: RulePlan, records: Iterable[Record] = (), limit: int = 12) -> Explanation:
    """Return the state of a rule, with at most `limit` lines of its history from `records`, the trace."""
    state = engine.state
    records = [*records]
    history = tuple(
        f"{seconds(record.time)}: {words}"
        for record in records
        if getattr(record, "rule", None) == rule.name and (words := words_of(record))
    )
    explanation = Explanation(
        rule.name,
        state.now,
        rule.index in state.retired,
        tuple(_clause(state, clause) for clause in rule.clauses),
        tuple(activations(state).get(rule.index, ())),
        tuple(_missing(state, rule, records)),
        history[max(len(history) - limit, 0) :],
        frozenset(need.signal.name for clause in rule.clauses for need in clause.needs if need.signal.input),
    )
    engine.rest()
    return explanation


def _clause(state: State, clause: Clause) -> ClauseState:
    return ClauseState(
        clause.source,
        tuple(signal.name for signal in clause.signals),
        tuple(tuple(sorted(signal.name for signal in pathway)) for pathway in state.policy.pathways.of_clause(clause)),
        clause.utility,
        state.effective(clause),
        tuple((str(guard), state.opens(slot, guard)) for slot, guard in clause.guards),
    )


def _activation(state: State, activation: Activation) -> ActivationState:
    clause = activation.clause
    name = NAMES[activation.state]
    if activation.state == GATHERING and not activation.missing:
        name = "gated" if activation in state.gated else "ripening"
    waits: list[tuple[str, float]] = []
    refusal = activation.refusal
    if refusal is not None:
        waits = [(rule, state.lead(rival, clause)) for rule, rival in refusal.all_names.items()]
    bounds = [activation.ripens, min(activation.patience_ends.values(), default=NEVER), activation.deadline]
    if activation.state == GATHERING:
        held = zip(activation.spikes, clause.needs, strict=True)
        bounds += [spike.born + need.max_age for spike, need in held if spike is not None]
    until = min(bounds)
    if refusal is not None:
        latest = patience_of_rivals(state, activation)
        until = NEVER if latest is None or refusal.blockers else latest
    return ActivationState(
        activation.id,
        name,
        clause.source,
        tuple((spike.signal.name, state.now - spike.born) for spike in activation.spikes if spike is not None),
        tuple(need.signal.name for need in clause.needs if need.bit & activation.missing),
        tuple(waits),
        None if until == NEVER else until,
    )


def activations(state: State) -> dict[int, list[ActivationState]]:
    """Return the live activations by the index of their rule, oldest first."""
    found = {rule: [*active] for rule, active in state.active.items()}
    for rule, others in stand_ins(state).items():
        found.setdefault(rule, []).extend(others)
    return {rule: [_activation(state, one) for one in sorted(all_, key=by_age)] for rule, all_ in found.items()}


def stand_ins(state: State) -> dict[int, list[Activation]]:
    """Return, by the index of their rule, the activations that the engine has not made yet.

    The engine keeps the spikes of these activations in halves (``halves.py``), or keeps their clauses as alternatives
    to a better clause (``conflict_sets.py``). No table of the engine gets the activations themselves, because an
    explanation changes nothing.
    """
    found: dict[int, list[Activation]] = {}
    for half, spikes in state.halves.items():
        for spike in spikes:
            for need in half.needs:
                if state.keeps(need, spike):
                    found.setdefault(need.clause.rule.index, []).append(state.stand_in(need, spike))
    for partner, benches in state.benches.items():
        for bench in benches.values():
            need = bench.half.needs[0]
            counterpart = need.clause.needs[1 - need.index]
            for spike in bench.spikes:
                other = state.stand_in(need, spike)
                other.put(counterpart, partner)
                other.missing, other.state, other.refusal = 0, WAITING, Refusal()
                other.refusal.name(need.clause)
                other.refusal.blockers.update(dict.fromkeys(h for h in partner.holders if h.state >= RUNNING))
                found.setdefault(need.clause.rule.index, []).append(other)
    for best, (clauses, made, base) in state.alternatives.items():
        spike = best.spike(best.clause.needs[0])
        for place in range(made, len(clauses)):
            clause = clauses[place]
            if spike is None or (spike.refused is not None and clause.rule.index in spike.refused):
                continue
            other = Activation(base + place + 1, clause)
            other.put(clause.needs[0], spike)
            other.missing, other.state = 0, READY
            if best.state >= WAITING:
                other.state, other.refusal = WAITING, Refusal()
                other.refusal.name(best.clause)
                other.refusal.blockers[best] = None
            found.setdefault(clause.rule.index, []).append(other)
    return found


def words_of(record: Record, others: str = "", behind: str = "") -> str:
    """Return a phrase that says what a record means for its rule; empty for a record without a rule.

    `others` describes the rules that the rule waits for. If another rule answered the spike, `behind` is the rule that
    raised that other rule's signal.
    """
    match record:
        case Held():
            lacks = f", still lacking {join(record.lacks)}" if record.lacks else " and has all it needs"
            return f"took {record.signal}{lacks}"
        case GaveUp():
            return f"gave up {record.signal}: {why_given_up(record, behind)}"
        case Passed():
            return f"did not take {record.signal}: {PassReason.say(record.reason)}"
        case Waits():
            return f"was ready and waited for {others or join(record.for_)}{latest(record.until)}"
        case Pressed():
            lacks = join(record.lacks)
            return f"lacked {lacks} while {record.by} waited for it; its patience lasted until {seconds(record.until)}"
        case Started():
            return "started"
        case Told():
            return f"was asked to stop: {StopReason.say(record.reason)}"
        case Settled():
            return Outcome.say(record.outcome) + (f": {record.reason}" if record.reason else "")
        case _:
            return ""


def why_given_up(lost: GaveUp, behind: str = "") -> str:
    """Return why a spike was given up. If a known rule answered the spike, name it: ``behind → rule answered it``."""
    if lost.reason != LossReason.CONSUMED or not lost.by:
        return LossReason.say(lost.reason)
    return f"{f'{behind} → ' if behind else ''}{lost.by} answered it"


def without(rule: str, ended: Settled) -> str:
    """Return a phrase for a run of `rule` that has not raised the signal in question; `ended` records the run's end."""
    return f"{rule} {Outcome.say(ended.outcome)} without raising it, at {seconds(ended.time)}"


def seconds(time: float) -> str:
    """Return a time in seconds as text, with its unit."""
    return f"{time:.3f} s"


def latest(until: float | None) -> str:
    """Return the words that end a sentence with a latest time (seconds); empty for None."""
    return "" if until is None else f", until {seconds(until)} at the latest"


def join(names: Iterable[str]) -> str:
    """Join names as in a sentence: ``a, b and c``."""
    *first, last = [*names] or [""]
    return f"{', '.join(first)} and {last}" if first else last


def _missing(state: State, rule: RulePlan, records: Sequence[Record]) -> Iterator[str]:
    """Yield a sentence for each signal of a rule that has not occurred: the rules that may raise it, and how they
    ended."""
    if not records:
        return
    occurred = {record.signal for record in records if isinstance(record, Born)}
    ends = {record.rule: record for record in records if isinstance(record, Settled)}
    for signal in dict.fromkeys(need.signal for clause in rule.clauses for need in clause.needs):
        if signal.name in occurred:
            continue
        raisers = [
            without(cause.name, ends[cause.name])
            if cause.name in ends
            else f"{cause.name} may raise it but has not run"
            for cause in state.policy.causes.all_causes[signal.index]
        ]
        yield f"{signal.name} has not occurred" + (f": {'; '.join(raisers)}" if raisers else "")
