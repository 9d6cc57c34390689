"""`Stuck` is the set of the activations that wait only for each other. It counts the activations of each rule."""

from __future__ import annotations

import ravestate as rs
from laws.short import output, writer
from ravestate.engine.activation import Activation
from ravestate.engine.stuck import Stuck


def test_an_activation_that_is_added_or_removed_twice_counts_once() -> None:
    m = rs.Module("m")
    writer(m, "rule", m.signal("a"), output(m))
    clause = rs.compile(m).rule_plan("m:rule").clauses[0]
    one, other = Activation(1, clause), Activation(2, clause)
    stuck = Stuck([one, other])
    stuck.add(one)
    assert (list(stuck), stuck.counts[clause.rule.index]) == ([one, other], 2)
    stuck.discard(one)
    stuck.discard(one)
    assert (list(stuck), stuck.counts[clause.rule.index]) == ([other], 1)
    stuck.clear()
    assert not stuck
    assert not stuck.counts
