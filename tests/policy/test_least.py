"""The search for the least pathway is exact on small policies, and quick on large policies."""

from __future__ import annotations

import random
from itertools import product
from math import log

import pytest
from hypothesis import given
from hypothesis import strategies as st

import ravestate as rs
from ravestate.policy.pathways import MAX_PATHWAYS


async def nothing(ctx: rs.RuleContext) -> None:
    pass


def signals(module: rs.Module, prefix: str, count: int, **options: bool) -> list[rs.Signal[None]]:
    return [module.signal(f"{prefix}{number}", **options) for number in range(count)]


def any_of(conditions: list[rs.Signal[None]]) -> rs.Condition:
    whole: rs.Condition = conditions[0]
    for condition in conditions[1:]:
        whole = whole | condition
    return whole


def all_of(conditions: list[rs.Signal[None]]) -> rs.Condition:
    whole: rs.Condition = conditions[0]
    for condition in conditions[1:]:
        whole = whole & condition
    return whole


# ------------------------------------------------------------------------------------------- size


@pytest.mark.parametrize("count", [10, 1000, 3000])
def test_the_least_pathway_is_found_in_a_ring_of_any_length(count: int) -> None:
    m = rs.Module("m")
    entry, ring = m.signal("entry"), signals(m, "s", count)
    m.rule(when=entry, emits=ring[0], name="enter")(nothing)
    for number in range(count):
        m.rule(when=ring[number], emits=ring[(number + 1) % count], name=f"r{number}")(nothing)
    policy = rs.compile(m)
    # Each signal of the ring is on pathways of all rules except one. The entry is on pathways of all rules.
    each = log((count + 1) / count)
    for number in (0, count // 2, count - 1):
        (clause,) = policy.clauses(f"m:r{number}")
        assert clause.utility == pytest.approx(each * (number + 1))
    # One pathway comes from the entry. The other goes round the ring, back to the first signal, where the cycle is cut.
    assert [len(pathway) for pathway in policy.clauses("m:r0")[0].pathways] == [2, count]


@pytest.mark.parametrize("count", [3, 10, 40])
def test_the_least_pathway_is_found_in_a_clique_of_any_size(count: int) -> None:
    m = rs.Module("m")
    entry, members = m.signal("entry"), signals(m, "s", count)
    m.rule(when=entry, emits=members, name="enter")(nothing)
    for number, member in enumerate(members):
        others = any_of([other for other in members if other is not member])
        m.rule(when=others, emits=member, name=f"r{number}")(nothing)
    policy = rs.compile(m)
    for clause in policy.clauses("m:r0"):
        # Only the member itself counts, because the entry is on all pathways.
        assert clause.utility == pytest.approx(log((count + 1) / count))
    assert policy.clauses("m:r0")[0].pathways[0] == {entry, members[1]}


def test_the_least_pathway_is_found_in_a_chain_of_any_length() -> None:
    m = rs.Module("m")
    chain = signals(m, "s", 2000)
    for number in reversed(range(1999)):  # so that effects are declared before their causes
        m.rule(when=chain[number], emits=chain[number + 1], name=f"r{number}")(nothing)
    policy = rs.compile(m)
    assert policy.utility("m:r0") == 0.0
    assert policy.utility("m:r1998") == pytest.approx(sum(log(1999 / n) for n in range(1, 2000)))
    assert policy.clauses("m:r1998")[0].pathways == (frozenset(chain[:-1]),)


def test_the_least_pathway_is_found_with_two_causes_at_each_step_of_a_chain() -> None:
    """There are about 2^60 pathways. One more rule has the first cause of each pair, so that cause is worth less."""
    m = rs.Module("m")
    firsts, seconds = signals(m, "a", 60), signals(m, "b", 60)
    for number in range(59):
        for cause in (firsts, seconds):
            for effect in (firsts, seconds):
                m.rule(
                    when=cause[number],
                    emits=effect[number + 1],
                    name=f"{cause[number].name[2:]}_{effect[number + 1].name[2:]}",
                )(nothing)
        m.rule(when=firsts[number].detached(), name=f"look{number}")(nothing)
    policy = rs.compile(m)
    (clause,) = policy.clauses("m:b58_b59")
    assert clause.pathways[0] == {*firsts[:58], seconds[58]}
    counts = _counts(policy)
    assert clause.utility == pytest.approx(
        sum(log(len(policy.rules) / counts[signal.name]) for signal in clause.pathways[0])
    )


def _counts(policy: rs.Policy) -> dict[str, int]:
    """Count, for each signal, the rules with this signal on a pathway. Walk from each rule back to its causes."""
    raisers: dict[str, list[str]] = {}
    for name, rule in policy.rules.items():
        for signal in rule.emits:
            raisers.setdefault(signal.name, []).append(name)
    found: dict[str, int] = {}
    for name in policy.rules:
        seen: set[str] = set()
        stack = [(need.signal.name, need.detached) for c in policy.rule_plan(name).clauses for need in c.needs]
        while stack:
            signal, detached = stack.pop()
            if signal in seen:
                continue
            seen.add(signal)
            if not detached:
                stack.extend(
                    (need.signal.name, need.detached)
                    for raiser in raisers.get(signal, ())
                    for c in policy.rule_plan(raiser).clauses
                    for need in c.needs
                )
        for signal in seen:
            found[signal] = found.get(signal, 0) + 1
    return found


def test_the_search_examines_independent_choices_one_by_one_and_not_in_all_combinations() -> None:
    m = rs.Module("m")
    wanted = signals(m, "x", 40)
    cheap: list[rs.Signal[None]] = []
    for number, signal in enumerate(wanted):
        causes = signals(m, f"i{number}_", 3)
        for place, cause in enumerate(causes):
            m.rule(when=cause, emits=signal, name=f"r{number}_{place}")(nothing)
        m.rule(when=causes[number % 3], name=f"hear{number}")(nothing)
        cheap.append(causes[number % 3])
    m.rule(when=all_of(wanted), name="all")(nothing)
    (clause,) = rs.compile(m).clauses("m:all")
    assert clause.pathways[0] == {*wanted, *cheap}
    assert len(clause.pathways) == MAX_PATHWAYS  # although there are 3^40 pathways


def test_the_search_in_a_torus_ends() -> None:
    """A torus is a grid whose rows and columns are rings. It has one input."""
    m = rs.Module("m")
    side = 12
    entry, nodes = m.signal("entry"), signals(m, "s", side * side)
    m.rule(when=entry, emits=nodes[0], name="enter")(nothing)
    for row, column in product(range(side), repeat=2):
        right, down = row * side + (column + 1) % side, (row + 1) % side * side + column
        m.rule(when=nodes[row * side + column], emits=(nodes[right], nodes[down]), name=f"r{row}_{column}")(nothing)
    policy = rs.compile(m)
    least = log((side * side + 1) / (side * side))
    for row, column in ((0, 0), (0, 3), (2, 2)):  # near the entry, the search finds the least pathway
        assert policy.utility(f"m:r{row}_{column}") == pytest.approx(least * (row + column + 1))
    for name in policy.rules:
        assert 0 <= policy.utility(name) <= least * side * side
    (clause,) = policy.clauses("m:r11_11")
    assert len(clause.pathways) == 1  # only the best pathway that the search found


# ------------------------------------------------------------------------------- small policies


@given(st.integers(0, 10_000))
def test_the_least_pathway_is_exact_even_if_signals_have_common_causes(seed: int) -> None:
    """This is a set-cover problem: seven signals, each with three causes, each of which needs some of six inputs."""
    dice = random.Random(seed)
    m = rs.Module("m")
    inputs, wanted = signals(m, "i", 6), signals(m, "x", 7)
    causes: list[set[frozenset[str]]] = []
    for number, signal in enumerate(wanted):
        drawn = [dice.sample(inputs, dice.randint(1, 3)) for _ in range(3)]
        causes.append({frozenset(s.name for s in some) for some in drawn})
        for place, some in enumerate(drawn):
            m.rule(when=all_of(some), emits=signal, name=f"r{number}_{place}")(nothing)
    for number, signal in enumerate(inputs):
        for place in range(dice.randint(0, 6)):
            m.rule(when=signal, name=f"hear{number}_{place}")(nothing)
    m.rule(when=all_of(wanted), name="all")(nothing)
    policy = rs.compile(m)
    information = {name: log(len(policy.rules) / count) for name, count in _counts(policy).items()}
    least = min(
        sum(information[name] for name in sorted(frozenset[str]().union(*chosen))) for chosen in product(*causes)
    )
    assert policy.utility("m:all") == pytest.approx(least + 7 * log(len(policy.rules)))
