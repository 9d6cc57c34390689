"""Disjunctive normal form (L5): in declaration order, without doubles, bounded."""

import pytest

import ravestate as rs
from ravestate.policy.clauses import MAX_CLAUSES, normal_form

demo = rs.Module("demo")
a, b, c, d = (demo.signal(name) for name in "abcd")
mood = demo.slot("mood")


def forms(condition: rs.Condition) -> list[str]:
    return [" ".join(str(part) for part in (*c.constraints, *c.guards)) for c in normal_form(condition)]


@pytest.mark.parametrize(
    ("condition", "clauses"),
    [
        (a, ["demo:a"]),
        (a & b, ["demo:a demo:b"]),
        (b | a, ["demo:b", "demo:a"]),
        (c & (b | a), ["demo:c demo:b", "demo:c demo:a"]),
        ((a | b) & (c | d), ["demo:a demo:c", "demo:a demo:d", "demo:b demo:c", "demo:b demo:d"]),
        ((a | b & c) & d, ["demo:a demo:d", "demo:b demo:c demo:d"]),
        (a & a, ["demo:a"]),
        (a | a, ["demo:a"]),
        (a | b | a, ["demo:a", "demo:b"]),
        (a & a.min_age(2), ["demo:a demo:a.min_age(2.0)"]),
        (a | a.detached(), ["demo:a", "demo:a.detached()"]),
        (mood.holds(bool) & a & mood.holds(bool), ["demo:a demo:mood.holds(bool)"]),
    ],
)
def test_clauses_stand_in_declaration_order_without_doubles(
    condition: rs.Condition, clauses: list[str]
) -> None:
    assert forms(condition) == clauses


def test_a_signal_is_its_own_constraint() -> None:
    assert normal_form(a) == normal_form(a.min_age(0))


def pairs(count: int) -> rs.Condition:
    module = rs.Module("many")
    signals = [module.signal(f"s{number}") for number in range(2 * count)]
    condition: rs.Condition = signals[0] | signals[1]
    for number in range(1, count):
        condition = condition & (signals[2 * number] | signals[2 * number + 1])
    return condition


def test_too_many_clauses_are_refused_before_they_are_made() -> None:
    assert len(normal_form(pairs(8))) == MAX_CLAUSES == 256
    with pytest.raises(
        rs.DeclarationError, match="has 512 alternatives, more than 256: raise a signal of its own"
    ):
        normal_form(pairs(60))


def test_what_is_no_condition_is_refused() -> None:
    with pytest.raises(rs.DeclarationError, match="'a' is no condition: combine signals with & and"):
        normal_form("a")
