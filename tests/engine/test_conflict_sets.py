"""A *conflict set* is the set of the clauses that one spike makes ready, although only one of them can run.

With a trace, each clause gets an activation; without a trace, only the best one does. The same rules run in both cases.
"""

from __future__ import annotations

from typing import Any

import pytest

import ravestate as rs
from ravestate.testing import simulate

pytestmark = pytest.mark.parametrize("trace", [True, False])


def test_a_rule_that_resigns_gives_its_spike_up_for_both_its_clauses(trace: bool) -> None:
    m = rs.Module("m")
    a, out, ran = m.signal("a"), m.slot("out", ""), list[str]()

    @m.rule(when=a.where(lambda _: True) | a, writes=out)
    async def asks(ctx: Any) -> rs.Resign:
        ran.append("asks")
        return rs.Resign("no")

    @m.rule(when=a, writes=out, weight=0.5)
    async def fallback(ctx: Any) -> None:
        ctx[out] = "fallback"

    with simulate(m, trace=trace) as sim:
        sim.emit(a)
        assert (ran, sim.read(out)) == (["asks"], "fallback")


def test_groups_merge_although_no_rule_listens_to_the_slot(trace: bool) -> None:
    m = rs.Module("m")
    a, b = m.signal("a"), m.signal("b")
    unheard, wanted = m.slot("unheard", 0), m.slot("wanted", 0)

    @m.rule(when=a, writes=wanted)
    async def first(ctx: Any) -> None:
        ctx[wanted] = 1

    @m.rule(when=a & b, writes=unheard)
    async def joins(ctx: Any) -> None:
        ctx[unheard] = 1

    @m.rule(when=b.min_age(0.5), writes=wanted)
    async def second(ctx: Any) -> None:
        ctx[wanted] = 2

    with simulate(m, trace=trace) as sim:
        sim.emit(a)
        sim.emit(b)
        sim.advance(1.0)
        assert sim.read(wanted) == 1


def test_an_exception_whose_repr_raises_is_a_failure_like_any_other(trace: bool) -> None:
    class Bad(Exception):
        def __repr__(self) -> str:
            raise ValueError

        __str__ = __repr__

    m = rs.Module("m")
    a, out = m.signal("a"), m.slot("out", "")

    @m.rule(when=a, writes=out, weight=2.0)
    async def fails(ctx: Any) -> None:
        raise Bad

    @m.rule(when=a, writes=out)
    async def fallback(ctx: Any) -> None:
        ctx[out] = "fallback"

    with simulate(m, trace=trace) as sim:
        sim.emit(a)
        assert sim.read(out) == "fallback"


def test_a_rule_of_less_utility_runs_after_a_rule_with_two_clauses_has_resigned(trace: bool) -> None:
    m = rs.Module("m")
    a, b, out = m.signal("a"), m.signal("b"), m.slot("out", "")

    @m.rule(when=a, writes=out)
    async def fallback(ctx: Any) -> None:
        ctx[out] = "fallback"

    @m.rule(when=(a & b) | a, writes=out, weight=2.0)
    async def resigns(ctx: Any) -> None:
        raise rs.Resign("not today")

    with simulate(m, trace=trace) as sim:
        sim.emit(b)
        sim.emit(a)
        assert sim.read(out) == "fallback"


def test_a_clause_whose_patience_is_over_leaves_the_spike_to_another_clause_of_its_rule(trace: bool) -> None:
    m = rs.Module("m")
    a, b, out = m.signal("a"), m.signal("b"), m.slot("out", "")

    @m.rule(when=a, writes=out)
    async def fails(ctx: Any) -> None:
        raise ValueError

    @m.rule(when=(a & b) | a, writes=out)
    async def patient(ctx: Any) -> None:
        ctx[out] = "patient"

    with simulate(m, trace=trace) as sim:
        sim.emit(a)
        sim.advance(1.0)
        assert sim.read(out) == "patient"
