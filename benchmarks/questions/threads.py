"""What does a plain function in a worker thread cost?

The agent of ``answer`` (a chain of one rule) has a plain function as its answering rule. The benchmark compares it with
an ``async`` answering rule, and with a bare hop into a thread and back.
"""

from __future__ import annotations

import statistics
from collections.abc import Iterable

from benchmarks.bench import Bench
from benchmarks.figures import Figure, compare


def ask(bench: Bench) -> Iterable[Figure]:
    """Compare a plain function with an async one, and the plain function's extra time with a bare hop into a thread."""
    ours, floor = bench.ours(), bench.callbacks()
    plain, direct, bare = [], [], []
    inputs = bench.several(100, 50)
    for _ in bench.rounds(15, 5):
        plain.append(statistics.median(ours.ask("answer", k=1, inputs=inputs, threads=True)["answered"]))
        direct.append(statistics.median(ours.ask("answer", k=1, inputs=inputs)["answered"]))
        bare.append(statistics.median(floor.ask("thread_hop", inputs=inputs)))
    added = [one - other for one, other in zip(plain, direct, strict=True)]
    yield compare("threads", "answered by a plain function", plain, "by an async one", direct)
    yield compare("threads", "what the plain function adds", added, "floor: a bare thread hop", bare)
