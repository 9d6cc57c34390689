"""Simulated people for the tests: a skeleton from ``tools/activities`` performs an activity in front of a camera."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Any

import numpy as np

TOOLS = Path(__file__).parents[4] / "tools" / "activities"
if str(TOOLS) not in sys.path:
    sys.path.insert(0, str(TOOLS))

import camera  # noqa: E402
import movements  # noqa: E402
import starter  # noqa: E402

ALL = {**movements.KNOWN, **movements.OTHERS, **movements.STRANGE, **movements.UNTOUCHED}


def performance(name: str, seed: int = 1, *, conditions: Any = camera.TAUGHT, left: float = 0.0) -> list[Any]:
    """Return the poses of a simulated person who performs an activity for three seconds.

    `left` is the probability that the person is left-handed.
    """
    movement, rate = ALL[name]
    return starter.poses_of(movement, rate, conditions, np.random.default_rng(seed), left=left)
