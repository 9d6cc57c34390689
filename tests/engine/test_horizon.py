"""The horizon of a group is the set of signals that its rules may still cause.

The horizon is correct, and the engine follows each cycle of causes only once, even if many ways lead around the cycle.
"""

from __future__ import annotations

from typing import Any

import pytest

import ravestate as rs
from engine.test_halves import declared, runs
from ravestate.engine.engine import Engine
from ravestate.engine.events import Emit


def clique(size: int, *, writes: bool) -> tuple[Engine, list[Any]]:
    """Return an engine whose topics can all raise each other, and a list that grows with each step of a derivation."""
    m = rs.Module("m")
    heard, out, probe = m.signal("heard"), m.slot("out", ""), m.slot("probe", 1)
    topics = [m.signal(f"topic{n}") for n in range(size)]
    taken: list[Any] = []

    def step(value: Any) -> bool:
        taken.append(value)
        return True

    declared(m, "begins", when=heard & m.signal("hint"), emits=topics[0])
    for n, topic in enumerate(topics):
        others = [other for other in topics if other is not topic]
        own = m.slot(f"seen{n}", "") if writes else ()
        declared(m, f"leads{n}", when=topic & probe.holds(step), emits=others, writes=own)
        declared(m, f"about{n}", when=heard & topic, writes=out)
    declared(m, "fallback", when=heard, writes=out)
    return Engine(rs.compile(m)), taken


@pytest.mark.parametrize("writes", [False, True])
def test_the_cost_of_a_clique_of_topics_grows_with_its_links(writes: bool) -> None:
    counts: list[int] = []
    for size in (3, 6):
        engine, taken = clique(size, writes=writes)
        assert not runs(engine, Emit("m:heard"))
        engine.advance(1.0)
        assert [run.rule.name for run in runs(engine, now=1.0)] == ["m:fallback"]
        counts.append(len(taken))
    few, many = counts
    assert many <= 6 * few, counts  # six topics have 30 links and 1,950 ways; three topics have 6 links and 15 ways
