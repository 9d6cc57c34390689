"""L4: a constraint is a signal with ages, `detached` and payload predicates. Slot predicates only gate a rule."""

from typing import Any

import pytest

import ravestate as rs
from laws.short import at_rest, given_up, hearer, moments, output, started, writer
from ravestate.testing import simulate


def pair(condition: Any) -> tuple[rs.Module, rs.Signal[Any], rs.Signal[Any], rs.Slot[Any]]:
    """Declare a rule on two signals; `condition` combines them."""
    m = rs.Module("m")
    a, b, out = m.signal("a", payload=object), m.signal("b", payload=object), output(m)
    writer(m, "both", condition(a, b), out)
    return m, a, b, out


def test_by_default_a_spike_counts_from_its_birth(play: Any) -> None:
    m, a, b, out = pair(lambda a, b: a & b)
    with play(m) as sim:
        sim.advance(1.0)
        sim.emit(a)
        sim.emit(b)
        assert moments(sim, out) == [(1.0, "both")]


@pytest.mark.parametrize(("delay", "fires"), [(4.999, True), (5.0, False), (5.001, False)])
def test_by_default_a_spike_counts_for_five_seconds(play: Any, delay: float, fires: bool) -> None:
    m, a, b, out = pair(lambda a, b: a & b)
    with play(m) as sim:
        sim.emit(a)
        sim.advance(delay)
        sim.emit(b)
        assert bool(moments(sim, out)) is fires


@pytest.mark.parametrize(("delay", "fires"), [(0.2, True), (0.3, False), (2.0, False)])
def test_max_age_limits_how_long_a_spike_counts(play: Any, delay: float, fires: bool) -> None:
    m, a, b, out = pair(lambda a, b: a.max_age(0.3) & b)
    with play(m) as sim:
        sim.emit(a)
        sim.advance(delay)
        sim.emit(b)
        assert bool(moments(sim, out)) is fires


def test_max_age_none_lets_a_spike_count_for_ever(play: Any) -> None:
    m, a, b, out = pair(lambda a, b: a.max_age(None) & b)
    with play(m) as sim:
        sim.emit(a)
        sim.advance(1e6)
        sim.emit(b)
        assert moments(sim, out) == [(1e6, "both")]


def test_with_min_age_a_spike_counts_from_exactly_this_age(play: Any) -> None:
    m, a, _, out = pair(lambda a, b: a.min_age(2.0))
    with play(m) as sim:
        sim.advance(0.5)
        sim.emit(a)
        sim.advance(1.999)
        assert moments(sim, out) == []
        sim.advance(10.0)
        assert moments(sim, out) == [(2.5, "both")]


def test_an_age_can_come_from_a_setting() -> None:
    class Settings(rs.Settings):
        wait: float = 2.0

    m = rs.Module("m", settings=Settings)
    a, out = m.signal("a"), m.slot("out", 0)
    writer(m, "by_class", a.min_age(Settings.wait), out)
    writer(m, "by_name", a.min_age(rs.setting("wait")), m.slot("other", ""))
    policy = rs.compile(m)
    for settings, wait in ((None, 2.0), ({"m": {"wait": 3.5}}, 3.5)):
        with simulate(policy, settings=settings) as sim:
            sim.emit(a)
            sim.advance(10.0)
            assert started(sim) == [(wait, "by_class"), (wait, "by_name")]


def test_a_payload_counts_only_if_the_where_predicate_is_true_for_it(play: Any) -> None:
    m, a, _, out = pair(lambda a, b: a.where(lambda n: n > 1).where(lambda n: n < 4))
    with play(m) as sim:
        for number in range(6):
            sim.advance(1.0)
            sim.emit(a, number)
        assert moments(sim, out) == [(3.0, "both"), (4.0, "both")]


def test_a_constraint_with_a_where_predicate_waits_for_a_payload_that_fits(play: Any) -> None:
    m, a, b, out = pair(lambda a, b: a.where(bool) & b)
    with play(m) as sim:
        sim.emit(b)
        sim.emit(a, 0)
        assert moments(sim, out) == []
        sim.emit(a, 1)
        assert moments(sim, out) == [(0.0, "both")]


