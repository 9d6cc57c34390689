"""Conflicts (law L10): which rules exclude each other, for which causes, which rule wins, and by how much."""

import math

import pytest

import ravestate as rs


async def nothing(ctx: rs.RuleContext) -> None:
    pass


def talk() -> tuple[rs.Module, rs.Signal[None], rs.Signal[None], rs.Slot[str], rs.Slot[str]]:
    m = rs.Module("m")
    return m, m.signal("heard"), m.signal("question"), m.slot("out", ""), m.slot("face", "")


def test_the_more_specific_rule_wins_by_the_difference_of_utilities() -> None:
    m, heard, question, out, _ = talk()
    m.rule(when=heard, emits=question, name="classify")(nothing)
    m.rule(when=heard, writes=out, name="chat")(nothing)
    m.rule(when=question, writes=out, name="answer")(nothing)
    (conflict,) = rs.compile(m).conflicts()
    assert conflict.rules == ("m:chat", "m:answer")
    assert (conflict.slots, conflict.causes) == (("m:out",), ("m:heard",))
    assert (conflict.winner, conflict.tie) == ("m:answer", False)
    assert conflict.margin == pytest.approx(math.log(3))


def test_rules_of_different_slots_or_causes_do_not_conflict() -> None:
    m, heard, question, out, face = talk()
    m.rule(when=heard, writes=out, name="a")(nothing)
    m.rule(when=heard, writes=face, name="b")(nothing)
    m.rule(when=question, writes=out, name="c")(nothing)
    assert rs.compile(m).conflicts() == ()


def test_a_rule_that_writes_nothing_has_no_conflict() -> None:
    m, heard, *_ = talk()
    m.rule(when=heard, name="a")(nothing)
    m.rule(when=heard, name="b")(nothing)
    assert rs.compile(m).conflicts() == ()


def test_a_detached_constraint_is_not_a_cause_of_a_conflict() -> None:
    m, heard, question, out, _ = talk()
    m.rule(when=heard, writes=out, name="a")(nothing)
    m.rule(when=question & heard.detached(), writes=out, name="b")(nothing)
    assert rs.compile(m).conflicts() == ()


def test_equal_utilities_tie_and_the_first_declared_goes_first() -> None:
    m, heard, _, out, face = talk()
    m.rule(when=heard, writes=(out, face), name="a")(nothing)
    m.rule(when=heard, writes=(face, out), name="b")(nothing)
    (conflict,) = rs.compile(m).conflicts()
    assert (conflict.winner, conflict.margin, conflict.tie) == ("m:a", 0.0, True)
    assert conflict.slots == ("m:out", "m:face")


def test_a_weight_decides_even_between_rules_with_a_utility_of_0() -> None:
    m, heard, _, out, _ = talk()
    m.rule(when=heard, writes=out, name="a")(nothing)
    m.rule(when=heard, writes=out, weight=1.2, name="b")(nothing)
    (conflict,) = rs.compile(m).conflicts()
    assert (conflict.winner, conflict.tie) == ("m:b", False)


def test_conflicts_are_in_the_order_of_declaration() -> None:
    m, heard, _, out, _ = talk()
    for name in "abc":
        m.rule(when=heard, writes=out, name=name)(nothing)
    assert [c.rules for c in rs.compile(m).conflicts()] == [("m:a", "m:b"), ("m:a", "m:c"), ("m:b", "m:c")]


def test_a_rule_that_also_has_its_cause_as_a_detached_constraint_still_conflicts() -> None:
    """The spike of `question` is in the group of `heard`. An additional detached constraint does not change this."""
    m, heard, question, out, _ = talk()
    m.rule(when=heard, emits=question, name="classify")(nothing)
    m.rule(when=heard, writes=out, name="chat")(nothing)
    m.rule(when=question & heard.detached(), writes=out, name="answer")(nothing)
    (conflict,) = rs.compile(m).conflicts()
    assert (conflict.rules, conflict.causes) == (("m:chat", "m:answer"), ("m:heard",))


def test_the_causes_of_a_conflict_are_the_common_signals_of_the_pathways() -> None:
    m, heard, _, out, _ = talk()
    sources = [m.signal(f"s{number}") for number in range(400)]
    for source in sources:
        m.rule(when=source, emits=heard, name=f"from_{source.name[2:]}")(nothing)
    m.rule(when=heard, writes=out, name="chat")(nothing)
    m.rule(when=sources[-1], writes=out, name="last")(nothing)
    (conflict,) = rs.compile(m).conflicts()
    assert conflict.causes == ("m:s399",)
