"""Utilities: the paper's worked example to six decimals, and random policies against a simple form of the laws."""

from __future__ import annotations

from itertools import product
from math import log
from typing import Any

import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

import ravestate as rs
from ravestate.modules import rawio
from ravestate.testing import simulate

# ------------------------------------------------------------------------------- the worked example


def worked_example() -> rs.Module:
    m = rs.Module("m", requires=[rawio])
    heard = rawio.input.changed
    face = m.slot("face", "", always=True)
    raised: dict[str, rs.Signal[Any]] = {}

    def classifier(name: str, signal: str, words: tuple[str, ...]) -> None:
        raised[signal] = m.signal(signal)

        @m.rule(when=heard, emits=raised[signal], name=name)
        async def classify(ctx: rs.RuleContext) -> None:
            if any(word in ctx.payload(heard) for word in words):
                ctx.emit(raised[signal])

    def writer(name: str, when: rs.Condition, slot: rs.Slot[Any]) -> None:
        @m.rule(when=when, writes=slot, name=name)
        async def write(ctx: rs.RuleContext) -> None:
            ctx[slot] = name

    classifier("Question", "question", ("?",))
    classifier("AboutAgent", "about_agent", ("you",))
    classifier("Games", "games", ("games",))
    writer("Wildtalk", heard, rawio.output)
    writer("Qa", raised["question"], rawio.output)
    writer("Shy", raised["about_agent"], face)
    writer("PersonalQa", raised["question"] & raised["about_agent"], rawio.output)
    writer("OfferGames", raised["question"] & raised["games"], rawio.output)
    return m


@pytest.mark.parametrize(
    ("rule", "utility"),
    [
        ("Wildtalk", 0.0), ("Qa", 0.980829), ("Shy", 1.386294), ("PersonalQa", 2.367124), ("OfferGames", 3.060271),
        ("Question", 0.0), ("AboutAgent", 0.0), ("Games", 0.0),
    ],
)  # fmt: skip
def test_the_utilities_of_the_worked_example_are_exact_to_six_decimals(rule: str, utility: float) -> None:
    policy = rs.compile(worked_example())
    assert len(policy.rules) == 8
    assert round(policy.utility(f"m:{rule}"), 6) == utility


@pytest.mark.parametrize(
    ("text", "said", "face"),
    [
        ("Do you like games?", ["OfferGames"], "Shy"),
        ("How are you?", ["PersonalQa"], "Shy"),
        ("What time is it?", ["Qa"], ""),
        ("I see you.", ["Wildtalk"], "Shy"),
        ("Nice weather.", ["Wildtalk"], ""),
    ],
)
def test_the_rule_with_the_greatest_utility_speaks_in_the_worked_example(text: str, said: list[str], face: str) -> None:
    m = worked_example()
    with simulate(m) as sim:
        sim.say(text)
        sim.advance(10.0)
        assert sim.said == said
        assert sim.read(m.slots[0]) == face


# ------------------------------------------------------------- a simple version of L8 and L9, on random policies

Constraint = tuple[str, bool, int]
"""A signal's name, whether the constraint is detached, and its number of predicates."""


class Sketch:
    """A rule of a random policy, as plain data."""

    def __init__(self, clauses: list[list[Constraint]], gates: list[int], causes: set[str], detached: bool) -> None:
        self.clauses = clauses
        self.gates = gates  # for each clause: how many predicates on slots it has
        self.causes = causes  # signals that the rule may cause (L7)
        self.detached = detached


Pathway = frozenset[str]


def completions(signal: str, way: Pathway, rules: list[Sketch], inputs: set[str]) -> set[Pathway]:
    """Return the completions of a signal: the signal and, recursively, its causes, once for each way to cause it (L8).

    `way` has the signals between the clause and `signal`. If `signal` is already in `way`, the cycle is cut.
    """
    if signal in way:
        return {frozenset()}
    causes = [clause for rule in rules if signal in rule.causes and not rule.detached for clause in rule.clauses]
    found: set[Pathway] = set()
    if signal in inputs or not causes:
        found.add(frozenset({signal}))
    for clause in causes:
        found |= {
            union | {signal} for union in pathways([c for c in clause if not c[1]], way | {signal}, rules, inputs)
        }
    return found


def pathways(clause: list[Constraint], way: Pathway, rules: list[Sketch], inputs: set[str]) -> set[Pathway]:
    """Return the pathways of a clause. A pathway combines one completion of each non-detached constraint."""
    choices = [
        {frozenset({signal})} if detached else completions(signal, way, rules, inputs) for signal, detached, _ in clause
    ]
    return {frozenset[str]().union(*chosen) for chosen in product(*choices)}


