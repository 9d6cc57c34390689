"""L16: a rival is viable while its missing spikes may still come. An activation waits only for viable rivals."""

import sys
from typing import Any

import pytest

import ravestate as rs
from laws.short import (
    at_rest,
    emitter,
    given_up,
    moments,
    output,
    pressed,
    resigner,
    started,
    writer,
    written,
)


def is_never_true(ctx: Any) -> bool:
    return False


# ---------------------------------------------------------------------------- (i) live spikes


def test_a_spike_still_too_young_keeps_a_rival_viable(play: Any) -> None:
    m = rs.Module("m")
    i, j, out = m.signal("i"), m.signal("j"), output(m)
    writer(m, "specific", i & j.min_age(3.0), out)
    writer(m, "general", i, out)
    with play(m) as sim:
        sim.emit(j)
        sim.emit(i)
        sim.advance(10.0)
        assert moments(sim, out) == [(3.0, "specific")]
        assert pressed(sim) == []  # without pressure, `general` waits for longer than the patience (1 s)


def test_a_rule_waits_for_a_rival_whose_spike_in_another_group_is_still_too_young(play: Any) -> None:
    m = rs.Module("m")
    i, j, out = m.signal("i"), m.signal("j"), output(m)
    writer(m, "specific", i.min_age(3.0) & j, out)
    writer(m, "general", j, out)
    with play(m) as sim:
        sim.emit(i)
        sim.advance(1.0)
        sim.emit(j)
        sim.advance(10.0)
        assert moments(sim, out) == [(3.0, "specific")]


def test_a_consumed_spike_does_not_make_a_rival_viable(play: Any) -> None:
    m = rs.Module("m")
    i, j, never, out = m.signal("i"), m.signal("j"), m.signal("never"), output(m)
    writer(m, "hold", j.max_age(None) & never, output(m, "face"))
    writer(m, "answer", j, out, weight=9.0)
    writer(m, "specific", i & j.max_age(None), out)
    writer(m, "general", i, out)
    with play(m) as sim:
        sim.emit(j)
        sim.advance(2.0)
        sim.emit(i)
        sim.advance(20.0)
        # j is still live, for another slot. A new j might come, so `general` waits for the patience, but not longer.
        assert moments(sim, out) == [(0.0, "answer"), (3.0, "general")]


# ---------------------------------------------------------------------------- (ii) the horizon


def classified(after: float, **options: Any) -> tuple[rs.Module, rs.Signal[Any], rs.Slot[str]]:
    """Declare a slow classifier, a rule for the signal that it raises, and a fallback."""
    m = rs.Module("m")
    i, x, out = m.signal("i"), m.signal("x"), output(m)
    emitter(m, "classify", i, x, after=after, **options)
    writer(m, "specific", x, out)
    writer(m, "general", i, out)
    return m, i, out


@pytest.mark.parametrize("after", [0.0, 0.7, 60.0])
def test_a_rule_waits_for_the_effects_of_a_running_rule_however_long_it_runs(play: Any, after: float) -> None:
    m, i, out = classified(after)
    with play(m) as sim:
        sim.emit(i)
        sim.advance(100.0)
        assert moments(sim, out) == [(after, "specific")]
        assert pressed(sim) == []


@pytest.mark.parametrize("after", [0.0, 0.7, 60.0])
def test_a_waiting_rule_runs_as_soon_as_a_classifier_ends_without_raising_its_signal(play: Any, after: float) -> None:
    m, i, out = classified(after, only_if=is_never_true)
    with play(m) as sim:
        sim.emit(i)
        sim.advance(100.0)
        assert moments(sim, out) == [(after, "general")]
        assert pressed(sim) == []


