"""How long until an input is answered?

All rule engines do the same work. A chain of k rules follows an input; each rule raises the next signal. An answering
rule on the last signal and a fallback rule on the input compete for one output. For every input, each contestant
except the floor checks that the answering rule answers and the fallback stays quiet.
"""

from __future__ import annotations

import statistics
from collections.abc import Iterable

from benchmarks.bench import Bench
from benchmarks.figures import Figure, compare
from ravestate.compiled import COMPILED, build

CHAINS = (1, 4, 8)
FURTHER = {
    "durable_rules": "durable_rules.py",
    "experta": "experta_rules.py",
    "py-trees, a fixed order": "trees.py",
}
"""For each peer without a target: its name in the table, and its file in ``peers``."""

COMPILED_TARGETS = {1: 0.6, 4: 0.4, 8: 0.3}
PURE_TARGETS = {1: 2.6, 4: 1.9, 8: 1.6}
"""Both dicts map the length of the chain to a target: the maximum of our time divided by the time of CLIPS. The first
is for the compiled build, the second for pure Python."""

LIVED_IN = 3000
"""The number of inputs that CLIPS takes before its second measurement. This shows how clipspy slows down with every
input."""


def at_most(ratio: float) -> bool:
    """Return whether a ratio meets the target: no more time than CLIPS needs."""
    return ratio <= 1


def ask(bench: Bench) -> Iterable[Figure]:
    """Compare Ravestate with CLIPS (which sets the target), the other peers, the floor and the reference
    implementation."""
    ours, clips, floor, reference = bench.ours(), bench.clips(), bench.callbacks(), bench.reference()
    further = {name: bench.peer(script) for name, script in FURTHER.items()}
    goals = COMPILED_TARGETS if build() == COMPILED else PURE_TARGETS
    for k in CHAINS:
        mine: list[float] = []
        turn: list[float] = []
        virtual: list[float] = []
        theirs: dict[str, list[float]] = {}
        inputs = bench.several(100, 50)

        def note(who: str, values: list[float], theirs: dict[str, list[float]] = theirs) -> None:
            theirs.setdefault(who, []).append(statistics.median(values))

        for _ in bench.rounds(25, 5):
            times = ours.ask("answer", k=k, inputs=inputs)
            mine.append(statistics.median(times["answered"]))
            turn.append(statistics.median(times["turn"]))
            times = clips.ask("answer", k=k, inputs=inputs, style="raise")
            note("CLIPS", times["answered"])
            note("CLIPS turn", times["turn"])
            note("CLIPS quickest", clips.ask("answer", k=k, inputs=inputs, style="return")["answered"])
            note("floor", floor.ask("answer", k=k, inputs=inputs))
            for name, peer in further.items():
                note(name, peer.ask("answer", k=k, inputs=inputs))
            virtual.append(statistics.median(ours.ask("simulated", k=k, inputs=inputs)))
        yield compare(
            "answer",
            f"k={k}: answered",
            mine,
            "CLIPS",
            theirs["CLIPS"],
            target=f"<= {goals[k]:g}",
            reach=lambda r, k=k: r <= goals[k],
        )
        for name in FURTHER:
            yield compare("answer", f"k={k}: answered", mine, name, theirs[name])
        yield compare("answer", f"k={k}: answered", mine, "CLIPS, rules assert in C", theirs["CLIPS quickest"])
        yield compare("answer", f"k={k}: and ready for the next", turn, "CLIPS", theirs["CLIPS turn"])
        yield compare("answer", f"k={k}: answered, virtual time", virtual, "CLIPS", theirs["CLIPS"])
        yield compare("answer", f"k={k}: answered", mine, f"floor: {k + 1} bare callbacks", theirs["floor"])

        old = f"CLIPS after {LIVED_IN:,} inputs"
        lived: list[float] = []
        slow: list[float] = []
        live: list[float] = []
        for _ in bench.rounds(5, 2):
            live.append(statistics.median(ours.ask("answer", k=k, inputs=inputs)["answered"]))
            times = clips.ask("answer", k=k, inputs=inputs, style="raise", before=LIVED_IN)
            lived.append(statistics.median(times["answered"]))
            slow.append(statistics.median(reference.ask("answer", k=k, inputs=bench.several(4, 2))))
        yield compare("answer", f"k={k}: answered", live, old, lived, target="<= 1", reach=at_most)
        yield compare("answer", f"k={k}: answered", live, "reference implementation", slow)
