"""Faults of the engine that random worlds have found.

Each test plays the smallest world that shows the fault, and cites the law that was broken.
"""

from __future__ import annotations

import pytest

from properties.fuzz import difference
from properties.oracle import Exclusion, bounded, empty
from properties.worlds import Act, Gate, Play, RuleOf, SignalOf, SlotOf, Want, World
from ravestate.engine.engine import Engine
from ravestate.engine.explain import explain
from ravestate.engine.snapshot import snapshot
from ravestate.runtime.journal import Entry, replay

S3 = (SignalOf(), SignalOf(), SignalOf())
V1 = (SlotOf(),)


def on(*signals: str) -> tuple[tuple[Want, ...], ...]:
    """Return the conjunction of these signals as a condition."""
    return (tuple(Want(signal) for signal in signals),)


def runs(play: Play) -> list[str]:
    """Return the rules that were called, in order."""
    return [line.split("<rule m:")[1].split(">")[0] for line in play.heard if "< Run(" in line]


def test_a_held_spike_is_wiped_even_if_it_is_too_old_for_each_detached_constraint() -> None:
    # L20: wiping withdraws the live spikes. The detached constraint looks back only 1 s, but r0 holds the spike longer.
    looking = RuleOf(when=((Want("s2"), Want("s0", max_age=1.0, detached=True)),))
    world = World(
        S3,
        rules=(RuleOf(when=on("s0", "s1")), looking),
        inputs=((0.0, ("emit", "s0", 1)), (2.0, ("wipe", "s0")), (0.5, ("emit", "s1", 1))),
    )
    play = Play(world, before=bounded)
    assert runs(play.play()) == []


def test_a_held_spike_counts_against_the_limit_even_if_it_is_too_old_for_each_detached_constraint() -> None:
    # L23: s0 has at most one live spike, so r0 loses the first s0 when the second s0 is born.
    looking = RuleOf(when=((Want("s2"), Want("s0", max_age=1.0, detached=True)),))
    world = World(
        (SignalOf(limit=1), SignalOf(), SignalOf()),
        rules=(RuleOf(when=on("s0", "s1")), looking),
        inputs=(
            (0.0, ("emit", "s0", 1)),
            (2.0, ("emit", "s0", 2)),
            (0.5, ("emit", "s1", 1)),
            (0.5, ("emit", "s1", 1)),
        ),
    )
    play = Play(world)
    assert runs(play.play()) == ["r0"]
    assert play.engine.state.dropped == {"m:s0": 1}


@pytest.mark.parametrize("end", ["resigned", "failed"])
def test_a_rule_that_resigned_does_not_take_the_same_spikes_again(end: str) -> None:
    # L18: a rule that resigned gives up its spikes. Here, a second activation held an older s0 and the same s1.
    world = World(
        (SignalOf(), SignalOf(), SignalOf()),
        V1,
        (RuleOf(when=on("s0", "s1", "s2"), writes=("v0",), acts=(Act(end=end),)),),
        (
            (0.0, ("emit", "s0", 1)),
            (1.0, ("emit", "s0", 2)),
            (1.0, ("emit", "s1", 1)),
            (1.0, ("emit", "s0", 3)),
            (2.0, ("emit", "s2", 1)),
        ),
    )
    Play(world, started=Exclusion()).play()


def test_a_rule_that_hears_the_end_of_pressure_can_itself_be_kept_waiting() -> None:
    # L22, L24: a rule that holds the spike of pressure:false waits, so pressure becomes true. This withdraws the spike,
    # so pressure becomes false again, and so on in the same instant. In the past, `effects` never returned.
    world = World(
        S3,
        V1,
        (
            RuleOf(when=on("s0"), writes=("v0",)),  # waits 1 s for r1
            RuleOf(when=on("s0", "s1"), writes=("v0",)),
            RuleOf(when=on("core:pressure:false", "s2"), writes=("v0",)),  # waits for r3
            RuleOf(when=on("core:pressure:false", "s2", "s1"), writes=("v0",)),
        ),
        ((0.0, ("emit", "s2", 1)), (0.0, ("emit", "s0", 1))),
    )
    Play(world, before=bounded).play()


def test_a_foreground_rule_can_wait_for_the_end_of_activity_and_another_signal() -> None:
    # L22, L24: an activation that holds the spike of activity:false counts as activity, so the same loop arose.
    world = World(
        S3,
        rules=(RuleOf(when=on("s0")), RuleOf(when=on("core:activity:false", "s1"))),
        inputs=((0.0, ("emit", "s0", 1)),),
    )
    Play(world, before=bounded).play()


