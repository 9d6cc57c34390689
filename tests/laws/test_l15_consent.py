"""L15: a ready activation needs the consent of each causal group of its non-detached spikes."""

from math import log
from typing import Any

import ravestate as rs
from laws.short import at_rest, emitter, moments, output, resigner, started, writer, written


def test_without_a_rival_a_ready_rule_runs_immediately(play: Any) -> None:
    m = rs.Module("m")
    i, out = m.signal("i"), output(m)
    writer(m, "only", i, out)
    with play(m) as sim:
        sim.emit(i)
        assert moments(sim, out) == [(0.0, "only")]


def test_no_rule_gets_a_slot_that_a_running_rule_has_taken(play: Any) -> None:
    m = rs.Module("m")
    i, out = m.signal("i"), output(m)
    resigner(m, "first", i, out, after=2.0)
    writer(m, "second", i, out)
    with play(m) as sim:
        sim.emit(i)
        sim.advance(10.0)
        assert started(sim) == [(0.0, "first"), (2.0, "second")]


def test_no_rule_gets_a_slot_that_a_finished_rule_has_taken(play: Any) -> None:
    m = rs.Module("m")
    i, x, out = m.signal("i"), m.signal("x"), output(m)
    writer(m, "first", i, out, weight=10.0)
    emitter(m, "cause", i, x, after=2.0)
    writer(m, "late", x, out, weight=0.1)
    writer(m, "other", m.signal("k"), output(m, "face"))
    with play(m) as sim:
        sim.emit(i)
        sim.advance(10.0)
        assert written(sim, out) == ["first"]
        assert at_rest(sim)  # no activation waits for ever for a consumed cause


def test_the_greater_effective_utility_goes_first(play: Any) -> None:
    m = rs.Module("m")
    i, j, out = m.signal("i"), m.signal("j"), output(m)
    writer(m, "general", i, out)
    writer(m, "specific", i & j, out)
    with play(m) as sim:
        sim.emit(j)
        sim.emit(i)
        sim.advance(10.0)
        assert written(sim, out) == ["specific"]


def test_a_weight_can_reverse_the_order(play: Any) -> None:
    m = rs.Module("m")
    i, j, out = m.signal("i"), m.signal("j"), output(m)
    writer(m, "other", m.signal("k"), output(m, "face"))
    writer(m, "general", i, out, weight=100.0)
    writer(m, "specific", i & j, out)
    with play(m) as sim:
        sim.emit(j)
        sim.emit(i)
        sim.advance(10.0)
        assert written(sim, out) == ["general"]


def test_the_first_declared_of_equals_wins(play: Any) -> None:
    m = rs.Module("m")
    i, out = m.signal("i"), output(m)
    for name in ("second", "first", "third"):
        writer(m, name, i, out)
    with play(m) as sim:
        for _ in range(3):
            sim.emit(i)
        assert written(sim, out) == ["second"] * 3


def test_a_rule_that_writes_another_slot_is_not_a_rival(play: Any) -> None:
    m = rs.Module("m")
    i, j, out = m.signal("i"), m.signal("j"), output(m)
    writer(m, "specific", i & j, output(m, "face"))
    writer(m, "general", i, out)
    with play(m) as sim:
        sim.emit(i)
        assert moments(sim, out) == [(0.0, "general")]


def test_a_rule_that_waits_for_unrelated_signals_is_not_a_rival(play: Any) -> None:
    m = rs.Module("m")
    i, j, k, out = m.signal("i"), m.signal("j"), m.signal("k"), output(m)
    writer(m, "unrelated", j & k, out, weight=10.0)
    writer(m, "general", i, out)
    with play(m) as sim:
        sim.emit(j)
        sim.emit(i)
        assert moments(sim, out) == [(0.0, "general")]


def test_a_rule_that_runs_for_another_cause_is_not_a_rival(play: Any) -> None:
    m = rs.Module("m")
    i, out = m.signal("i"), output(m)
    writer(m, "slow", i, out, after=10.0)
    with play(m) as sim:
        sim.emit(i)
        sim.emit(i)
        assert started(sim) == [(0.0, "slow")] * 2


def test_a_rival_in_stand_by_has_a_stake_if_it_waits_for_an_effect_of_the_group(play: Any) -> None:
    m = rs.Module("m")
    i, x, out = m.signal("i"), m.signal("x"), output(m)
    emitter(m, "cause", i, x, after=3.0)
    writer(m, "specific", x, out)
    writer(m, "general", i, out)
    with play(m) as sim:
        sim.emit(i)
        sim.advance(10.0)
        assert moments(sim, out) == [(3.0, "specific")]


def test_a_rule_of_lower_utility_is_not_a_rival(play: Any) -> None:
    m = rs.Module("m")
    i, x, out = m.signal("i"), m.signal("x"), output(m)
    emitter(m, "cause", i, x, after=3.0)
    writer(m, "late", x, out, weight=0.1)
    writer(m, "early", i & m.signal("j"), out, weight=10.0)
    with play(m) as sim:
        sim.emit(m.signals[2])
        sim.emit(i)
        sim.advance(10.0)
        assert moments(sim, out) == [(0.0, "early")]


