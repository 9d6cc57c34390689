"""Ten times the work takes about ten times the steps, so no part of the engine has quadratic costs."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from functools import cache

import pytest

from engine.growth import WORKLOADS

LINEAR = 13.0
"""The maximum factor by which the steps may grow if the size grows tenfold."""


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