def test_a_predicate_that_raises_is_an_error_of_its_rule_and_does_not_match(play: Any) -> None:
    m, a, _, out = pair(lambda a, b: a.where(lambda n: 1 / n > 0))
    writer(m, "other", a, output(m, "face"))
    with play(m) as sim:
        sim.emit(a, 0)
        assert [rule for rule, _ in sim.failures] == ["m:both"]
        assert sim.fired == ["m:other"]
        sim.emit(a, 1)
        assert moments(sim, out) == [(0.0, "both")]


def test_after_a_false_predicate_in_an_until_condition_no_later_predicate_is_called(play: Any) -> None:
    m = rs.Module("m")
    a, b = m.signal("a"), m.signal("b")
    writer(m, "long", a, output(m), after=1.0, until=b.where(lambda n: n is not None).where(lambda n: n > 0))
    with play(m) as sim:
        sim.emit(a)
        sim.emit(b, None)
        sim.advance(2.0)
        assert sim.failures == []
        assert sim.fired == ["m:long"]


def test_predicates_that_raise_are_reported_in_the_order_of_their_rules(play: Any) -> None:
    m = rs.Module("m")
    a, b = m.signal("a"), m.signal("b")

    def shared(n: float) -> bool:
        return 1 / n > 0

    writer(m, "pair", a.where(shared) & b, output(m, "one"))
    writer(m, "other", a.where(lambda n: 1 / n > 0) & b, output(m, "two"))
    writer(m, "single", a.where(shared).where(bool), output(m, "three"))
    with play(m) as sim:
        sim.emit(a, 0)
        assert [rule for rule, _ in sim.failures] == ["m:pair", "m:other"]


def gated() -> tuple[rs.Module, rs.Signal[Any], rs.Slot[Any], rs.Slot[Any]]:
    m = rs.Module("m")
    a, mood, out = m.signal("a"), m.slot("mood", "calm"), output(m)
    writer(m, "gated", a & mood.holds(lambda value: value == "merry"), out)
    return m, a, mood, out


def test_a_rule_fires_only_while_its_holds_predicate_is_true(play: Any) -> None:
    m, a, mood, out = gated()
    with play(m) as sim:
        sim.emit(a)
        assert moments(sim, out) == []
        sim.advance(6.0)
        sim.put(mood, "merry")
        assert moments(sim, out) == []  # a predicate is not a spike, so its change fires no rule
        assert at_rest(sim)
        sim.emit(a)
        assert moments(sim, out) == [(6.0, "gated")]


def test_a_rule_whose_gate_opens_in_time_fires_at_that_moment(play: Any) -> None:
    m, a, mood, out = gated()
    with play(m) as sim:
        sim.emit(a)
        sim.advance(3.0)
        sim.put(mood, "merry")
        assert moments(sim, out) == [(3.0, "gated")]


def test_an_activation_whose_gate_is_closed_is_not_ready_and_its_spikes_age(play: Any) -> None:
    m, a, _, _ = gated()
    with play(m) as sim:
        sim.emit(a)
        sim.advance(4.9)
        assert given_up(sim, "gated") == []
        sim.advance(0.1)
        assert given_up(sim, "gated") == [(5.0, "a", "age")]


def test_a_detached_constraint_only_looks(play: Any) -> None:
    m = rs.Module("m")
    a, out, heard = m.signal("a"), output(m), list[Any]()
    writer(m, "act", a, out)
    hearer(m, "look", a.detached(), a, heard)
    with play(m) as sim:
        sim.emit(a, 1)
        assert (heard, moments(sim, out)) == ([1], [(0.0, "act")])


def test_options_of_a_constraint_add_up_and_do_not_change_the_signal() -> None:
    m = rs.Module("m")
    a = m.signal("a")
    constraint = a.min_age(1.0).max_age(None).detached().where(bool)
    assert (constraint.min_age_, constraint.max_age_, constraint.is_detached) == (1.0, None, True)
    assert constraint.predicates == (bool,)
    assert rs.Constraint(a).max_age_ == 5.0
    with pytest.raises(rs.DeclarationError, match="'soon'"):
        a.min_age("soon")  # type: ignore[arg-type]
