"""A set of idle activations counts its members by rule."""

from __future__ import annotations

import ravestate as rs
from laws.short import output, writer
from ravestate.engine.activation import Activation
from ravestate.engine.idle import Idle


def test_a_member_counts_once_and_leaves_once() -> None:
    m = rs.Module("m")
    writer(m, "rule", m.signal("a"), output(m))
    clause = rs.compile(m).rule_plan("m:rule").clauses[0]
    one, other = Activation(1, clause), Activation(2, clause)
    idle = Idle([one, other])
    idle.add(one)
    assert (list(idle), idle.counts[clause.rule.index]) == ([one, other], 2)
    idle.discard(one)
    idle.discard(one)
    assert (list(idle), idle.counts[clause.rule.index]) == ([other], 1)
    idle.clear()
    assert not idle
    assert not idle.counts