def every_group(m: rs.Module) -> tuple[rs.Signal[Any], rs.Signal[Any], rs.Slot[str]]:
    i, j, out = m.signal("i"), m.signal("j"), output(m)
    writer(m, "fuse", i & j, out)
    writer(m, "other", m.signal("k"), output(m, "face"))
    return i, j, out


def test_a_rule_on_two_groups_waits_while_one_of_them_refuses(play: Any) -> None:
    m = rs.Module("m")
    i, j, out = every_group(m)
    resigner(m, "busy", j, out, weight=10.0, after=3.0)
    with play(m) as sim:
        sim.emit(j)
        sim.emit(i)
        sim.advance(10.0)
        assert started(sim) == [(0.0, "busy"), (3.0, "fuse")]
        assert written(sim, out) == ["fuse"]


def test_a_rule_on_two_groups_never_runs_if_one_of_them_never_consents(play: Any) -> None:
    m = rs.Module("m")
    i, j, out = every_group(m)
    writer(m, "busy", j, out, weight=10.0, after=3.0)
    with play(m) as sim:
        sim.emit(j)
        sim.emit(i)
        sim.advance(20.0)
        assert moments(sim, out) == [(3.0, "busy")]


def test_the_group_of_a_detached_spike_is_not_asked(play: Any) -> None:
    m = rs.Module("m")
    i, j, out = m.signal("i"), m.signal("j"), output(m)
    writer(m, "busy", j, out, weight=10.0, after=3.0)
    writer(m, "look", i & j.detached(), out)
    with play(m) as sim:
        sim.emit(j)
        sim.emit(i)
        sim.advance(10.0)
        assert moments(sim, out) == [(0.0, "look"), (3.0, "busy")]


def test_slots_taken_in_one_group_stay_taken_after_the_group_merges(play: Any) -> None:
    m = rs.Module("m")
    i, j, x, out = m.signal("i"), m.signal("j"), m.signal("x"), output(m)
    emitter(m, "fuse", i.min_age(1.0) & j, x)
    writer(m, "other", m.signal("k"), output(m, "face"))
    resigner(m, "one", i, out, after=2.0, weight=9.0)
    writer(m, "two", j, out, after=5.0, weight=9.0)
    writer(m, "late", x, out, weight=0.1)
    with play(m) as sim:
        sim.emit(i)
        sim.emit(j)
        sim.advance(20.0)
        assert [name for _, name in started(sim)] == ["one", "two", "fuse"]
        assert moments(sim, out) == [(5.0, "two")]


def test_a_rule_that_waits_for_two_groups_runs_when_both_are_free(play: Any) -> None:
    m = rs.Module("m")
    i, j, out = every_group(m)
    resigner(m, "one", i, out, after=2.0, weight=10.0)
    resigner(m, "two", j, out, after=5.0, weight=10.0)
    with play(m) as sim:
        sim.emit(i)
        sim.emit(j)
        sim.advance(20.0)
        assert moments(sim, out) == [(5.0, "fuse")]


def test_a_recovering_rival_competes_with_its_effective_utility(play: Any) -> None:
    m = rs.Module("m")
    i, x, out = m.signal("i"), m.signal("x"), output(m)
    writer(m, "other", m.signal("k"), output(m, "face"))
    emitter(m, "classify", i, x, after=5.0)
    writer(m, "specific", x, out, cooldown=100.0)
    writer(m, "general", i, out)
    with play(m) as sim:
        sim.emit(i)
        sim.advance(6.0)
        sim.emit(i)  # a second after `specific` has run
        sim.advance(20.0)
        assert moments(sim, out) == [(5.0, "specific"), (6.0, "general")]


def test_a_rule_that_recovers_while_it_waits_runs_when_it_overtakes_its_rival(play: Any) -> None:
    m = rs.Module("m")
    i, x, out = m.signal("i"), m.signal("x"), output(m)
    weight = 2 * (log(4) + log(4 / 3)) / log(4 / 3)  # twice what `specific` is worth
    writer(m, "general", i, out, weight=weight, cooldown=10.0)
    emitter(m, "classify", i, x, after=60.0)
    writer(m, "specific", x, out)
    writer(m, "other", m.signal("k"), output(m, "face"))
    with play(m) as sim:
        sim.emit(i)
        sim.advance(1.0)
        sim.emit(i)
        sim.advance(100.0)
        assert moments(sim, out) == [(0.0, "general"), (5.0, "general")]


def test_two_rules_that_wait_for_each_other_do_not_wait_for_ever(play: Any) -> None:
    m = rs.Module("m")
    i, y, z = m.signal("i"), m.signal("y"), m.signal("z")
    out, face = output(m), output(m, "face")

    def first(name: str, slot: rs.Slot[str], effect: rs.Signal[Any]) -> None:
        @m.rule(when=i, writes=slot, emits=effect, name=name)
        async def act(ctx: Any) -> None:
            ctx[slot] = name
            ctx.emit(effect)

    first("speak", out, y)
    first("smile", face, z)
    writer(m, "smile_at_y", y, face)  # `smile` would wait for this rule, and so for `speak`
    writer(m, "speak_of_z", z, out)  # `speak` would wait for this rule, and so for `smile`
    with play(m) as sim:
        sim.emit(i)
        assert (written(sim, out), written(sim, face)) == (["speak"], ["smile_at_y"])
