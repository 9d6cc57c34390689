"""Ten times the work costs about ten times the steps: no part of the engine is quadratic unless a law demands it."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from functools import cache

import pytest

from engine.growth import WORKLOADS

LINEAR = 13.0
"""How many times as many steps the engine may take for ten times the size."""


@cache
def counts() -> dict[str, tuple[int, int]]:
    """Return the steps that the engine takes for each workload, at one size and at ten times that size."""
    settings = {**os.environ, "RAVESTATE_PURE": "1", "PYTHONPATH": os.pathsep.join(sys.path)}
    command = [sys.executable, "-m", "engine.growth"]
    found = subprocess.run(command, env=settings, capture_output=True, text=True, check=True)
    return {name: (few, many) for name, (few, many) in json.loads(found.stdout).items()}


@pytest.mark.parametrize("workload", WORKLOADS)
def test_ten_times_the_work_takes_about_ten_times_the_steps(workload: str) -> None:
    few, many = counts()[workload]
    assert 0 < many <= LINEAR * few, f"{few:,} steps become {many:,}: {many / few:.1f} times as many"
