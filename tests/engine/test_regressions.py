"""Faults that random worlds have found: the smallest example of each, and the law that it broke.

Each world was shrunk from one that a property test had made.
"""

from __future__ import annotations

import pytest

from properties.oracle import Exclusion, bounded, empty
from properties.worlds import Act, Gate, Play, RuleOf, SignalOf, SlotOf, Want, World
from ravestate.engine.engine import Engine
from ravestate.engine.explain import explain
from ravestate.engine.snapshot import snapshot
from ravestate.runtime.journal import Entry, replay

S3 = (SignalOf(), SignalOf(), SignalOf())
V1 = (SlotOf(),)


def on(*signals: str) -> tuple[tuple[Want, ...], ...]:
    """Return a condition of one conjunction."""
    return (tuple(Want(signal) for signal in signals),)


def runs(play: Play) -> list[str]:
    """Return the rules that were called, in order."""
    return [line.split("<rule m:")[1].split(">")[0] for line in play.heard if "< Run(" in line]


def test_a_spike_that_is_held_is_wiped_even_if_detached_needs_have_forgotten_it() -> None:
    # L20: wiping withdraws the live spikes. A detached need looks back 1 s; the first rule holds the spike longer.
    looking = RuleOf(when=((Want("s2"), Want("s0", max_age=1.0, detached=True)),))
    world = World(
        S3,
        rules=(RuleOf(when=on("s0", "s1")), looking),
        inputs=((0.0, ("emit", "s0", 1)), (2.0, ("wipe", "s0")), (0.5, ("emit", "s1", 1))),
    )
    play = Play(world, before=bounded)
    assert runs(play.play()) == []


def test_a_held_spike_counts_against_its_limit_after_detached_needs_have_forgotten_it() -> None:
    # L23: at most one live spike of s0, so the second pushes the first out of the first rule's hands.
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
    assert play.engine.dropped == {"m:s0": 1}


@pytest.mark.parametrize("end", ["resigned", "failed"])
def test_a_rule_that_resigned_does_not_take_the_same_spikes_again(end: str) -> None:
    # L18: the rule gives up these spikes. Another activation of it held the older s0 and the same s1.
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


def test_a_rule_that_hears_pressure_end_may_itself_be_kept_waiting() -> None:
    # L22, L24: holding the spike of pressure:false makes it wait, which makes pressure true, which withdraws the
    # spike, which makes pressure false, ... all in one instant: `effects` never returned.
    world = World(
        S3,
        V1,
        (
            RuleOf(when=on("s0"), writes=("v0",)),  # waits 1 s for the next rule
            RuleOf(when=on("s0", "s1"), writes=("v0",)),
            RuleOf(when=on("core:pressure:false", "s2"), writes=("v0",)),  # waits for the last
            RuleOf(when=on("core:pressure:false", "s2", "s1"), writes=("v0",)),
        ),
        ((0.0, ("emit", "s2", 1)), (0.0, ("emit", "s0", 1))),
    )
    Play(world, before=bounded).play()


def test_a_foreground_rule_may_wait_for_the_end_of_activity_and_more() -> None:
    # L22, L24: as above; holding the spike of activity:false is activity.
    world = World(
        S3,
        rules=(RuleOf(when=on("s0")), RuleOf(when=on("core:activity:false", "s1"))),
        inputs=((0.0, ("emit", "s0", 1)),),
    )
    Play(world, before=bounded).play()


def test_the_best_of_a_conflict_set_may_be_judged_against_a_rival() -> None:
    # Unfolding the alternatives in a loop over the members of their group was a RuntimeError.
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
    # L9, L15: r1 waits to ripen on v0:changed and is worth more, so r0 waits; then r1 runs on another cause, is worth
    # nothing from then on, and nobody is left for whom r0 would have to wait.
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
    # L15, L16: r1 holds s0 and s1 and waits for r2, which writes for s1; r0 waits for r1. When r2 is done, s1 is
    # consumed, and r1 lacks it. Its patience for s0 began at 0 s, when it lacked s1 for the first time, and is over. But
    # r0 did not ask again, as its group is that of s0 alone, and waited for ever.
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
    assert not play.engine.waiting


def test_a_waiting_rule_asks_again_when_its_rival_takes_a_spike_that_cannot_be_joined() -> None:
    # L12, L16: two constraints on s1 want one causal group. With an s1 that fulfils one of them and not the other, the
    # rival is viable no longer: an input cannot come into a group that is there already.
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


def test_a_waiting_rule_asks_again_when_the_rule_that_was_live_elsewhere_is_not() -> None:
    # L16 (iii): r1 lacks v0:false, which r0 and r1 might cause as long as they are live for another cause. At 3 s they have
    # had their patience there, and r0 runs; from then on they are live nowhere else. Only the end of a rule's last
    # activation was noticed, and there is still the one that waits.
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
def test_an_alternative_gives_a_withdrawn_spike_up(traced: bool, wiped: bool) -> None:
    # L20, L25: r1 would have lost the spike if its activation had been made, as it is when somebody traces.
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


def test_a_stand_by_rival_is_not_made_firm_by_a_spike_of_another_cause() -> None:
    # L15, L16: for the cause of s1, r0 is a rival only if r1 raises s2, which wants an input; so patience bounds it. The
    # s2 on which it runs for another cause does not give it a stake here.
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


def test_a_spike_that_a_new_rule_may_look_back_at_is_forgotten_in_time() -> None:
    # L23: it was born before the rule that looks back at s0 for 2 s was added, and nobody held it at 2 s.
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
    # L16, L18: r0 runs and may yet raise s0 for r1, for which r2 waits; at 0.25 s r1 retires, after a run for another cause.
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


def test_looking_at_a_predicate_that_fails_is_no_failure_of_the_rule() -> None:
    # L24, L25: a snapshot says of each gate whether it is open; that a predicate cannot tell is not an effect.
    world = World(S3, V1, (RuleOf(when=((Want("s0"), Gate("v0", "fussy")),)),), ((0.0, ("write", "v0", 2)),))
    play = Play(world).play()
    snapshot(play.engine)
    explain(play.engine, play.engine.policy.rule_plan("m:r0"))
    play.tell(("write", "v0", 1))
    assert "Failed" not in "".join(play.heard)


def test_replay_takes_effects_when_the_runtime_took_them() -> None:
    # L24. The classifier ends within its first step, so nobody is ever kept waiting, and pressure stays false; a
    # replay that asks for effects once more before it feeds the end makes the fallback wait, and pressure true.
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