def chain(stops_at: int) -> tuple[rs.Module, rs.Signal[Any], rs.Slot[str]]:
    """Declare a chain of three rules, each of which runs for 10 s. Rule number `stops_at` does not raise its signal."""
    m = rs.Module("m")
    signals = [m.signal(f"s{number}") for number in range(4)]
    for number in range(3):
        emitter(
            m, f"link_{number}", signals[number], signals[number + 1], after=10.0,
            only_if=is_never_true if number == stops_at else lambda ctx: True,
        )  # fmt: skip
    out = output(m)
    writer(m, "specific", signals[3], out)
    writer(m, "general", signals[0], out)
    return m, signals[0], out


@pytest.mark.parametrize("stops_at", [0, 1, 2])
def test_the_horizon_shrinks_at_the_moment_at_which_a_link_of_the_chain_breaks(play: Any, stops_at: int) -> None:
    m, begin, out = chain(stops_at)
    with play(m) as sim:
        sim.emit(begin)
        sim.advance(100.0)
        assert moments(sim, out) == [(10.0 * (stops_at + 1), "general")]


def test_the_horizon_extends_over_rules_that_are_still_viable(play: Any) -> None:
    m, begin, out = chain(stops_at=-1)
    with play(m) as sim:
        sim.emit(begin)
        sim.advance(100.0)
        assert moments(sim, out) == [(30.0, "specific")]


def test_the_effects_of_a_rule_that_can_no_longer_fire_are_not_in_the_horizon(play: Any) -> None:
    m = rs.Module("m")
    i, x, y, z, out = m.signal("i"), m.signal("x"), m.signal("y"), m.signal("z"), output(m)
    emitter(m, "one", i, x, after=2.0, only_if=is_never_true)
    emitter(m, "two", i, y, after=9.0)
    emitter(m, "join", x & y, z)
    writer(m, "specific", z, out)
    writer(m, "general", i, out)
    with play(m) as sim:
        sim.emit(i)
        sim.advance(20.0)
        assert moments(sim, out) == [(2.0, "general")]  # without x there is no z, even if `two` still raises y


def test_a_rival_is_viable_while_one_rule_can_still_raise_its_signal(play: Any) -> None:
    m = rs.Module("m")
    i, x, out = m.signal("i"), m.signal("x"), output(m)
    emitter(m, "fast", i, x, after=1.0, only_if=is_never_true)
    emitter(m, "slow", i, x, after=5.0)
    writer(m, "specific", x, out)
    writer(m, "general", i, out)
    with play(m) as sim:
        sim.emit(i)
        sim.advance(20.0)
        assert moments(sim, out) == [(5.0, "specific")]


def test_the_horizon_also_shrinks_when_a_rule_resigns(play: Any) -> None:
    m = rs.Module("m")
    i, x, out = m.signal("i"), m.signal("x"), output(m)
    resigner(m, "classify", i, after=2.0, emits=x)
    writer(m, "specific", x, out)
    writer(m, "general", i, out)
    with play(m) as sim:
        sim.emit(i)
        sim.advance(20.0)
        assert moments(sim, out) == [(2.0, "general")]


def test_the_horizon_also_shrinks_when_a_rule_fails(play: Any) -> None:
    m = rs.Module("m")
    i, x, out = m.signal("i"), m.signal("x"), output(m)

    @m.rule(when=i, emits=x)
    async def classify(ctx: Any) -> None:
        await ctx.sleep(2.0)
        raise ValueError("no idea")

    writer(m, "specific", x, out)
    writer(m, "general", i, out)
    with play(m) as sim:
        sim.emit(i)
        sim.advance(20.0)
        assert moments(sim, out) == [(2.0, "general")]


def test_a_rule_does_not_wait_for_the_horizon_of_another_group(play: Any) -> None:
    m, i, out = classified(after=10.0)
    with play(m) as sim:
        sim.emit(i)
        sim.advance(9.0)
        sim.emit(i)
        sim.advance(30.0)
        assert moments(sim, out) == [(10.0, "specific"), (19.0, "specific")]


# ---------------------------------------------------------------------------- (iii) inputs, and patience