def test_judging_a_rival_of_several_rules_raises_no_error() -> None:
    # In the past, the judgement changed the members of a group during a loop over them, which raised a RuntimeError.
    world = World(
        S3,
        V1,
        (
            RuleOf(when=on("s0"), writes=("v0",)),
            RuleOf(when=on("s0"), writes=("v0",)),
            RuleOf(when=((Want("s0"), Gate("v0")),), writes=("v0",)),
        ),
        ((0.0, ("emit", "s0", 1)),),
    )
    play = Play(world, before=bounded, started=Exclusion())
    assert runs(play.play()) == ["r0"]
    empty(play)


def test_a_waiting_rule_asks_again_when_its_rival_begins_to_cool_down() -> None:
    # L9, L15: r1 has more utility and holds an s1 that is too young, so r0 waits. Then r1 runs for another cause.
    # From then on its utility is 0, so r0 does not have to wait any more.
    world = World(
        S3,
        V1,
        (
            RuleOf(when=on("s1"), writes=("v0",)),
            RuleOf(when=(*on("s0"), (Want("s1", min_age=1.0),)), writes=("v0",), weight=2.0, cooldown=5.0),
        ),
        ((0.0, ("emit", "s1", 1)), (0.5, ("emit", "s0", 1))),
    )
    play = Play(world, before=bounded).play()
    assert next(line for line in play.heard if "<rule m:r0>" in line).startswith("0.5 s < Run(")


def test_a_waiting_rule_asks_again_when_its_ready_rival_loses_a_spike_of_another_cause() -> None:
    # L15, L16: r0 waits for r1, which holds s0 and s1; and r1 waits for r2, which also holds s1. When r2 is done, s1 is
    # consumed, so r1 lacks s1 again. The patience of r1 for s0 began at 0 s, when r1 first lacked s1, and is over. In
    # the past, r0 did not ask again, because r0 belongs only to the group of s0. So r0 waited for ever.
    def lasting(*signals: str) -> tuple[tuple[Want, ...], ...]:
        return (tuple(Want(signal, max_age=None) for signal in signals),)

    world = World(
        S3,
        V1,
        (
            RuleOf(when=lasting("s0"), writes=("v0",)),
            RuleOf(when=lasting("s0", "s1"), writes=("v0",)),
            RuleOf(when=lasting("s1", "s2"), writes=("v0",), acts=(Act(seconds=3.0),), weight=3.0),
        ),
        (
            (0.0, ("emit", "s0", 1)),
            (0.5, ("emit", "s2", 1)),
            (0.0, ("emit", "s1", 1)),
            (0.5, ("emit", "s2", 1)),
        ),
    )
    play = Play(world).play()
    assert runs(play) == ["r2", "r0"]
    assert next(line for line in play.heard if "<rule m:r0>" in line).startswith("3.5 s < Run(")
    assert not play.engine.state.waiting


def test_a_waiting_rule_asks_again_when_its_rival_takes_a_spike_that_no_other_can_join() -> None:
    # L12, L16: both constraints on s1 need spikes of one causal group. Once r1 holds an s1 that meets only one of them,
    # r1 is no longer viable, because a new input never joins an existing group.
    world = World(
        S3,
        V1,
        (
            RuleOf(when=on("s0"), writes=("v0",)),
            RuleOf(when=((Want("s0"), Want("s1", where="odd"), Want("s1")),), writes=("v0",)),
        ),
        ((0.0, ("emit", "s0", 1)), (0.5, ("emit", "s1", 2))),
    )
    play = Play(world, before=bounded).play()
    assert next(line for line in play.heard if "<rule m:r0>" in line).startswith("0.5 s < Run(")


def test_a_waiting_rule_asks_again_when_a_rule_is_no_longer_live_for_another_cause() -> None:
    # L16 (iii): r1 lacks v0:false. Rules r0 and r1 might cause it while they are live for another cause. At 3 s, their
    # patience there ends, and r0 runs. From then on, they are live for no other cause. In the past, the engine noticed
    # this only when a rule's last activation ended. Here, the waiting activation had not ended.
    world = World(
        S3,
        (SlotOf("flag"),),
        (
            RuleOf(when=on("s0"), writes=("v0",)),
            RuleOf(when=((Want("s0"), Want("v0:false", detached=True)),), writes=("v0",), patience=3.0),
        ),
        ((0.0, ("emit", "s0", 0)), (0.0, ("emit", "s0", 1)), (1.0, ("emit", "s0", 2))),
        together=True,
    )
    play = Play(world).play()
    assert [line.split(" s <")[0] for line in play.heard if "< Run(" in line] == ["3", "3", "3"]


