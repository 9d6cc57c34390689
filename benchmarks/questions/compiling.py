"""How long does it take to compile a policy?

The policy has the agent of ``answer`` (a chain of one rule), and many rules with a signal of their own. The figure does
not include the time of the declarations. CLIPS builds as many rules from text. The second row compares the time per
rule in a large policy with the time per rule in a small policy.
"""

from __future__ import annotations

import time
from collections.abc import Iterable

import ravestate as rs
from benchmarks.bench import Bench
from benchmarks.figures import Figure, compare
from benchmarks.peers.ours import Agent
from benchmarks.peers.wire import serve

FEW, MANY = 100, 10_000


def compiling(unrelated: int) -> float:
    """Return the seconds that compiling takes with this number of unrelated rules."""
    module = Agent(1, unrelated).module
    begin = time.perf_counter()
    rs.compile(module)
    return time.perf_counter() - begin


def ask(bench: Bench) -> Iterable[Figure]:
    """Compare many rules with CLIPS, and the time per rule in a large policy with that in a small one."""
    ours, clips = bench.ours("benchmarks.questions.compiling"), bench.clips()
    many, few, theirs = [], [], []
    for _ in bench.rounds(5, 2):
        many.append(ours.ask("compiling", unrelated=MANY))
        few.append(ours.ask("compiling", unrelated=FEW))
        theirs.append(clips.ask("build", rules=MANY))
    yield compare("compiling", f"{MANY:,} rules", many, "CLIPS", theirs)
    yield compare(
        "compiling",
        f"each of {MANY:,} rules",
        [seconds / MANY for seconds in many],
        f"each of {FEW}",
        [seconds / FEW for seconds in few],
    )


if __name__ == "__main__":
    serve(compiling)