def fusion(**options: Any) -> tuple[rs.Module, rs.Signal[Any], rs.Signal[Any], rs.Slot[str]]:
    m = rs.Module("m")
    point, speech, out = m.signal("point"), m.signal("speech"), output(m)
    writer(m, "fused", point & speech, out, **options)
    writer(m, "plain", speech, out)
    return m, point, speech, out


def test_a_rule_waits_one_second_for_an_input(play: Any) -> None:
    m, _, speech, out = fusion()
    with play(m) as sim:
        sim.advance(2.0)
        sim.emit(speech)
        sim.advance(10.0)
        assert moments(sim, out) == [(3.0, "plain")]
        assert pressed(sim) == [(2.0, "fused", ("m:point",), 3.0)]


def test_an_input_that_comes_in_time_makes_the_rival_ready(play: Any) -> None:
    m, point, speech, out = fusion()
    with play(m) as sim:
        sim.emit(speech)
        sim.advance(0.999)
        sim.emit(point)
        assert moments(sim, out) == [(0.999, "fused")]


@pytest.mark.parametrize(
    ("context", "rule", "waited"), [(4.0, None, 4.0), (4.0, 0.25, 0.25), (0.25, 4.0, 4.0), (0.0, None, 0.0)]
)
def test_patience_comes_from_the_context_or_from_the_rule(
    play: Any, context: float, rule: float | None, waited: float
) -> None:
    m, _, speech, out = fusion(patience=rule)
    with play(m, patience=context) as sim:
        sim.emit(speech)
        sim.advance(10.0)
        assert moments(sim, out) == [(waited, "plain")]


def test_patience_counts_from_the_moment_of_pressure(play: Any) -> None:
    m = rs.Module("m")
    point, speech, out = m.signal("point"), m.signal("speech"), output(m)
    writer(m, "fused", point & speech, out)
    writer(m, "plain", speech.min_age(2.5), out)
    with play(m) as sim:
        sim.emit(speech)
        sim.advance(10.0)
        assert moments(sim, out) == [(3.5, "plain")]


def test_a_rival_loses_no_patience_without_pressure(play: Any) -> None:
    m, point, speech, out = fusion()
    with play(m) as sim:
        sim.emit(point)
        sim.advance(4.0)
        sim.emit(speech)
        assert moments(sim, out) == [(4.0, "fused")]


def test_a_rival_whose_patience_ran_out_gives_its_spikes_up(play: Any) -> None:
    m = rs.Module("m")
    point, speech, out = m.signal("point"), m.signal("speech"), output(m)
    writer(m, "fused", point & speech, out)
    resigner(m, "plain", speech, out)
    with play(m) as sim:
        sim.emit(speech)
        sim.advance(2.0)
        assert given_up(sim, "fused") == [(1.0, "speech", "eliminated")]
        sim.emit(point)
        assert written(sim, out) == []
        sim.emit(speech)  # `fused` still stands by
        assert moments(sim, out) == [(2.0, "fused")]


def test_the_patience_of_a_rule_does_not_start_over_when_a_second_rule_waits_for_it(play: Any) -> None:
    m = rs.Module("m")
    point, speech, out = m.signal("point"), m.signal("speech"), output(m)
    writer(m, "fused", point & speech, out)
    writer(m, "plain", speech, out)
    writer(m, "plainer", speech.min_age(0.5), out)
    with play(m) as sim:
        sim.emit(speech)
        sim.advance(10.0)
        assert moments(sim, out) == [(1.0, "plain")]


# ---------------------------------------------------------------------------- (iii) live rules elsewhere


def foreign(after: float, **options: Any) -> tuple[rs.Module, rs.Signal[Any], rs.Signal[Any], rs.Slot[str]]:
    """Declare a rival that lacks `x`. Only `make` raises `x`, and only for another cause (`kick`)."""
    m = rs.Module("m")
    i, kick, x, out = m.signal("i"), m.signal("kick"), m.signal("x"), output(m)
    emitter(m, "make", kick, x, after=after, **options)
    writer(m, "specific", i & x, out)
    writer(m, "general", i, out)
    return m, i, kick, out