@pytest.mark.parametrize("traced", [False, True])
@pytest.mark.parametrize("wiped", [False, True])
def test_a_rule_without_an_activation_gives_a_withdrawn_spike_up_too(traced: bool, wiped: bool) -> None:
    # L20, L25: with a tracer, r1 has an activation, and this activation loses the spike. Without a tracer, r1 has no
    # activation yet, but it must lose the spike as well.
    world = World(
        (SignalOf(keep="latest"),),
        V1,
        (
            RuleOf(when=on("s0"), writes=("v0",), thread=True, acts=(Act(seconds=1.0, end="resigned"), Act())),
            RuleOf(when=on("s0"), writes=("v0",)),
        ),
        ((0.0, ("emit", "s0", 1)), (0.5, ("wipe", "s0") if wiped else ("emit", "s0", 2))),
    )
    play = Play(world, traced=traced).play()
    assert runs(play) == (["r0"] if wiped else ["r0", "r0"])


def test_a_spike_of_another_cause_gives_a_rival_no_stake() -> None:
    # L15, L16: for the cause of s1, r0 is a rival of r2 only if r1 raises s2. To raise it, r1 needs an input, so
    # patience bounds the wait. Rule r0 also runs for another cause, but the s2 of that cause gives r0 no stake here.
    world = World(
        S3,
        V1,
        (
            RuleOf(when=on("s2"), writes=("v0",), acts=(Act(seconds=10.0),)),
            RuleOf(when=((Want("s1"), Want("s0", detached=True)),), emits=("s2",)),
            RuleOf(when=on("s1"), writes=("v0",)),
        ),
        ((0.0, ("emit", "s2", 1)), (0.0, ("emit", "s1", 1))),
    )
    play = Play(world).play()
    assert next(line for line in play.heard if "<rule m:r2>" in line).startswith("1 s < Run(")


def test_a_spike_that_an_added_rule_can_look_back_at_is_dropped_in_time() -> None:
    # L23: the added rule looks back at s0 for 2 s, also at a spike that was born before. At 2 s, nothing holds the
    # spike.
    looking = RuleOf(when=((Want("s1"), Want("s0", max_age=2.0, detached=True)),))
    world = World(
        S3,
        rules=(RuleOf(when=on("s0")),),
        inputs=((0.0, ("emit", "s0", 1)), (0.0, ("add", looking))),
        together=True,
    )
    play = Play(world).play()
    play.settle(100.0)
    empty(play)


def test_a_waiting_rule_asks_again_when_the_rule_that_it_waits_for_retires() -> None:
    # L16, L18: r2 waits for r1, because r0 runs and may still raise s0 for r1. At 0.25 s, r1 retires after a run for
    # another cause, so r2 has nothing to wait for.
    world = World(
        (SignalOf(),),
        V1,
        (
            RuleOf(when=on("v0:changed"), emits=("s0",), acts=(Act(seconds=1.0),)),
            RuleOf(when=on("s0"), writes=("v0",), acts=(Act(seconds=0.25, end="retired"),)),
            RuleOf(when=on("v0:changed"), writes=("v0",)),
        ),
        ((0.0, ("emit", "s0", 1)), (0.0, ("write", "v0", 1))),
    )
    play = Play(world).play()
    assert next(line for line in play.heard if "<rule m:r2>" in line).startswith("0.25 s < Run(")


def test_a_predicate_that_raises_in_a_snapshot_is_not_a_failure_of_its_rule() -> None:
    # L24, L25: a snapshot tests the predicates on slots. If one of them raises during a snapshot, it is not reported.
    world = World(S3, V1, (RuleOf(when=((Want("s0"), Gate("v0", "fussy")),)),), ((0.0, ("write", "v0", 2)),))
    play = Play(world).play()
    snapshot(play.engine)
    explain(play.engine, play.engine.policy.rule_plan("m:r0"))
    play.tell(("write", "v0", 1))
    assert "Failed" not in "".join(play.heard)


def test_a_replay_takes_the_effects_at_the_same_points_as_the_runtime() -> None:
    # L24: r0 ends within its first step, so no rule has to wait, and pressure stays false. If a replay also took the
    # effects before the end of this run, r2 would wait, and pressure would become true.
    world = World(
        S3,
        V1,
        (
            RuleOf(when=on("s0"), emits=("s1",)),
            RuleOf(when=on("s1"), writes=("v0",)),
            RuleOf(when=on("s0"), writes=("v0",)),
            RuleOf(when=on("core:pressure:true")),
        ),
        ((0.0, ("emit", "s0", 1)),),
    )
    play = Play(world).play()
    assert play.policy is not None
    engine = Engine(play.policy, patience=world.patience, report_ends=True)
    taken = replay(engine, [Entry(time, event) for time, event in play.journal])
    assert repr(taken) == repr(play.taken)
    assert "r3" not in runs(play)


# ---------------------------------------------------------------------------- the engine against an interpreter of the laws


