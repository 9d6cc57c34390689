"""L14: an activation is ready when all its constraints hold spikes that are old enough.

Only an incomplete activation loses a spike to its age.
"""

from typing import Any

import pytest

import ravestate as rs
from laws.short import emitter, given_up, moments, output, started, writer, written


def test_an_activation_is_ready_when_its_last_spike_is_old_enough(play: Any) -> None:
    m = rs.Module("m")
    a, b, out = m.signal("a"), m.signal("b"), output(m)
    writer(m, "both", a.min_age(3.0) & b.min_age(1.0), out)
    with play(m) as sim:
        sim.emit(a)
        sim.advance(0.5)
        sim.emit(b)
        sim.advance(2.4)
        assert started(sim) == []
        sim.advance(10.0)
        assert moments(sim, out) == [(3.0, "both")]


def test_a_spike_past_its_age_is_given_up_while_the_activation_is_incomplete(play: Any) -> None:
    m = rs.Module("m")
    a, b, out = m.signal("a"), m.signal("b"), output(m)
    writer(m, "both", a.max_age(2.0) & b, out)
    with play(m) as sim:
        sim.emit(a)
        sim.advance(3.0)
        assert given_up(sim, "both") == [(2.0, "a", "age")]
        sim.emit(b)
        assert written(sim, out) == []
        sim.emit(a)  # the first b is still live: only a fresh a is missing
        assert written(sim, out) == ["both"]


def test_an_activation_whose_spike_is_too_young_is_incomplete(play: Any) -> None:
    m = rs.Module("m")
    a, b, out = m.signal("a"), m.signal("b"), output(m)
    writer(m, "both", a.min_age(10.0).max_age(None) & b, out)
    with play(m) as sim:
        sim.emit(a)
        sim.advance(1.0)
        sim.emit(b)
        sim.advance(9.5)
        # Two activations give b up: the one that holds both spikes, and the one that began with b.
        assert given_up(sim, "both") == [(6.0, "b", "age")] * 2
        assert written(sim, out) == []
        sim.emit(b)
        assert moments(sim, out) == [(10.5, "both")]


@pytest.mark.parametrize("delay", [60.0, 3_600.0])
def test_an_input_is_never_dropped_because_a_classifier_was_slow(play: Any, delay: float) -> None:
    m = rs.Module("m")
    i, x, out = m.signal("i"), m.signal("x"), output(m)
    emitter(m, "classify", i, x, after=delay, only_if=lambda ctx: False)
    writer(m, "specific", x, out)
    writer(m, "general", i, out)
    with play(m) as sim:
        sim.emit(i)
        sim.advance(2 * delay)
        assert moments(sim, out) == [(delay, "general")]
        assert given_up(sim, "general") == []


def test_an_activation_that_waits_for_a_taken_slot_loses_nothing_to_age(play: Any) -> None:
    m = rs.Module("m")
    i, out = m.signal("i"), output(m)

    @m.rule(when=i, writes=out, weight=2.0)
    async def first(ctx: Any) -> rs.Resign:
        await ctx.sleep(30.0)
        return rs.Resign("after all not")

    writer(m, "second", i, out)
    with play(m) as sim:
        sim.emit(i)
        sim.advance(40.0)
        assert moments(sim, out) == [(30.0, "second")]