def test_no_rule_waits_for_a_signal_that_no_live_rule_could_cause(play: Any) -> None:
    m, i, _, out = foreign(after=0.0)
    with play(m) as sim:
        sim.emit(i)
        assert moments(sim, out) == [(0.0, "general")]


def test_a_rule_waits_with_patience_for_the_effects_of_a_running_rule_of_another_group(play: Any) -> None:
    m, i, kick, out = foreign(after=10.0)
    with play(m) as sim:
        sim.emit(kick)
        sim.emit(i)
        sim.advance(20.0)
        assert moments(sim, out) == [(1.0, "general")]


def test_an_effect_of_another_group_in_time_makes_the_rival_ready(play: Any) -> None:
    m, i, kick, out = foreign(after=0.5)
    with play(m) as sim:
        sim.emit(kick)
        sim.emit(i)
        sim.advance(20.0)
        assert moments(sim, out) == [(0.5, "specific")]


def test_no_rule_waits_for_a_rule_of_another_group_that_has_ended(play: Any) -> None:
    m, i, kick, out = foreign(after=0.5, only_if=is_never_true)
    with play(m) as sim:
        sim.emit(kick)
        sim.emit(i)
        sim.advance(20.0)
        assert moments(sim, out) == [(0.5, "general")]


def test_a_rule_that_holds_a_spike_is_live(play: Any) -> None:
    m = rs.Module("m")
    i, kick, more, x, out = m.signal("i"), m.signal("kick"), m.signal("more"), m.signal("x"), output(m)
    emitter(m, "make", kick & more, x)
    writer(m, "specific", i & x, out)
    writer(m, "general", i, out)
    with play(m) as sim:
        sim.emit(kick)
        sim.emit(i)
        sim.advance(20.0)
        sim.emit(i)  # now `make` holds no spike
        assert moments(sim, out) == [(1.0, "general"), (20.0, "general")]


def test_a_signal_that_only_a_detached_rule_raises_is_not_an_input(play: Any) -> None:
    m = rs.Module("m")
    i, kick, x, out = m.signal("i"), m.signal("kick"), m.signal("x"), output(m)
    emitter(m, "make", kick, x, detached=True)
    writer(m, "specific", i & x, out)
    writer(m, "general", i, out)
    with play(m) as sim:
        sim.emit(i)
        assert moments(sim, out) == [(0.0, "general")]


def test_a_rule_waits_for_a_declared_input_even_if_another_rule_raises_it(play: Any) -> None:
    m = rs.Module("m")
    i, kick, x, out = m.signal("i"), m.signal("kick"), m.signal("x", input=True), output(m)
    emitter(m, "make", kick, x)
    writer(m, "specific", i & x, out)
    writer(m, "general", i, out)
    with play(m) as sim:
        sim.emit(i)
        sim.advance(10.0)
        assert moments(sim, out) == [(1.0, "general")]


def test_a_retired_rule_is_not_a_rival(play: Any) -> None:
    m = rs.Module("m")
    point, speech, out = m.signal("point"), m.signal("speech"), output(m)

    @m.rule(when=point & speech, writes=out)
    async def once(ctx: Any) -> rs.Retire:
        ctx[out] = "once"
        return rs.Retire()

    writer(m, "plain", speech, out)
    with play(m) as sim:
        sim.emit(point)
        sim.emit(speech)
        sim.emit(speech)
        assert moments(sim, out) == [(0.0, "once"), (0.0, "plain")]


def test_a_rival_is_under_pressure_from_the_moment_at_which_it_lost_a_spike(play: Any) -> None:
    m = rs.Module("m")
    i, j, out = m.signal("i"), m.signal("j"), output(m)
    writer(m, "other", m.signal("k"), output(m, "face"))
    writer(m, "fuse", i & j, out)
    writer(m, "busy", j, out, weight=10.0, after=3.0)
    writer(m, "plain", i, out)
    with play(m) as sim:
        sim.emit(j)
        sim.emit(i)
        sim.advance(20.0)
        assert started(sim) == [(0.0, "busy"), (4.0, "plain")]
        assert set(pressed(sim)) == {(3.0, "fuse", ("m:j",), 4.0)}  # `busy` has consumed the only `j`