def moments(world: World, rule: str) -> list[float]:
    """Return when a rule was called (seconds)."""
    lines = [line for line in Play(world).play().heard if "< Run(" in line and f"<rule m:{rule}>" in line]
    return [float(line.split(" s ")[0]) for line in lines]


OUT = (SlotOf(),)


def test_a_younger_activation_is_under_pressure_even_if_its_rule_has_an_older_activation() -> None:
    # L16: s1 comes at 0 s, and s0 at 0.703 s and 2.139 s. At 2.139 s, the younger activation of r0 lacks s1, so it
    # comes under pressure.
    world = World(
        S3,
        OUT,
        (
            RuleOf(when=((Want("s1"), Want("s0", min_age=1.916)),), writes=("v0",)),
            RuleOf(when=on("s0"), writes=("v0",)),
        ),
        ((0.0, ("emit", "s1", 1)), (0.703, ("emit", "s0", 1)), (1.436, ("emit", "s0", 2))),
    )
    assert moments(world, "r0") == [pytest.approx(2.619)]
    assert moments(world, "r1") == [pytest.approx(3.139)]


def test_a_rule_that_waits_for_the_asking_rule_makes_no_rival_viable() -> None:
    # L16: r0 lacks s1, and only r2 raises s1. But r2 waits for r1, so r1 must not wait for r0.
    world = World(
        S3,
        OUT,
        (
            RuleOf(when=on("s1", "s2"), writes=("v0",)),
            RuleOf(when=on("s2"), writes=("v0",)),
            RuleOf(when=on("s2"), writes=("v0",), emits=("s1",), detached=True),
        ),
        ((0.0, ("emit", "s2", 1)),),
    )
    assert moments(world, "r1") == [0.0]


def test_patience_begins_when_a_rival_in_stand_by_first_lacks_an_input() -> None:
    # L16: r1 raises s2 only after 969 ms, but r2 lacks the input s0 from the start. So r0 waits for 1 s in all.
    world = World(
        S3,
        OUT,
        (
            RuleOf(when=on("s1"), writes=("v0",)),
            RuleOf(when=on("s1"), emits=("s2",), acts=(Act(((0.969, ("emit", "s2", 1)),)),)),
            RuleOf(when=on("s2", "s0"), writes=("v0",)),
        ),
        ((0.0, ("emit", "s1", 1)),),
    )
    assert moments(world, "r0") == [1.0]


def test_a_rule_that_recovers_faster_from_0_overtakes_immediately() -> None:
    # L15: both rules have run at 2.644 s. Because r1 recovers faster, it runs a second time in the same instant.
    world = World(
        S3,
        OUT,
        (
            RuleOf(when=((Want("s0", min_age=1.925),),), writes=("v0",), cooldown=20.0),
            RuleOf(when=on("s0"), writes=("v0",), cooldown=5.0),
        ),
        ((0.719, ("emit", "s0", 1)), (0.003, ("emit", "s0", 2)), (0.574, ("emit", "s0", 3))),
    )
    assert moments(world, "r0") == [pytest.approx(2.644)]
    assert moments(world, "r1") == [pytest.approx(2.644), pytest.approx(2.644)]


def test_a_rule_that_writes_nothing_frees_its_spike_when_it_starts() -> None:
    # L10: two activations of r0 hold the first s1. When one of them starts, the other loses this s1, and so can take
    # the second s1.
    world = World(
        S3,
        (),
        (RuleOf(when=on("s0", "s1"), acts=(Act(seconds=2.0),)),),
        ((0.0, ("emit", "s0", 1)), (0.0, ("emit", "s0", 2)), (0.5, ("emit", "s1", 1)), (0.5, ("emit", "s1", 2))),
    )
    assert moments(world, "r0") == [0.5, 1.0]


def test_a_detached_constraint_holds_the_newest_spike_until_its_rule_runs() -> None:
    # L19: at 1 s, r0 runs with the second s1.
    world = World(
        S3,
        (),
        (RuleOf(when=((Want("s0", min_age=1.0), Want("s1", detached=True)),)),),
        ((0.0, ("emit", "s0", 1)), (0.25, ("emit", "s1", 1)), (0.25, ("emit", "s1", 2))),
    )
    [call] = [line for line in Play(world).play().heard if "< Run(" in line]
    assert "'m:s1': 2" in call


def test_a_detached_constraint_takes_a_newer_spike_as_soon_as_it_is_old_enough() -> None:
    # L19: the second s1 is old enough at 1.25 s, and r1 is kept waiting until 2 s. So r1 runs with the second s1.
    world = World(
        S3,
        OUT,
        (
            RuleOf(when=on("s0"), writes=("v0",), weight=5.0, acts=(Act(seconds=2.0, end="resigned"),)),
            RuleOf(when=((Want("s0"), Want("s1", min_age=1.0, detached=True)),), writes=("v0",)),
            RuleOf(when=on("s2")),
        ),
        ((0.0, ("emit", "s0", 1)), (0.0, ("emit", "s1", 1)), (0.25, ("emit", "s1", 2))),
    )
    [call] = [line for line in Play(world).play().heard if "< Run(" in line and "<rule m:r1>" in line]
    assert "'m:s1': 2" in call


