"""An explanation has the exact end of a wait and the exact lead of a rival, even if there are many rules."""

from __future__ import annotations

from typing import Any

import pytest

import ravestate as rs
from engine.test_halves import declared, runs
from ravestate.engine.engine import Engine
from ravestate.engine.events import AddRule, Emit, Finish
from ravestate.engine.explain import ActivationState, explain
from ravestate.engine.trace import Record, Waits


def alive(engine: Engine, rule: str) -> ActivationState:
    """Return the rule's only live activation."""
    [activation] = explain(engine, engine.policy.rule_plan(rule)).activations
    return activation


def test_the_end_of_a_wait_does_not_change_when_the_best_rival_resigns() -> None:
    m = rs.Module("m")
    heard, out = m.signal("heard"), m.slot("out", "")
    topics = [m.signal(f"topic{n}") for n in range(4)]
    for n, topic in enumerate(topics):
        declared(m, f"about{n}", when=heard & topic, writes=out)
    declared(m, "fallback", when=heard, writes=out)
    engine = Engine(rs.compile(m))
    assert not runs(engine, Emit("m:heard"), end=False)
    for n in range(3):
        [run] = runs(engine, Emit(f"m:topic{n}"), now=0.1, end=False)
        engine.receive(Finish(run.run, "resigned"), 0.1)
        assert not runs(engine, now=0.1, end=False)
        waits = alive(engine, "m:fallback")
        assert {rule for rule, _ in waits.waits_for} == {f"m:about{k}" for k in range(n + 1, 4)}
        assert waits.until == 1.0


def test_the_lead_of_a_rival_is_the_lead_of_its_competing_clause() -> None:
    m = rs.Module("m")
    heard, hint, other, out = m.signal("heard"), m.signal("hint"), m.signal("other"), m.slot("out", "")
    declared(m, "two", when=(heard & hint) | other.where(bool).where(callable), writes=out)
    declared(m, "fallback", when=heard, writes=out)
    engine = Engine(rs.compile(m))
    assert not runs(engine, Emit("m:heard"))
    mine, theirs = (engine.policy.rule_plan(f"m:{rule}").clauses[0].utility for rule in ("fallback", "two"))
    best = engine.policy.rule_plan("m:two").clauses[1].utility
    assert best > theirs
    assert alive(engine, "m:fallback").waits_for == (("m:two", pytest.approx(theirs - mine)),)


def test_a_rival_that_only_its_weight_puts_ahead_has_no_lead_in_utility() -> None:
    m = rs.Module("m")
    go, out = m.signal("go"), m.slot("out", "")
    declared(m, "first", when=go, writes=out)
    declared(m, "heavy", when=go.min_age(1), writes=out, weight=1.2)
    engine = Engine(rs.compile(m))
    assert not runs(engine, Emit("m:go"))
    assert alive(engine, "m:first").waits_for == (("m:heavy", 0.0),)
    assert str(explain(engine, engine.policy.rule_plan("m:first"))).endswith("\n    waits for m:heavy")


@pytest.mark.parametrize("traced", [False, True])
def test_a_rule_that_waits_behind_another_rule_also_names_the_rivals_of_that_rule(traced: bool) -> None:
    m = rs.Module("m")
    heard, out = m.signal("heard"), m.slot("out", "")
    declared(m, "topic", when=heard & m.signal("topic"), writes=out)
    for n in range(3):
        declared(m, f"fallback{n}", when=heard, writes=out, cooldown=5.0)
    engine = Engine(rs.compile(m))
    records: list[Record] = []
    engine.tracer = records.append if traced else None
    assert not runs(engine, Emit("m:heard"))
    for n in range(1, 3):
        names = [rule for rule, _ in alive(engine, f"m:fallback{n}").waits_for]
        assert names == ["m:topic", "m:fallback0"]
    told = {record.rule: record.for_ for record in records if isinstance(record, Waits)}
    assert not traced or told == {
        "m:fallback0": ("m:topic",),
        **{f"m:fallback{n}": ("m:topic", "m:fallback0") for n in range(1, 3)},
    }


def test_an_added_rule_with_a_detached_constraint_sets_no_deadline_for_earlier_spikes() -> None:
    m = rs.Module("m")
    a, b = m.signal("a"), m.signal("b")
    declared(m, "both", when=b & a.detached())
    engine = Engine(rs.compile(m))
    assert not runs(engine, Emit("m:a"))
    due = engine.next_deadline()

    @m.rule(when=a.detached().min_age(2.0))
    async def later(ctx: Any) -> None:
        """A rule that can look only at spikes that occur from now on."""

    engine.receive(AddRule(engine.policy.with_rule(later)), 0.0)
    assert not runs(engine)
    assert engine.next_deadline() == due


def test_an_explanation_says_which_missing_signal_is_an_input() -> None:
    m = rs.Module("m")
    heard, topic, out = m.signal("heard"), m.signal("topic"), m.slot("out", "")
    declared(m, "classifier", when=heard, emits=topic)
    declared(m, "both", when=heard & topic & m.signal("pointed"), writes=out)
    engine = Engine(rs.compile(m))
    assert runs(engine, Emit("m:heard"), end=False)
    text = str(explain(engine, engine.policy.rule_plan("m:both")))
    assert "lacks m:topic\n" in text
    assert "lacks m:pointed, an input\n" in text


@pytest.mark.parametrize(("limit", "lines"), [(0, 0), (1, 1), (99, 3)])
def test_the_history_has_at_most_the_given_number_of_lines(limit: int, lines: int) -> None:
    m = rs.Module("m")
    declared(m, "answer", when=m.signal("go"))
    engine = Engine(rs.compile(m))
    records: list[Record] = []
    engine.tracer = records.append
    assert runs(engine, Emit("m:go"))
    history = explain(engine, engine.policy.rule_plan("m:answer"), records, limit).history
    assert len(history) == lines
