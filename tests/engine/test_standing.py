"""`Standing` says which of two clauses goes first, now and later."""

from __future__ import annotations

from typing import Any

import pytest

import ravestate as rs
from laws.short import output, writer
from ravestate.engine.standing import Standing


def standing(ran: dict[int, float], now: float, **options: dict[str, Any]) -> tuple[Standing, list[Any]]:
    """Return a `Standing` at a time, and the clauses of rules with these options. All rules wait for one signal."""
    m = rs.Module("m")
    a, out = m.signal("a"), output(m)
    for name, given in options.items():
        writer(m, name, a, out, **given)
    policy = rs.compile(m)
    found = Standing(ran)
    found.now = now
    return found, [rule.clauses[0] for rule in policy.rule_plans]


def test_the_first_declared_of_equal_rules_goes_first() -> None:
    here, (one, other) = standing({}, 0.0, one={}, other={})
    assert here.is_ahead(one, other)
    assert not here.is_ahead(other, one)


def test_the_weight_decides_between_rules_with_a_utility_of_0() -> None:
    here, (one, other) = standing({}, 0.0, one={}, other={"weight": 2.0})
    assert here.is_ahead(other, one)
    assert not here.is_ahead(one, other)


def test_a_rule_worth_0_that_recovers_faster_is_not_behind_a_rule_declared_earlier() -> None:
    here, (slow, fast) = standing({0: 5.0, 1: 5.0}, 5.0, slow={"cooldown": 20.0}, fast={"cooldown": 5.0})
    assert not here.is_ahead(slow, fast)  # they are equal now, but not in the next moment
    assert not here.is_ahead(fast, slow)  # now, they are equal, and `slow` is declared first
    here.now = 6.0
    assert here.is_ahead(fast, slow)


def test_the_order_changes_at_the_time_of_the_crossing() -> None:
    here, (one, other) = standing({0: 0.0}, 1.0, one={"cooldown": 10.0, "weight": 2.0}, other={})
    assert here.is_ahead(other, one)
    assert here.crossing(one, other) == here.crossing(other, one) == pytest.approx(5.0)
    here.now = 5.0
    assert not here.is_ahead(other, one)
    here.now = 10.0
    assert here.is_ahead(one, other)


def test_at_the_rounded_time_of_a_crossing_the_order_has_changed() -> None:
    here, (one, other) = standing({0: 0.1}, 0.7, one={"cooldown": 0.9, "weight": 1.7}, other={"weight": 1.1})
    here.now = here.crossing(one, other)
    assert not here.is_ahead(other, one)


def test_a_rule_that_recovers_faster_from_0_overtakes_immediately() -> None:
    here, (slow, fast) = standing({0: 5.0, 1: 5.0}, 5.0, slow={"cooldown": 20.0}, fast={"cooldown": 5.0})
    assert here.overtakes(fast, slow)
    assert not here.overtakes(slow, fast)


def test_the_time_of_a_crossing_does_not_depend_on_when_it_is_computed() -> None:
    here, (one, other) = standing({0: 0.1, 1: 0.3}, 0.3, one={"cooldown": 9.0, "weight": 1.7}, other={"cooldown": 11.0})
    found: set[float] = set()
    for number in range(50):
        here.now = 0.3 + number / 997
        found.add(here.crossing(one, other))
        found.add(here.crossing(other, one))
    assert len(found) == 1, found


def test_a_rounding_error_does_not_prolong_a_cooldown() -> None:
    here, (one, other) = standing({1: 1.6}, 4.6, one={}, other={"cooldown": 3.0})  # 4.6 - 1.6 is less than 3.0
    assert here.recovery(other) == (1.0, 0.0)
    assert here.is_ahead(one, other)  # they are equal, and `one` is declared first
