"""In the description of a policy, the parts of a utility add up, and signals and slots name the rules that use them."""

import math

import pytest

import ravestate as rs
from board.looking import gossip
from modules.platform.webio.visit import parrot
from ravestate.board.description import describe
from ravestate.modules import agenda, emotion, fillers, hibye, idle


def test_the_terms_and_predicates_of_each_clause_add_up_to_its_utility() -> None:
    policy = rs.compile(gossip, parrot, idle, hibye, fillers, emotion, agenda)
    found = describe(policy)
    clauses = [clause for rule in found.rules for clause in rule.clauses]
    assert any(clause.predicates for clause in clauses)
    for clause in clauses:
        total = sum(term.nats for term in clause.terms) + clause.predicates * math.log(2)
        assert total == pytest.approx(clause.utility)
        for term in clause.terms:
            assert term.nats == pytest.approx(-math.log(term.rules / len(found.rules)))


def test_signals_and_slots_name_the_rules_that_use_them() -> None:
    found = describe(rs.compile(gossip, parrot))
    (question,) = [signal for signal in found.signals if signal.name == "gossip:question"]
    (output,) = [slot for slot in found.slots if slot.name == "rawio:output"]
    (said,) = [signal for signal in found.signals if signal.name == "rawio:input:changed"]
    assert (question.hearers, question.raisers, question.input) == (
        ("gossip:answer",),
        ("gossip:classify",),
        False,
    )
    assert {"gossip:answer", "gossip:talk", "parrot:repeat"} <= set(output.writers)
    assert said.input
    rule = found.rule("gossip:classify")
    assert rule is not None
    assert rule.doc == "Classify an input as a question or something else."
    assert found.rule("gossip:nobody") is None


def test_types_are_named_as_they_were_declared() -> None:
    m = rs.Module("m")
    m.slot("one", [], type=list[int])
    m.slot("two", "", type=str)
    m.slot("three", None)
    m.signal("four", payload=dict[str, int])
    found = describe(rs.compile(m))
    assert [slot.type for slot in found.slots if slot.module == "m"] == ["list[int]", "str", ""]
    assert [signal.payload for signal in found.signals if signal.name == "m:four"] == ["dict[str, int]"]