# ---------------------------------------------------------------------------- mixtures


def mixed(after: float, **options: Any) -> tuple[rs.Module, rs.Signal[Any], rs.Signal[Any], rs.Slot[str]]:
    """Declare a rival that lacks `x` and `j`. A rule of the group may still raise `x`, and `j` is an input."""
    m = rs.Module("m")
    i, j, x, out = m.signal("i"), m.signal("j"), m.signal("x"), output(m)
    emitter(m, "classify", i, x, after=after, **options)
    writer(m, "specific", j & x, out)
    writer(m, "general", i, out)
    return m, i, j, out


def test_a_rival_with_spikes_of_another_group_has_a_stake_if_it_waits_for_an_effect_of_this_group(play: Any) -> None:
    m, i, j, out = mixed(after=3.0)
    with play(m) as sim:
        sim.emit(j)
        sim.emit(i)
        sim.advance(20.0)
        assert moments(sim, out) == [(3.0, "specific")]
        assert pressed(sim) == []


def test_a_rival_with_spikes_of_another_group_loses_its_stake_once_this_group_cannot_cause_its_signal(
    play: Any,
) -> None:
    m, i, j, out = mixed(after=3.0, only_if=is_never_true)
    with play(m) as sim:
        sim.emit(j)
        sim.emit(i)
        sim.advance(20.0)
        assert moments(sim, out) == [(3.0, "general")]


def test_a_rival_that_also_lacks_an_input_comes_under_pressure(play: Any) -> None:
    m, i, _, out = mixed(after=3.0)
    with play(m) as sim:
        sim.emit(i)
        sim.advance(20.0)
        assert moments(sim, out) == [(1.0, "general")]


@pytest.mark.parametrize("comes", [False, True])
def test_a_rival_that_needs_an_input_through_another_rule_comes_under_pressure(play: Any, comes: bool) -> None:
    m = rs.Module("m")
    i, j, x, out = m.signal("i"), m.signal("j"), m.signal("x"), output(m)
    emitter(m, "make", i & j, x)
    writer(m, "specific", x, out)
    writer(m, "general", i, out)
    with play(m) as sim:
        sim.emit(i)
        sim.advance(0.5)
        if comes:
            sim.emit(j)
        sim.advance(20.0)
        assert moments(sim, out) == ([(0.5, "specific")] if comes else [(1.0, "general")])


def test_a_rival_whose_slot_is_consumed_is_not_viable(play: Any) -> None:
    m = rs.Module("m")
    i, x, out, face = m.signal("i"), m.signal("x"), output(m), output(m, "face")
    writer(m, "other", m.signal("k"), output(m, "arm"))
    emitter(m, "classify", i, x, after=10.0)
    writer(m, "speak", i, out, weight=100.0)
    writer(m, "perform", x, out, face)
    writer(m, "smile", i, face)
    with play(m) as sim:
        sim.emit(i)
        assert (moments(sim, out), moments(sim, face)) == ([(0.0, "speak")], [(0.0, "smile")])
        sim.advance(20.0)
        assert at_rest(sim)


def test_a_rule_waits_no_longer_than_the_patience_for_a_rival_whose_gate_is_closed(play: Any) -> None:
    m = rs.Module("m")
    i, mood, out = m.signal("i"), m.slot("mood", "calm"), output(m)
    writer(m, "gated", i & mood.holds(lambda value: value == "merry"), out)
    writer(m, "general", i, out)
    with play(m) as sim:
        sim.emit(i)
        sim.advance(20.0)
        [(moment, name)] = moments(sim, out)
        assert name == "general"
        assert moment <= 1.0


