"""The disjunctive normal form (law L5) keeps declaration order, has no duplicates, and has a limit."""

import pytest

import ravestate as rs
from ravestate.declare.condition import AllOf, AnyOf
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
def test_clauses_are_in_declaration_order_without_duplicates(condition: rs.Condition, clauses: list[str]) -> None:
    assert forms(condition) == clauses


def test_a_bare_signal_becomes_a_constraint() -> None:
    assert normal_form(a) == normal_form(a.min_age(0))


def pairs(count: int) -> rs.Condition:
    module = rs.Module("many")
    signals = [module.signal(f"s{number}") for number in range(2 * count)]
    condition: rs.Condition = signals[0] | signals[1]
    for number in range(1, count):
        condition = condition & (signals[2 * number] | signals[2 * number + 1])
    return condition


@pytest.mark.parametrize(("count", "alternatives"), [(9, "512"), (20, "1048576"), (20_000, "more than 10\\^6020")])
def test_too_many_clauses_are_refused_before_they_are_made(count: int, alternatives: str) -> None:
    with pytest.raises(
        rs.DeclarationError,
        match=f"condition has {alternatives} alternatives, more than 256: move a part of it to a rule that emits a signal",
    ):
        normal_form(pairs(count))


def test_the_greatest_number_of_clauses_is_allowed() -> None:
    assert len(normal_form(pairs(8))) == MAX_CLAUSES == 256


def test_a_part_with_too_many_clauses_is_refused() -> None:
    with pytest.raises(rs.DeclarationError, match="condition has a part that has 512 alternatives"):
        normal_form(a & pairs(9) | b)


def test_a_part_that_occurs_many_times_is_expanded_once() -> None:
    condition: rs.Condition = a
    for _ in range(60):
        condition = condition & b | condition & c
    with pytest.raises(rs.DeclarationError, match="alternatives, more than 256"):
        normal_form(condition)


def test_a_condition_of_any_depth_has_a_normal_form() -> None:
    module = rs.Module("deep")
    signals = [module.signal(f"s{number}") for number in range(2000)]
    nested: rs.Condition = signals[0]
    for signal in signals[1:]:
        nested = signal & nested
    (one,) = normal_form(nested)
    assert [c.signal for c in one.constraints] == signals[:0:-1] + signals[:1]
    layers: rs.Condition = signals[0]
    for signal in signals[1:]:
        layers = AllOf((signal, AnyOf((layers,))))
    assert normal_form(layers) == normal_form(nested)
    assert repr(AnyOf((layers, a))).count("(") == 1999


def test_a_part_must_be_a_condition() -> None:
    with pytest.raises(rs.DeclarationError, match="'a' is not a condition: combine signals with & and"):
        normal_form("a")