def test_the_signals_of_one_slot_cohere() -> None:
    # L12: `changed` of the first write and `true` of the second write must not join.
    world = World(
        S3,
        (SlotOf("flag", always=True),),
        (RuleOf(when=(((Want("v0:changed", max_age=None), Want("v0:true", max_age=None))),)),),
        ((0.0, ("write", "v0", False)), (0.5, ("write", "v0", True))),
    )
    assert moments(world, "r0") == [0.5]
    play = Play(world).play()
    [run] = [line for line in play.heard if "< Run(" in line]
    assert "'m:v0:changed': True" in run


def test_events_of_one_instant_count_in_the_order_in_which_they_arrive() -> None:
    # L21: r0 begins after the first s1 was born, so only the second s1 ends r0. If all three spikes arrive before r0
    # can begin, none of them ends it.
    world = World(
        S3,
        OUT,
        (RuleOf(when=on("s0"), writes=("v0",), until=on("s1"), acts=(Act(seconds=1.0),)),),
        ((0.0, ("emit", "s0", 1)), (0.0, ("emit", "s1", 1)), (0.0, ("emit", "s1", 2))),
    )
    play = Play(world).play()
    assert [line.split(" < ")[1][:6] for line in play.heard if " < " in line and "Ended" not in line] == [
        "Run(ru",
        "Cancel",
    ]
    together = World(world.signals, world.slots, world.rules, world.inputs, together=True)
    assert not any("Cancel" in line for line in Play(together).play().heard)


def test_several_stalemates_in_one_instant_are_all_broken() -> None:
    # L15: for each of the two inputs, r1 waits for r0, which may get its signal from r3. And r3 waits for r2, which may
    # get its signal from r1.
    world = World(
        S3,
        (SlotOf(), SlotOf()),
        (
            RuleOf(when=on("v1:changed"), writes=("v0",)),
            RuleOf(when=on("s1"), writes=("v0",), emits=("s0",)),
            RuleOf(when=on("s0"), writes=("v1",)),
            RuleOf(when=on("s1"), writes=("v1",), acts=(Act(seconds=0.5),)),
        ),
        ((0.0, ("emit", "s1", 1)), (0.0, ("emit", "s1", 2))),
        together=True,
    )
    assert moments(world, "r1") == [0.0, 0.0]


def test_a_detached_clause_keeps_a_spike_with_which_another_clause_of_its_rule_runs() -> None:
    # L10, L19: the other clause runs at 0 s. The detached clause still sees the same spike at 0.5 s.
    world = World(
        S3,
        (),
        (RuleOf(when=((Want("s0", min_age=0.5, detached=True),), (Want("s0"),))),),
        ((0.0, ("emit", "s0", 1)),),
    )
    assert moments(world, "r0") == [0.0, 0.5]


def test_an_added_rule_takes_a_spike_older_than_itself_once_the_spike_is_old_enough() -> None:
    # L19: r0 keeps both spikes of s0 alive. r1 is added at 0.75 s, and at first holds the first s0. At 1.5 s, the
    # second s0 is old enough too, so r1 must hold it instead.
    looking = RuleOf(when=((Want("s0", min_age=1.0, detached=True), Want("s1", min_age=0.5)),))
    world = World(
        S3,
        rules=(RuleOf(when=on("s0"), acts=(Act(seconds=4.0),)),),
        inputs=(
            (0.0, ("emit", "s0", 1)),
            (0.5, ("emit", "s0", 2)),
            (0.25, ("add", looking)),
            (0.375, ("emit", "s1", 0)),
        ),
    )
    [call] = [line for line in Play(world).play().heard if "< Run(" in line and "<rule m:r1>" in line]
    assert call.startswith("1.625 s") and "'m:s0': 2" in call


def test_a_rule_asks_again_when_a_rival_that_another_rival_depends_on_gives_up() -> None:
    # L15, L16: r0 is a rival of r1, because r0 might get s1 from r2. But r2 lacks the input v2:changed and has a
    # patience of 0 s. So r2 gives up immediately, and r1 must ask again.
    world = World(
        S3,
        (SlotOf(), SlotOf(), SlotOf()),
        (
            RuleOf(when=on("s1"), writes=("v1",)),
            RuleOf(when=on("s0"), writes=("v0", "v1")),
            RuleOf(when=on("s0", "v2:changed"), writes=("v0",), emits=("s1",), patience=0.0),
        ),
        ((0.0, ("emit", "s0", 2)),),
    )
    assert moments(world, "r1") == [0.0]


