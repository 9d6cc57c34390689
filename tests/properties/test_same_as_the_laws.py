"""Random worlds: the engine does what the interpreter of the laws does, effect for effect and at the same times.

`make fuzz` plays fresh seeds; here the same seeds are played each time.
"""

from __future__ import annotations

import pytest

from properties.crowd_worlds import crowd_world_of
from properties.fuzz import difference, verdict
from properties.pair_worlds import pair_world_of
from properties.random_worlds import world_of
from properties.shrinking import shrink
from properties.worlds import World

SEEDS = 2_000
PAIR_SEEDS = 400
CROWD_SEEDS = 400
PARTS = 20


@pytest.mark.parametrize("part", range(PARTS))
def test_the_engine_keeps_to_the_laws(part: int) -> None:
    for seed in range(part, SEEDS, PARTS):
        check(world_of(seed), seed)


@pytest.mark.parametrize("part", range(PARTS))
def test_the_engine_keeps_to_the_laws_where_pairs_compete(part: int) -> None:
    for seed in range(part, PAIR_SEEDS, PARTS):
        check(pair_world_of(seed), seed)


@pytest.mark.parametrize("part", range(PARTS))
def test_the_engine_keeps_to_the_laws_in_a_crowd(part: int) -> None:
    for seed in range(part, CROWD_SEEDS, PARTS):
        check(crowd_world_of(seed), seed)


def test_a_rule_that_recovers_in_the_moment_of_another_event_meets_it() -> None:
    check(crowd_world_of(901_469), 901_469)


def check(world: World, seed: int) -> None:
    """Fail with the smallest world in which the engine departs from the laws."""
    if difference(world):
        least = shrink(world, verdict)
        pytest.fail(f"seed {seed}: {least!r}\n{difference(least)}")