def utilities(rules: list[Sketch], inputs: set[str]) -> list[list[tuple[set[Pathway], float]]]:
    """Return the pathways and the utility of each clause of each rule (L9)."""
    found = [[pathways(clause, frozenset(), rules, inputs) for clause in rule.clauses] for rule in rules]

    def information(signal: str) -> float:
        on = sum(any(signal in pathway for clause in rule for pathway in clause) for rule in found)
        return -log(on / len(rules))

    return [
        [
            (
                clause,
                min(sum(information(signal) for signal in pathway) for pathway in clause)
                + log(2) * (gates + sum(predicates for _, _, predicates in constraints)),
            )
            for clause, constraints, gates in zip(of_rule, rule.clauses, rule.gates, strict=True)
        ]
        for of_rule, rule in zip(found, rules, strict=True)
    ]


class World:
    """A random policy, and the sketches of its rules."""

    def __init__(self, data: st.DataObject) -> None:
        draw = data.draw
        m = self.module = rs.Module("m")
        flags = draw(st.lists(st.booleans(), min_size=3, max_size=6), label="signals: input=")
        signals = [m.signal(f"s{n}", input=given) for n, given in enumerate(flags)]
        flags = draw(st.lists(st.booleans(), min_size=1, max_size=3), label="slots: input=")
        slots = [m.slot(f"v{n}", 0, input=given) if n else m.flag("v0", input=given) for n, given in enumerate(flags)]
        heard = [*signals, *(signal for slot in slots for signal in slot.signals)]
        self.rules: list[Sketch] = []
        raised: set[str] = set()
        for number in range(draw(st.integers(1, 6), label="rules")):
            atoms = st.tuples(st.integers(0, len(heard) - 1), st.integers(0, 3), st.integers(0, 2))
            clause = st.lists(atoms, min_size=1, max_size=3, unique_by=lambda atom: atom[0])
            several = st.lists(clause, min_size=1, max_size=2, unique_by=lambda one: frozenset(a[0] for a in one))
            drawn = draw(several, label=f"clauses of r{number}")
            emits = draw(st.sets(st.integers(0, len(signals) - 1), max_size=2), label="emits")
            writes = draw(st.sets(st.integers(0, len(slots) - 1), max_size=1), label="writes")
            detached = draw(st.integers(0, 4), label="detached if 0") == 0
            gates = [draw(st.integers(0, 1), label="gates") for _ in drawn]
            clauses: list[list[Constraint]] = []
            conditions: list[rs.Condition] = []
            for atoms_, gate in zip(drawn, gates, strict=True):
                clauses.append([(heard[n].name, look == 0, tests) for n, look, tests in atoms_])
                parts = [constrained(heard[n], look == 0, tests) for n, look, tests in atoms_]
                if gate:
                    parts.append(slots[0].holds(lambda value: value))
                conditions.append(joined(parts, "&"))
            causes = {signals[n].name for n in emits} | {s.name for n in writes for s in slots[n].signals}
            self.rules.append(Sketch(clauses, gates, causes, detached))
            raised |= causes
            self.declare(
                number,
                joined(conditions, "|"),
                [signals[n] for n in emits],
                [slots[n] for n in writes],
                detached,
            )
        self.inputs = {s.name for s in heard if s.input or s.name not in raised}

    def declare(self, number: int, when: rs.Condition, emits: list[Any], writes: list[Any], detached: bool) -> None:
        @self.module.rule(when=when, emits=emits, writes=writes, detached=detached, name=f"r{number}")
        async def nothing(ctx: rs.RuleContext) -> None: ...


def constrained(signal: rs.Signal[Any], detached: bool, predicates: int) -> rs.Condition:
    constraint = signal.min_age(0.0)
    for _ in range(predicates):
        constraint = constraint.where(lambda payload: payload)
    return constraint.detached() if detached else constraint


def joined(parts: list[rs.Condition], operator: str) -> rs.Condition:
    whole, *others = parts
    for part in others:
        whole = whole & part if operator == "&" else whole | part
    return whole


@given(st.data())
def test_pathways_and_utilities_of_random_policies_follow_the_laws(data: st.DataObject) -> None:
    world = World(data)
    try:
        policy = rs.compile(world.module)
    except rs.DeclarationErrors as faults:
        assert all("unreachable" in str(fault) for fault in faults.exceptions), faults
        assume(False)
        return
    expected = utilities(world.rules, world.inputs)
    assume(max(len(found) for rule in expected for found, _ in rule) <= 100)  # so the policy has dropped no pathway
    for number, of_rule in enumerate(expected):
        clauses = policy.clauses(f"m:r{number}")
        assert len(clauses) == len(of_rule)
        for clause, (found, utility) in zip(clauses, of_rule, strict=True):
            assert {frozenset(signal.name for signal in pathway) for pathway in clause.pathways} == found
            assert clause.utility == pytest.approx(utility, abs=1e-9)
        assert policy.utility(f"m:r{number}") == pytest.approx(max(u for _, u in of_rule), abs=1e-9)