def test_an_activation_that_has_taken_another_spike_asks_at_the_turn_of_its_new_cause() -> None:
    # L12, L15: at 1.25 s, the first activation of r2 runs and writes v0. The second activation loses its spikes,
    # and takes the last s1 of 0 s and the new write. In the past, it kept the turn of its old cause. But the s1 of
    # 0.75 s was caused by the s0 of 0 s, which came before the last s1 of 0 s. So the activation with the s1 of 0.75 s
    # goes first.
    world = World(
        S3,
        V1,
        (
            RuleOf(when=on("s1"), emits=("s1",), acts=(Act(((0.0, ("emit", "s1", 0)),)),)),
            RuleOf(when=on("s0"), emits=("s1",), acts=(Act(((0.75, ("emit", "s1", 1)),)),)),
            RuleOf(
                when=((Want("s0", min_age=1.25, detached=True), Want("s1"), Want("v0:changed")),),
                writes=("v0",),
                acts=(Act(((0.0, ("write", "v0", 0)),)),),
                detached=True,
            ),
        ),
        ((0.0, ("emit", "s1", 0)), (0.0, ("emit", "s0", 1)), (0.0, ("write", "v0", 2)), (0.0, ("emit", "s1", 0))),
    )
    calls = [line for line in Play(world).play().heard if "< Run(" in line and "<rule m:r2>" in line]
    assert ["'m:s1': 1" in call for call in calls] == [False, True]


def test_a_stalemate_in_which_two_activations_can_help_the_same_rule_is_broken() -> None:
    # L15: r1 waits for r3, which may get s2 from either of two activations of r2. But both of them wait for r0, which
    # may get s2 from r1.
    world = World(
        (*S3, SignalOf()),
        (SlotOf(), SlotOf(), SlotOf()),
        (
            RuleOf(when=on("s2"), writes=("v2",)),
            RuleOf(when=((Want("s0", min_age=0.75),),), writes=("v1",), emits=("s2",)),
            RuleOf(
                when=on("s0", "s3"),
                writes=("v2",),
                emits=("s2",),
                acts=(Act(((0.0, ("emit", "s2", 1)), (1.5, ("write", "v2", 0)))),),
            ),
            RuleOf(
                when=on("s2"),
                writes=("v1",),
                emits=("s0",),
                acts=(Act(((1.375, ("emit", "s0", 0)),)),),
                detached=True,
            ),
        ),
        ((0.0, ("emit", "s0", 2)), (0.0, ("emit", "s3", 1)), (0.0, ("emit", "s3", 0))),
    )
    assert moments(world, "r2") == [0.75, 2.875]


def test_utilities_that_differ_only_by_a_rounding_error_count_as_equal() -> None:
    # L9, L15: the utility of r1 is rounded and then doubled by its weight. The utility of r6 is the sum of two such
    # numbers. Both count as equal, so r1 goes first, because it is declared first.
    world = World(
        (SignalOf(input=True), *S3),
        (SlotOf(), SlotOf(), SlotOf("flag", always=True)),
        (
            RuleOf(when=on("s1")),
            RuleOf(when=on("s0"), writes=("v1",), weight=2.0),
            RuleOf(when=on("s3"), emits=("s0",), acts=(Act(((0.0, ("emit", "s0", 0)),)),)),
            RuleOf(when=on("s0"), emits=("s3",)),
            RuleOf(when=on("s2")),
            RuleOf(when=on("v2:false"), emits=("s3",), acts=(Act(((0.0, ("emit", "s3", 1)),)),)),
            RuleOf(when=on("s0", "s3"), writes=("v1",)),
        ),
        ((0.0, ("write", "v2", False)),),
    )
    play = Play(world).play()
    first, second = (play.engine.policy.rule_plan(f"m:r{n}").clauses[0] for n in (1, 6))
    assert first.base == second.base
    assert "r6" not in runs(play)


def test_a_clause_that_recovers_faster_from_0_runs_even_if_a_slower_clause_could_help_a_rival() -> None:
    # L15, L16: after a run of r2, both its clauses are worth 0, but the second one recovers faster. So the first clause
    # waits for the second from this moment on, and cannot make a rival of the second clause viable.
    rules = (
        RuleOf(
            when=on("s1", "s0"),
            writes=("v0",),
            emits=("s1",),
            acts=(Act(steps=((0.0, ("emit", "s1", 1)), (0.0, ("write", "v0", 0)), (0.0, ("emit", "s1", 2)))),),
            detached=True,
        ),
        RuleOf(when=on("v0:changed"), writes=("v0",), emits=("s1",), acts=(Act(steps=((0.0, ("write", "v0", 1)),)),)),
    )
    added = RuleOf(
        when=((Want("s1"),), (Want("s1"), Gate("v0"))),
        writes=("v0",),
        emits=("s0",),
        detached=True,
        weight=2.0,
        cooldown=2.0,
    )
    inputs = ((0.5, ("emit", "s1", 2)), (0.0, ("add", added)), (0.0, ("emit", "s0", 1)))
    world = World((SignalOf(), SignalOf(input=True)), (SlotOf(always=True),), rules, inputs)
    play = Play(world).play()
    starts = [line.split(" s <")[0] for line in play.heard if "< Run(" in line]
    assert (runs(play), starts) == (["r0", "r1", "r2", "r2"], ["0.5"] * 4)