@pytest.mark.parametrize("fits", [False, True])
def test_a_rule_stops_waiting_for_a_rival_whose_predicate_refuses_the_payload(play: Any, fits: bool) -> None:
    m = rs.Module("m")
    i, x, out = m.signal("i"), m.signal("x", payload=str), output(m)
    emitter(m, "classify", i, x, after=2.0)
    writer(m, "specific", x.where(lambda payload: fits), out)
    writer(m, "general", i, out)
    with play(m) as sim:
        sim.emit(i)
        sim.advance(20.0)
        assert moments(sim, out) == [(2.0, "specific" if fits else "general")]
        assert at_rest(sim)


def test_pressure_for_one_cause_does_not_use_up_the_patience_for_another(play: Any) -> None:
    m, point, speech, out = fusion()
    with play(m) as sim:
        sim.emit(speech)
        sim.advance(0.6)
        sim.emit(speech)  # this cause has its own patience
        sim.advance(0.7)
        assert moments(sim, out) == [(1.0, "plain")]
        sim.emit(point)
        assert moments(sim, out) == [(1.0, "plain"), (1.3, "fused")]


def test_a_rule_waits_for_the_end_of_a_long_chain(play: Any) -> None:
    m, length = rs.Module("m"), 500
    out = output(m)
    links = [m.signal(f"link{i}") for i in range(length + 1)]
    for i in range(length):
        emitter(m, f"link{i}", links[i], links[i + 1], after=3.0 if i == 0 else 0.0)
    writer(m, "end", links[-1], out)
    writer(m, "fallback", links[0], out)
    with play(m) as sim:
        sim.emit(links[0])
        sim.advance(5.0)
        assert moments(sim, out) == [(3.0, "end")]


def test_patience_does_not_start_over_when_a_rival_is_offered_a_spike_that_another_activation_takes(play: Any) -> None:
    m = rs.Module("m")
    speech, gesture, out = m.signal("speech"), m.signal("gesture"), output(m)
    writer(m, "fuse", speech & gesture, out)
    writer(m, "alone", speech, out)
    with play(m) as sim:
        for pause in (0.4, 0.4, 0.1):
            sim.emit(speech)
            sim.advance(pause)
        sim.emit(gesture)
        sim.advance(5.0)
        assert moments(sim, out) == [(0.9, "fuse"), (1.4, "alone"), (1.8, "alone")]


def test_a_younger_activation_is_not_under_pressure_while_an_older_one_of_its_rule_holds_the_same_spike(
    play: Any,
) -> None:
    m = rs.Module("m")
    point, speech, out = m.signal("point"), m.signal("speech", limit=2), output(m)
    writer(m, "fuse", point & speech, out, after=2.0)
    writer(m, "plain", speech, out, cooldown=9.0)
    with play(m) as sim:
        sim.emit(speech)
        sim.emit(point)  # the first run begins; the other activation with this point takes the next speech, and waits
        sim.emit(speech)
        sim.advance(0.3)
        sim.emit(speech)
        sim.emit(speech)  # the limit withdraws the speech of the waiting activation, which takes the next one
        sim.advance(1.1)
        sim.emit(point)
        assert started(sim)[-1] == (1.4, "fuse")  # the speech that `fuse` needs was still live


def test_a_chain_of_causes_can_be_longer_than_the_recursion_limit(play: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    def refuse(limit: int) -> None:
        raise AssertionError(f"the engine must not change the recursion limit: {limit}")

    m = rs.Module("m")
    a, out = m.signal("a"), output(m)
    last, depth = a, sys.getrecursionlimit()
    for number in range(depth):
        signal = m.signal(f"s{number}")
        emitter(m, f"r{number}", last, signal, after=0.0 if number else 2.0)
        last = signal
    writer(m, "answer", last, out)
    writer(m, "fallback", a, out)
    policy = rs.compile(m)
    monkeypatch.setattr(sys, "setrecursionlimit", refuse)
    with play(policy) as sim:
        sim.emit(a)
        sim.advance(1.0)
        assert written(sim, out) == []
        assert sim.snapshot()["activations"]
        sim.advance(1.0)
        assert written(sim, out) == ["answer"]
