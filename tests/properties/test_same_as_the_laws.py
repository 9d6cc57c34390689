"""Random worlds: the engine does what the interpreter of the laws does, effect for effect and at the same times.

`make fuzz` plays fresh seeds; here the same seeds are played each time.
"""

from __future__ import annotations

import pytest

from properties.fuzz import difference, verdict
from properties.random_worlds import world_of
from properties.shrinking import shrink

SEEDS = 2_000
PARTS = 20


@pytest.mark.parametrize("part", range(PARTS))
def test_the_engine_keeps_to_the_laws(part: int) -> None:
    for seed in range(part, SEEDS, PARTS):
        world = world_of(seed)
        if difference(world):
            least = shrink(world, verdict)
            pytest.fail(f"seed {seed}: {least!r}\n{difference(least)}")
