"""How long does the import take, and which packages does it load?

The figure is the wall time of an interpreter that imports Ravestate, minus that of an interpreter that imports nothing.
"""

from __future__ import annotations

import statistics
import subprocess
import sys
import time
from collections.abc import Iterable
from dataclasses import replace
from pathlib import Path

from benchmarks.bench import Bench
from benchmarks.figures import Figure, compare, measured

LIMIT = 0.060
"""Seconds that the import may take."""

STRANGERS = """
import sys, sysconfig
before = set(sys.modules)
import ravestate
roots = {name.partition('.')[0] for name in set(sys.modules) - before}
print(*sorted(roots - set(sys.stdlib_module_names) - {'ravestate'}))
"""


def ask(bench: Bench) -> Iterable[Figure]:
    """Compare Ravestate with the reference implementation, and count the third-party packages."""
    reference = bench.reference_interpreter()
    ours, theirs = [], []
    for _ in bench.rounds(15, 5):
        ours.append(_import(sys.executable))
        theirs.append(_import(reference))
    figure = compare("importing", "import ravestate", ours, "reference implementation", theirs)
    yield replace(figure, target="< 60 ms", reached=statistics.median(ours) < LIMIT)
    strangers = subprocess.run(
        [sys.executable, "-c", STRANGERS], capture_output=True, text=True, check=True
    ).stdout.split()
    yield measured(
        "importing",
        "third parties loaded" + "".join(f" {name}" for name in strangers),
        [len(strangers)],
        unit="",
        target="none",
        reach=lambda value: value == 0,
    )


def _import(interpreter: Path | str) -> float:
    return max(0.0, _wall(interpreter, "import ravestate") - _wall(interpreter, "pass"))


def _wall(interpreter: Path | str, code: str) -> float:
    times = []
    for _ in range(3):
        begin = time.perf_counter()
        subprocess.run([str(interpreter), "-c", code], check=True, capture_output=True)
        times.append(time.perf_counter() - begin)
    return min(times)
