"""Random worlds: the engine and the interpreter of the laws have the same effects at the same times.

These tests play the same seeds each time. `make fuzz` plays new seeds.
"""

from __future__ import annotations

import pytest

from properties.crowd_worlds import crowd_world_of
from properties.fuzz import any_world_of, difference, observation, verdict
from properties.pair_worlds import pair_world_of
from properties.random_worlds import world_of
from properties.shrinking import shrink
from properties.variations import varied
from properties.worlds import Act, Gate, RuleOf, SignalOf, SlotOf, Want, World

SEEDS = 2_000
PAIR_SEEDS = 400
CROWD_SEEDS = 400
OBSERVED_SEEDS = 1_200
PARTS = 20


@pytest.mark.parametrize("part", range(PARTS))
def test_the_engine_follows_the_laws(part: int) -> None:
    for seed in range(part, SEEDS, PARTS):
        check(varied(world_of(seed), seed), seed)


@pytest.mark.parametrize("part", range(PARTS))
def test_the_engine_follows_the_laws_where_pairs_compete(part: int) -> None:
    for seed in range(part, PAIR_SEEDS, PARTS):
        check(varied(pair_world_of(seed), seed), seed)


@pytest.mark.parametrize("part", range(PARTS))
def test_the_engine_follows_the_laws_where_many_rules_react_to_one_input(part: int) -> None:
    for seed in range(part, CROWD_SEEDS, PARTS):
        check(varied(crowd_world_of(seed), seed), seed)


@pytest.mark.parametrize("part", range(PARTS))
def test_a_tracer_changes_nothing_and_journals_replay_with_and_without_a_tracer(part: int) -> None:
    for seed in range(part, OBSERVED_SEEDS, PARTS):
        world = any_world_of(seed)
        if observation(world):
            least = shrink(world, lambda smaller: str(bool(observation(smaller))))
            pytest.fail(f"seed {seed}: {least!r}\n{observation(least)}")


def test_a_rule_that_recovers_at_the_moment_of_an_event_already_has_its_full_utility() -> None:
    check(crowd_world_of(901_469), 901_469)


@pytest.mark.parametrize("order", ["1010", "1001", "0110"])
def test_a_tracer_does_not_change_the_numbers_of_runs(order: str) -> None:
    world = World(
        signals=(SignalOf(), SignalOf()),
        rules=(RuleOf(when=((Want("s0"), Want("s1")),)),),
        inputs=tuple((0.0, ("emit", f"s{number}", place)) for place, number in enumerate(order)),
        together=True,
    )
    assert not observation(world)


def test_an_activation_that_begins_to_wait_for_a_run_is_no_longer_in_a_stalemate() -> None:
    """`r1` runs for the first s0. For the second s0, `r1` waits for the end of this run, and so do `r3` and `r0`."""
    both = (Want("s0"), Want("s2"))
    rules = (
        RuleOf(when=((Want("s0"),),), writes=("v0",)),
        RuleOf(when=(both,), writes=("v1",), acts=(Act(seconds=2.0),)),
        RuleOf(when=((*both, Gate("v0")),), writes=("v1",)),
        RuleOf(when=((Want("s0"),),), writes=("v1", "v0"), weight=2.0),
    )
    inputs = tuple((0.0, ("emit", name, 0)) for name in ("s0", "s0", "s2"))
    check(World((SignalOf(),) * 3, (SlotOf(),) * 2, rules, inputs), 0)


def test_a_waiting_activation_is_reconsidered_as_soon_as_a_rival_gives_up() -> None:
    """At 0.5 s, `r2` asks for consent in vain. Then the patience of `r3` ends, so `r2` must ask again (L16)."""
    half = Act(seconds=0.5)
    rules = (
        RuleOf(when=((Want("s1"), Want("s0")),), writes=("v0",), weight=0.5),
        RuleOf(when=((Want("s3"),),), emits=("s2",), acts=(half,)),
        RuleOf(when=((Want("s0"), Want("s3")),), writes=("v0",)),
        RuleOf(when=((Want("s2"), Want("s1")),), writes=("v0",)),
    )
    inputs = tuple((0.0, ("emit", name, 0)) for name in ("s1", "s3", "s0", "s1", "s2"))
    check(World((SignalOf(),) * 4, (SlotOf(),), rules, inputs, patience=0.5), 0)


@pytest.mark.parametrize("order", ["0011", "1100", "110001", "0101"])
def test_an_added_rule_that_relates_two_signals_also_affects_pairs_of_earlier_spikes(order: str) -> None:
    """The rule is added after the spikes of one instant, before any pair of these spikes has run (L12)."""
    for cause, effect in ("s0", "s1"), ("s1", "s0"):
        added = RuleOf(when=((Want(cause),),), emits=(effect,))
        world = World(
            signals=(SignalOf(), SignalOf()),
            rules=(RuleOf(when=((Want("s0"), Want("s1")),)),),
            inputs=(
                *((0.0, ("emit", f"s{number}", place)) for place, number in enumerate(order)),
                (0.0, ("add", added)),
            ),
            together=True,
        )
        check(world, 0)
        assert not observation(world)


def check(world: World, seed: int) -> None:
    """Fail with the smallest world in which the engine departs from the laws."""
    if difference(world):
        least = shrink(world, verdict)
        pytest.fail(f"seed {seed}: {least!r}\n{difference(least)}")