def test_a_younger_activation_is_under_no_pressure_if_an_older_one_holds_the_same_spike() -> None:
    # L15, L16: an older activation of r1 also holds this spike, and will run. So r0 waits in any case, and the younger
    # activation is under no pressure. It gets the s1 of 2.5 s.
    rules = (
        RuleOf(when=on("s0"), writes=("v0",)),
        RuleOf(when=on("s0", "s1"), writes=("v0",), acts=(Act(seconds=2.0),)),
    )
    inputs = (
        (1.1, ("emit", "s0", 3)),
        (0.0, ("emit", "s1", 1)),
        (0.3, ("emit", "s0", 1)),
        (1.1, ("emit", "s1", 3)),
    )
    play = Play(World((SignalOf(), SignalOf()), (SlotOf(), SlotOf()), rules, inputs)).play()
    assert runs(play) == ["r1", "r1"]


def test_a_rival_that_overtakes_a_waiting_rule_comes_under_pressure_at_that_moment() -> None:
    # L15, L16: while r0 waits for a taken slot, r1 recovers and overtakes r0. From this moment, r1 keeps r0 waiting, so
    # its patience begins. It is 0 s, so r1 gives its spike up immediately.
    rules = (
        RuleOf(when=on("s0", "s1"), writes=("v0",), acts=(Act(seconds=2.0),)),
        RuleOf(when=((Want("s0"), Want("s3", where="odd")),), writes=("v0",), cooldown=3.0, patience=0.0),
    )
    inputs = (
        (1.1, ("emit", "s0", 2)),
        (0.0, ("emit", "s0", 2)),
        (0.0, ("emit", "s0", 2)),
        (0.0, ("emit", "s3", 3)),
        (0.0, ("emit", "s1", 3)),
        (2.1, ("emit", "s3", 3)),
    )
    play = Play(World((*S3, SignalOf()), V1, rules, inputs)).play()
    assert runs(play) == ["r1", "r0"]


def test_a_burst_for_rules_of_one_slot_is_answered_in_order() -> None:
    # L15: older causes go first. All runs write the same slot, so each round of consent lets only one of them start.
    world = World(S3, V1, (RuleOf(when=on("s0"), writes=("v0",)),), ((0.0, ("emit", "s0", 0)),) * 50, together=True)
    play = Play(world, budget=50).play()
    assert runs(play) == ["r0"] * 50
    assert not play.engine.parts.agenda.places


def test_a_rule_without_an_activation_puts_its_rival_under_pressure_from_the_first_moment() -> None:
    # L15, L16: r0 keeps the best rule r2 waiting, and r1 keeps r3 waiting. The patience of r0 and r1 ends at 1 s. Then
    # r2 runs and resigns, so r3 runs in the same instant.
    rules = (
        RuleOf(when=on("s0", "s1"), writes=("v0",), weight=10.0),
        RuleOf(when=on("s0", "s2"), writes=("v0",)),
        RuleOf(when=on("s0"), writes=("v0",), weight=20.0, acts=(Act(end="resigned"),)),
        RuleOf(when=on("s0"), writes=("v0",), weight=0.1),
        RuleOf(when=on("s3")),
    )
    play = Play(World((*S3, SignalOf()), V1, rules, ((0.0, ("emit", "s0", 0)),))).play()
    starts = [line.split(" s <")[0] for line in play.heard if "< Run(" in line]
    assert (runs(play), starts) == (["r2", "r3"], ["1", "1"])


def test_the_patience_of_a_rival_ends_even_if_no_rule_waited_for_it_meanwhile() -> None:
    # L16: r1 puts r0 under pressure until 3 s, and then loses s1 for a while. In the past, the engine then forgot the
    # end of the patience.
    rules = (RuleOf(when=((Want("s0"), Want("s1", where="odd")),), writes=("v0",), patience=2.0),)
    inputs = (
        (1.0, ("add", RuleOf(when=on("s1", "s0"), writes=("v0",)))),
        (0.0, ("emit", "s1", 2)),
        (0.0, ("emit", "s0", 0)),
        (0.0, ("wipe", "s1")),
        (0.3, ("emit", "s1", 0)),
    )
    play = Play(World((SignalOf(), SignalOf()), V1, rules, inputs)).play()
    assert [line.split(" s <")[0] for line in play.heard if "< Run(" in line] == ["3"]


