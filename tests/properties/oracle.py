"""Assertions that hold for every play. They examine the behaviour and the tables of the engine."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from properties.worlds import PREDICATES, Play
from ravestate.engine.activation import State
from ravestate.engine.effects import Effect, Ended, Run
from ravestate.engine.explain import explain, stand_ins
from ravestate.engine.snapshot import snapshot
from ravestate.engine.stalemate import stalemate

__all__ = [
    "Exclusion",
    "bounded",
    "consistent",
    "empty",
    "joined",
    "still",
    "waits_for_a_reason",
]


@dataclass
class Started:
    """A run, with the slots, groups and spikes that it had at its start."""

    run: int
    rule: str
    slots: frozenset[int]
    groups: tuple[Any, ...]
    spikes: tuple[int, ...]
    over: bool = False
    fired: bool = False

    @property
    def counts(self) -> bool:
        """Return whether this run still excludes others, because it runs or has fired."""
        return self.fired or not self.over


class Exclusion:
    """Asserts that two runs that exclude each other never run together, and never both fire (L10, L15, L18)."""

    def __init__(self) -> None:
        self.runs: dict[int, Started] = {}
        self.seen: set[tuple[int, tuple[int, ...]]] = set()

    def __call__(self, play: Play, effect: Effect) -> None:
        if isinstance(effect, Ended):
            run = self.runs[effect.run]
            assert not run.over, f"run {effect.run} of {effect.rule} ended twice"
            run.over, run.fired = True, effect.fired
        elif isinstance(effect, Run):
            self.start(play, effect)

    def start(self, play: Play, effect: Run) -> None:
        engine = play.engine
        activation = engine.state.running[effect.run]
        clause, rule = activation.clause, activation.clause.rule
        name = rule.name
        assert rule.index not in engine.state.retired, f"{name} runs although it has retired"
        held = list(zip(clause.needs, activation.spikes, strict=True))
        firm: list[Any] = []
        for need, spike in held:
            assert spike is not None, f"{name} runs without {need.signal}"
            assert spike.signal is need.signal, f"{name} holds {spike} as {need.signal}"
            assert spike.born + need.min_age <= engine.now, f"{name} runs on {spike}, which is too young"
            for predicate in need.predicates:
                assert predicate(spike.payload), f"{name} runs on {spike}, but {predicate} is false for it"
            if not need.detached:
                firm.append(spike)
        for slot, guard in clause.guards:
            assert guard.predicate(engine.read(slot.index)), f"{name} runs although {guard} is false"
        for one in clause.needs:  # coherence (L12)
            for other in clause.needs:
                if one.kin & other.bit and not one.detached and not other.detached:
                    a, b = activation.spike(one), activation.spike(other)
                    assert a.group.root() is b.group.root(), f"{name} joins {a} and {b} of different groups"
        key = (clause.index, tuple(spike.id for _, spike in held))
        # Detached spikes serve any number of runs (L19), so a clause with only such spikes can run twice on them.
        assert not firm or key not in self.seen, f"{name} runs twice on {activation.spikes}"
        self.seen.add(key)
        groups = tuple(dict.fromkeys(spike.group.root() for spike in firm)) if rule.slots else ()
        mine = Started(effect.run, name, rule.slotset, groups, tuple(spike.id for spike in firm))
        for run in self.runs.values():
            if not run.counts:
                continue
            if not rule.slots and run.rule == name:
                both = set(run.spikes) & set(mine.spikes)
                assert not both, f"{name} runs twice on the same spike {both}"
            shared = {g.root() for g in run.groups} & set(groups)
            taken = run.slots & mine.slots
            assert not (shared and taken), (
                f"{name} (run {mine.run}) starts although {run.rule} (run {run.run}) "
                f"{'has fired' if run.over else 'runs'} in {shared} on the same slot"
            )
        for other in engine.state.waiting:
            if (
                other is not activation
                and other.state == State.WAITING
                and not other.clause.rule.slotset.isdisjoint(rule.slotset)
                and any(group in groups for group in other.firm_groups())
                and engine.state.effective(other.clause) > engine.state.effective(clause)
            ):
                raise AssertionError(f"{name} starts before {other}, which is ready and worth more")
        self.runs[effect.run] = mine


def waits_for_a_reason(play: Play) -> None:
    """Assert that each wait ends, and has a reason: a viable rival or a taken slot (L15, L16)."""
    engine = play.engine
    due = engine.next_deadline()
    if engine.state.waiting and not engine.state.running:
        assert due is not None, f"{list(engine.state.waiting)} wait although no run and no deadline is left"
    if due is not None:
        assert due >= engine.now, f"a deadline at {due} s is past at {engine.now} s"
    for waiter in list(engine.state.waiting):
        assert waiter.state == State.WAITING
        assert waiter.clause.rule.slots, f"{waiter} waits although it writes nothing"
        assert engine.parts.agenda.consent.ask(waiter, commit=False), (
            f"{waiter} waits although no group would refuse consent"
        )
    assert not stalemate(engine.parts.agenda.consent, engine.state.waiting), "activations wait only for each other"


def joined(play: Play) -> None:
    """Assert that no activation lacks a spike although a live spike fits (L12).

    A spike fits if it is younger than the activation, meets the constraint, and belongs to the right group.
    """
    engine = play.engine
    for activation in play.active():
        if activation.state != State.GATHERING:
            continue
        for need in activation.clause.needs:
            if not need.bit & activation.missing or need.detached:
                continue
            held = [
                spike.group.root()
                for other, spike in zip(activation.clause.needs, activation.spikes, strict=True)
                if spike is not None and other.bit & need.kin
            ]
            for spike in engine.state.live.get(need.signal.index, ()):
                apart = any(group is not spike.group.root() for group in held)
                assert apart or activation.id > spike.before or not engine.state.fits(need, spike), (
                    f"{activation} lacks {need.signal}, but does not take {spike}"
                )


def still(play: Play) -> dict[str, Any]:
    """Return a snapshot without the parts that change only because time passes."""
    found = snapshot(play.engine)
    del found["now"]
    for spike in found["spikes"]:
        del spike["age"]
    for activation in found["activations"]:
        activation["holds"] = [held["signal"] for held in activation["holds"]]
        activation["waits_for"] = [waits["rule"] for waits in activation["waits_for"]]
    return found


def consistent(engine: Any) -> None:
    """Assert that the tables of the engine agree with one another."""
    activations = [a for rule in engine.state.active.values() for a in rule]
    assert all(engine.state.active.values()), "an empty set of activations is kept"
    for activation in activations:
        clause = activation.clause
        state = activation.state
        assert state != State.ENDED, f"{activation} has ended, but is kept"
        for need in clause.needs:
            spike = activation.spike(need)
            assert (spike is None) == bool(activation.missing & need.bit), (
                f"the missing bits of {activation} are wrong for {need}"
            )
            lacks = activation in engine.state.lacking.get(need, ())
            assert lacks == (spike is None), f"{activation} is{'' if lacks else ' not'} listed as lacking {need}"
            if spike is not None:
                assert activation in spike.holders, f"{activation} holds {spike}, which does not list the activation"
                if state < State.RUNNING:
                    assert spike in engine.state.live.get(spike.signal.index, ()), (
                        f"{activation} holds {spike}, which is not live"
                    )
        assert activation.missing != clause.all_bits, f"{activation} holds no spike"
        assert (state == State.WAITING) == (activation in engine.state.waiting), (
            f"the state of {activation} and the list of waiting activations disagree"
        )
        assert (state >= State.RUNNING) == (engine.state.running.get(activation.number) is activation)
        for group in activation.firm_groups():
            assert group.has(activation), f"{group} does not have the member {activation}"
            for member in group.members:
                assert group in member.firm_groups(), f"{member} is in {group}, but holds no spike of it"
            for waiter in group.interested:
                assert waiter in engine.state.waiting, (
                    f"{group} lists {waiter} as interested, but the activation does not wait"
                )
            for slot, holders in group.taken.items():
                assert holders is None or (holders and all(h.state >= State.RUNNING for h in holders)), slot
    known = set(activations)
    for where in (engine.state.waiting, engine.state.gated, engine.state.alternatives, engine.state.running.values()):
        assert known.issuperset(where)
    for need, lacking in engine.state.lacking.items():
        assert lacking, f"an empty set of activations that lack {need} is kept"
        assert known.issuperset(lacking)
    for index, spikes in engine.state.live.items():
        assert spikes, f"an empty set of spikes of {engine.policy.signal_plans[index]} is kept"
        for spike in spikes:
            assert known.issuperset(spike.holders), f"{spike} has a holder that has ended: {list(spike.holders)}"
            signal = spike.signal
            assert (
                spike.holders or spike.in_halves or (signal.retain >= 0 and spike.born + signal.retain >= engine.now)
            ), f"{spike} is kept without a holder"
        assert len(spikes) <= engine.policy.signal_plans[index].limit
    entries = sum(len(spikes) * half.busy for half, spikes in engine.state.halves.items())
    assert engine.state.busy == entries + sum(not (a.clause.rule.background or a.clause.reflexive) for a in activations)
    for half, spikes in engine.state.halves.items():
        assert spikes, f"an empty table of {half} is kept"
        for spike in spikes:
            assert half in engine.state.halves_of(spike), f"{half} holds {spike}, which does not list the half"
            assert any(engine.state.keeps(need, spike) for need in half.needs), (
                f"{half} holds {spike}, which fits none of its needs"
            )
            assert spike in engine.state.live.get(spike.signal.index, ()), f"{half} holds {spike}, which is not live"


def untouched(play: Play) -> None:
    """Assert that a snapshot and the explanations of all rules change nothing (L25)."""
    state = play.engine.state
    tables = ("active", "live", "halves", "alternatives", "waiting", "asking", "dirty", "out", "values", "stirred")
    before = {name: repr(getattr(state, name)) for name in tables}
    counts = state.activations, state.spikes, state.groups, len(state.deadlines)
    snapshot(play.engine)
    for rule in play.engine.policy.rule_plans:
        explain(play.engine, rule)
    assert counts == (state.activations, state.spikes, state.groups, len(state.deadlines))
    after = {name: repr(getattr(state, name)) for name in tables}
    assert after == {**before, "values": after["values"]}


def bounded(play: Play) -> None:
    """Assert everything that must hold whenever the engine has settled."""
    untouched(play)
    consistent(play.engine)
    joined(play)
    waits_for_a_reason(play)
    engine = play.engine
    policy = engine.policy
    others = [one for each in stand_ins(engine.state).values() for one in each]
    activity = any(not (a.clause.rule.background or a.clause.reflexive) for a in (*play.active(), *others))
    assert engine.read(policy.slot_of["core:activity"].index) == activity, "core:activity has the wrong value"
    waits = (*engine.state.waiting, *engine.state.alternatives)
    pressure = any(not a.clause.reflexive for a in waits)
    assert engine.read(policy.slot_of["core:pressure"].index) == pressure, "core:pressure has the wrong value"
    for waiter in engine.state.gated:
        assert not all(g.predicate in PREDICATES.values() and _holds(engine, s, g) for s, g in waiter.clause.guards)


def _holds(engine: Any, slot: Any, guard: Any) -> bool:
    try:
        return bool(guard.predicate(engine.read(slot.index)))
    except (ValueError, KeyError):
        return False


def empty(play: Play) -> None:
    """Assert that the engine holds no object of a play any more (L23)."""
    engine = play.engine
    assert not engine.state.running, f"{engine.state.running} still run"
    for name in (
        "active",
        "live",
        "lacking",
        "gated",
        "waiting",
        "alternatives",
        "halves",
        "rows",
        "seats",
        "pools",
        "benches",
        "headless",
        "patience_ends",
        "asking",
        "dirty",
        "hoping",
        "hope_counts",
        "refused",
        "stuck",
        "watches",
        "watched_by",
        "errors",
        "out",
    ):
        assert not getattr(engine.state, name), f"{name} is not empty: {getattr(engine.state, name)}"
    assert engine.state.free.is_empty
    assert not engine.parts.agenda.queue.line
    assert not engine.parts.agenda.places
    assert engine.next_deadline() is None
    assert len(engine.state.deadlines) == 0
    assert engine.state.busy == 0
    slots = engine.policy.slot_of
    assert engine.read(slots["core:activity"].index) is False
    assert engine.read(slots["core:pressure"].index) is False
