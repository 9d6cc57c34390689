"""The graph that completes clauses to pathways (law L8).

An *alternative* of a signal is a set of signals that together may cause it. An input, or a signal without causes, also
has the empty alternative. A pathway of a clause is a set of signals. It holds the clause's own signals and, for each
signal in the pathway, one alternative of that signal.

A set of signals is an integer here. Bit *n* stands for the signal at *place* *n*. The places of causes come before
those of their effects, except in cycles and for effects that have the empty alternative. Apart from these, the signal
of a set's highest bit causes no other signal of the set.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence

from ravestate.declare.signal import Signal
from ravestate.policy.causes import Causes
from ravestate.policy.components import components
from ravestate.policy.model import RulePlan, SignalPlan

UNIT = 1 << 60
"""Units per nat. Information is stored as a whole number of units, so the order of a sum does not matter."""


class Completion:
    """The alternatives and the information of every signal.

    Attributes:
        place: Index of a signal → its place.
        alternatives: Place → the signal's alternatives, each a tuple of places.
        bare: Place → whether a pathway may hold the signal without its causes, by the empty alternative.
        information: Place → the self-information of the signal (L9), in units (`UNIT`).
        components: Sets of places that lie on common cycles; causes come first. For these cycles, `bare` signals count
            as signals without causes.
        cycle: Place → the set of signals on a cycle with the signal; 0 if the signal is on no cycle.
    """

    def __init__(self, signals: Sequence[SignalPlan], rules: Sequence[RulePlan], causes: Causes) -> None:
        found = [_alternatives(signal, causes) for signal in signals]
        bare = [signal.input or not found[signal.index] or frozenset() in found[signal.index] for signal in signals]
        pruned = components([() if bare[s] else causes.direct[s] for s in range(len(signals))])
        order = [signal for members in pruned.members for signal in members]
        self.place = [0] * len(signals)
        for place, signal in enumerate(order):
            self.place[signal] = place
        self.components = [[self.place[s] for s in members] for members in pruned.members]
        self.bare = [bare[s] for s in order]
        self.alternatives = [
            tuple(tuple(sorted(self.place[c] for c in causes_)) for causes_ in found[s] if causes_) for s in order
        ]
        counts = _counts(signals, rules, causes)
        self.information = [round(-math.log(counts[s] / len(rules)) * UNIT) if counts[s] else 0 for s in order]
        self._alike: dict[int, int] = {}  # information → the set of signals that have it
        for place, information in enumerate(self.information):
            self._alike[information] = self._alike.get(information, 0) | 1 << place
        self._signals: list[Signal[object]] = [signals[s].signal for s in order]
        self.cycle = [0] * len(signals)
        for members in causes.components.members:
            if len(members) > 1 or members[0] in causes.direct[members[0]]:
                cycle = sum(1 << self.place[member] for member in members)
                for member in members:
                    self.cycle[self.place[member]] = cycle

    def weigh(self, bits: int) -> int:
        """Return the information of a set of signals, in units (`UNIT`)."""
        if bits.bit_count() < len(self._alike):
            return sum(self.information[place] for place in each(bits))
        return sum(information * (bits & alike).bit_count() for information, alike in self._alike.items())

    def signals(self, bits: int) -> frozenset[Signal[object]]:
        """Return the signals of a set of bits."""
        return frozenset(self._signals[place] for place in each(bits))


def each(bits: int) -> Iterator[int]:
    """Yield the places in a set, the highest first."""
    while bits:
        place = bits.bit_length() - 1
        yield place
        bits ^= 1 << place


def _alternatives(signal: SignalPlan, causes: Causes) -> dict[frozenset[int], None]:
    return dict.fromkeys(
        frozenset(need.signal.index for need in clause.needs if not need.detached)
        for rule in causes.causes[signal.index]
        for clause in rule.clauses
    )


def _counts(signals: Sequence[SignalPlan], rules: Sequence[RulePlan], causes: Causes) -> list[int]:
    """Return, for each signal, the number of rules that have the signal on a pathway."""
    of, members = causes.components.of, causes.components.members
    completed = [0] * len(members)  # component → the rules with a pathway through it, as a set of their indices
    looked_at = [0] * len(signals)
    for rule in rules:
        bit = 1 << rule.index
        for clause in rule.clauses:
            for need in clause.needs:
                if need.detached:
                    looked_at[need.signal.index] |= bit
                else:
                    completed[of[need.signal.index]] |= bit
    for number in reversed(range(len(members))):  # effects before their causes
        for cause in {of[cause] for member in members[number] for cause in causes.direct[member]}:
            completed[cause] |= completed[number]
    return [(completed[of[s]] | looked_at[s]).bit_count() for s in range(len(signals))]