def test_no_rule_answers_a_cause_that_has_merged_with_an_answered_cause() -> None:
    # L11, L18: r1 has answered the first cause, and r2 joins the second cause to the first. So after r3 resigns, r0
    # must not run.
    rules = (
        RuleOf(when=on("s0"), writes=("v0",)),
        RuleOf(when=on("s2"), writes=("v0",)),
        RuleOf(when=on("s2", "s0"), writes=("v1",), emits=("s1",), acts=(Act(steps=((0.0, ("emit", "s1", 1)),)),)),
        RuleOf(when=on("s0"), writes=("v0",), acts=(Act(end="resigned"),), weight=2.0),
    )
    inputs = ((0.0, ("emit", "s2", 1)), (1.0, ("emit", "s0", 3)))
    play = Play(World(S3, (SlotOf(), SlotOf()), rules, inputs)).play()
    assert runs(play) == ["r1", "r2", "r3"]


def test_a_rival_that_takes_an_input_of_another_group_is_under_pressure_from_that_moment() -> None:
    # L16: r2 stands by when r1 puts it under pressure at 0 s. Then r2 gets an activation, which takes the place of the
    # stand-by and comes under pressure immediately. So the patience of both ends at 1 s.
    rules = (
        RuleOf(when=on("s1", "s2"), emits=("s0",)),
        RuleOf(when=on("s2"), writes=("v0",)),
        RuleOf(when=on("s0", "s3"), writes=("v0",)),
    )
    inputs = ((0.0, ("emit", "s2", 0)), (0.0, ("emit", "s3", 2)))
    play = Play(World((*S3, SignalOf()), V1, rules, inputs)).play()
    assert [line.split(" s <")[0] for line in play.heard if "< Run(" in line] == ["1"]


def test_several_rules_can_give_up_a_shared_spike_one_after_another() -> None:
    # L16: r0, r1 and r2 come under pressure for the second s0 at different moments. When the engine judges them next,
    # the patience of all three is over. The first rule that gives the spike up can remove it from their shared table.
    odd = ((Want("s0"), Want("s1", where="odd")),)
    rules = (
        RuleOf(when=((Want("s0", max_age=None), Want("s1")),), writes=("v0",), acts=(Act(seconds=2.0),)),
        RuleOf(when=odd, writes=("v0",), acts=(Act(seconds=2.0),), weight=0.5),
        RuleOf(when=odd, writes=("v0",), acts=(Act(seconds=2.0, end="resigned"),)),
        RuleOf(when=on("s0", "s1"), writes=("v0",), acts=(Act(end="resigned"),), weight=2.0),
    )
    inputs = (
        (0.3, ("emit", "s1", 3)),
        (0.0, ("emit", "s0", 1)),
        (1.1, ("emit", "s0", 0)),
        (1.0, ("wipe", "s1")),
        (1.1, ("emit", "s1", 2)),
    )
    assert runs(Play(World(S3[:2], V1, rules, inputs)).play()) == ["r2", "r1", "r3", "r0"]


def test_activations_that_wait_for_one_rule_to_recover_ask_in_the_same_instant() -> None:
    # L15: at 3.5 s, r0 has recovered to the weight of r1. Two activations of r0 wait for this moment. They began
    # to wait at different times.
    ripe = ((Want("s0", min_age=1.0),),)
    again = (Act(((0.0, ("emit", "s0", 2)),)),)
    rules = (
        RuleOf(when=on("s0"), writes=("v0",), cooldown=5.0),
        RuleOf(when=ripe, writes=("v0",), emits=("s0",), acts=again, detached=True, weight=0.5),
    )
    inputs = ((1.0, ("emit", "s0", 0)), (0.0, ("emit", "s0", 2)), (1.5, ("emit", "s0", 2)))
    assert difference(World(S3[:1], V1, rules, inputs)) == ""


def test_predicates_that_fail_are_reported_rule_by_rule_in_the_order_of_their_calls() -> None:
    # L5: `choosy` first fails for r1. But r0 is declared first, and for r0 `fussy` fails before `choosy`.
    both = "fussy choosy"
    world = World(
        S3,
        rules=(RuleOf(when=((Want("s2", where=both),),)), RuleOf(when=((Want("s0", where=both),),))),
        inputs=((0.0, ("emit", "s0", 1)), (0.0, ("emit", "s2", 2)), (0.0, ("emit", "s2", 1))),
        together=True,
    )
    assert not difference(world)
