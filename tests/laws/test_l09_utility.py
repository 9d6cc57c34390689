"""L9: utility is the self-information of the least pathway, times weight, times recovery.

`tests/policy/test_pathways.py` has the worked example.
"""

from math import log
from typing import Any

import pytest

import ravestate as rs
from laws.short import emitter, hearer, moments, output, writer


def effective(sim: Any, rule: str) -> float:
    return sim.explain(rule).clauses[0].effective


def test_a_signal_on_every_rules_pathway_is_worth_nothing() -> None:
    m = rs.Module("m")
    i, x = m.signal("i"), m.signal("x")
    emitter(m, "one", i, x)
    hearer(m, "two", x, x, [])
    hearer(m, "three", i, i, [])
    policy = rs.compile(m)
    assert policy.utility("m:one") == policy.utility("m:three") == 0.0
    assert policy.utility("m:two") == pytest.approx(log(3))


def test_a_signal_on_the_pathways_of_only_one_rule_is_worth_the_log_of_the_number_of_rules() -> None:
    m = rs.Module("m")
    signals = [m.signal(f"s{number}") for number in range(7)]
    for signal in signals:
        hearer(m, f"hear_{signal.name[-1]}", signal, signal, [])
    policy = rs.compile(m)
    assert [policy.utility(rule) for rule in policy.rules] == pytest.approx([log(7)] * 7)


def test_a_pathways_utility_is_the_sum_over_its_signals() -> None:
    m = rs.Module("m")
    a, b, c = m.signal("a"), m.signal("b"), m.signal("c")
    hearer(m, "abc", a & b & c, a, [])
    hearer(m, "ab", a & b, a, [])
    hearer(m, "a", a, a, [])
    hearer(m, "other", c, c, [])
    policy = rs.compile(m)
    on = {"a": 3, "b": 2, "c": 2}
    assert policy.utility("m:abc") == pytest.approx(sum(log(4 / on[s]) for s in "abc"))
    assert policy.utility("m:ab") == pytest.approx(sum(log(4 / on[s]) for s in "ab"))
    assert policy.utility("m:a") == pytest.approx(log(4 / 3))


def test_a_rule_counts_once_even_if_several_of_its_pathways_have_the_signal() -> None:
    m = rs.Module("m")
    i, j, x = m.signal("i"), m.signal("j"), m.signal("x")
    emitter(m, "one", i, x)
    emitter(m, "two", j, x)
    hearer(m, "hear", x & i | x & j | x, x, [])
    hearer(m, "other", m.signal("z"), x, [])
    policy = rs.compile(m)
    # x is only on pathways of `hear`, i on pathways of `hear` and `one`, and j on pathways of `hear` and `two`
    assert policy.clauses("m:hear")[2].utility == pytest.approx(log(4 / 1) + log(4 / 2))


def test_the_utility_of_a_clause_is_the_least_among_its_pathways() -> None:
    m = rs.Module("m")
    rare, common, x = m.signal("rare"), m.signal("common"), m.signal("x")
    emitter(m, "one", rare, x)
    emitter(m, "two", common, x)
    hearer(m, "three", common, common, [])
    hearer(m, "hear", x, x, [])
    policy = rs.compile(m)
    # of the 4 rules, 2 have `rare` on their pathways, 3 have `common`, and 1 has `x`
    assert policy.utility("m:hear") == pytest.approx(log(4) + log(4 / 3))


def test_the_utility_of_a_rule_is_the_greatest_over_its_clauses() -> None:
    m = rs.Module("m")
    a, b = m.signal("a"), m.signal("b")
    hearer(m, "either", a | b, a, [])
    hearer(m, "other", a, a, [])
    policy = rs.compile(m)
    assert [clause.utility for clause in policy.clauses("m:either")] == pytest.approx([0.0, log(2)])
    assert policy.utility("m:either") == pytest.approx(log(2))


def test_a_predicate_adds_the_log_of_two() -> None:
    m = rs.Module("m")
    a, b, mood = m.signal("a"), m.signal("b"), m.slot("mood", "")
    hearer(m, "plain", a, a, [])
    hearer(m, "where", a.where(bool), a, [])
    hearer(m, "holds", a & mood.holds(bool), a, [])
    hearer(m, "all_of_them", a.where(bool).where(callable) & mood.holds(bool) & b, a, [])
    policy = rs.compile(m)
    assert policy.utility("m:plain") == 0.0
    assert policy.utility("m:where") == pytest.approx(log(2))
    assert policy.utility("m:holds") == pytest.approx(log(2))
    assert policy.utility("m:all_of_them") == pytest.approx(log(4) + 3 * log(2))


def test_weight_multiplies_utility(play: Any) -> None:
    m = rs.Module("m")
    a, out = m.signal("a"), output(m)
    hearer(m, "other", m.signal("b"), a, [])
    writer(m, "light", a, out, weight=0.5)
    writer(m, "heavy", a, out, weight=3.0)
    with play(m) as sim:
        assert effective(sim, "m:light") == pytest.approx(0.5 * log(3 / 2))
        assert effective(sim, "m:heavy") == pytest.approx(3.0 * log(3 / 2))
        sim.emit(a)
        assert sim.fired == ["m:heavy"]


def test_utility_recovers_linearly_over_the_cooldown(play: Any) -> None:
    m = rs.Module("m")
    a, out = m.signal("a"), output(m)
    hearer(m, "other", m.signal("b"), a, [])
    writer(m, "rest", a, out, cooldown=8.0, weight=2.0)
    full = 2.0 * log(2)
    with play(m) as sim:
        assert effective(sim, "m:rest") == pytest.approx(full)
        sim.advance(1.0)
        sim.emit(a)
        assert effective(sim, "m:rest") == 0.0
        for eighth in range(1, 9):
            sim.advance(1.0)
            assert effective(sim, "m:rest") == pytest.approx(full * eighth / 8)
        sim.advance(100.0)
        assert effective(sim, "m:rest") == pytest.approx(full)


def test_a_recovering_rule_still_runs_if_nothing_competes_with_it(play: Any) -> None:
    m = rs.Module("m")
    a, out = m.signal("a"), output(m)
    writer(m, "rest", a, out, cooldown=8.0)
    with play(m) as sim:
        sim.emit(a)
        sim.emit(a)
        assert moments(sim, out) == [(0.0, "rest")] * 2


def test_a_weaker_rule_wins_while_the_stronger_one_recovers(play: Any) -> None:
    m = rs.Module("m")
    a, out = m.signal("a"), output(m)
    writer(m, "weak", a, out)
    writer(m, "strong", a, out, weight=2.0, cooldown=10.0)
    with play(m) as sim:
        for _ in range(4):
            sim.emit(a)
            sim.advance(4.0)
        # the weight of `strong` is 0.8 at 4 s and 1.6 at 8 s; at 12 s it is 0.8 again, because `strong` ran at 8 s
        assert moments(sim, out) == [(0.0, "strong"), (4.0, "weak"), (8.0, "strong"), (12.0, "weak")]
