"""What a trace says of one causal group: its spikes, and for each rule the attempts that it made on them.

Built once for a question, from the records alone.
"""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from itertools import accumulate
from operator import attrgetter

from ravestate.engine.trace import (
    Born,
    Dropped,
    GaveUp,
    Held,
    Merged,
    Passed,
    Pressed,
    Record,
    Set,
    Settled,
    Started,
    Told,
    Waits,
)

__all__ = ["Attempt", "History"]

NEVER = float("inf")
BY_TIME = attrgetter("time")


@dataclass(slots=True)
class Attempt:
    """One activation of a rule, as far as the trace tells.

    Attributes:
        held: The spikes that it took, in order.
        lacks: What it lacked before it ended (signals).
        complete: When it had all spikes, if it ever had (seconds).
        waits: When it was ready and kept waiting, for whom.
        gave_up: What it gave up at its end.
        started: When it ran.
        settled: How its run ended.
        told: Why its run was told to end.
    """

    id: int
    rule: str
    clause: int
    held: list[Held] = field(default_factory=list[Held])
    lacks: tuple[str, ...] = ()
    complete: float | None = None
    waits: list[Waits] = field(default_factory=list[Waits])
    gave_up: list[GaveUp] = field(default_factory=list[GaveUp])
    started: Started | None = None
    settled: Settled | None = None
    told: Told | None = None
    _missing: tuple[str, ...] = ()
    _holds: set[int] = field(default_factory=set[int])

    @property
    def over(self) -> bool:
        """Whether it has ended."""
        return self.settled is not None or (self.started is None and not self._holds)

    @property
    def end(self) -> float | None:
        """When it ended (seconds)."""
        if self.settled is not None:
            return self.settled.time
        return self.gave_up[-1].time if self.over and self.gave_up else None

    def take(self, record: Held) -> None:
        """It took a spike."""
        self.held.append(record)
        self._holds.add(record.spike)
        self.lacks = self._missing = record.lacks
        self.complete = None if record.lacks else record.time
        self.gave_up.clear()

    def lose(self, record: GaveUp) -> None:
        """It gave a spike up. What it lacks is as before the first of those that it gives up in one instant."""
        if self.gave_up and self.gave_up[-1].time == record.time:
            self._missing = (*self._missing, record.signal)
        else:
            self.lacks = self._missing
            self._missing = (*self._missing, record.signal)
            self.gave_up.clear()
        self.gave_up.append(record)
        self._holds.discard(record.spike)


class History:
    """A trace, indexed for questions about the causal group of one spike.

    Args:
        records: The trace, in order.
        spike: The number of a spike in it.

    Attributes:
        raising: The number of a run and a signal, for each signal that it raised.

    Raises:
        LookupError: The trace does not have the spike (any more).
    """

    def __init__(self, records: Iterable[Record], spike: int) -> None:
        self.born: dict[int, Born] = {}
        self.attempts: dict[str, dict[int, Attempt]] = {}
        self.passed: dict[str, list[Passed]] = {}
        self.pressed: dict[str, list[Pressed]] = {}
        self.writes: dict[int, list[Set]] = {}
        self.values: dict[str, list[Set]] = {}
        self.retired: dict[str, float] = {}
        self.fired: dict[str, list[float]] = {}
        self.raising: set[tuple[int, str]] = set()
        self.dropped: dict[int, Dropped] = {}
        self.first = self.last = 0.0
        self._runs: dict[int, Attempt] = {}
        self._into: dict[int, int] = {}
        self._answers: list[Attempt] = []  # in the order of their end
        self._of: dict[str, list[Attempt]] = {}
        self._spans: dict[str, tuple[list[float], list[float]]] = {}
        started = False
        for record in records:
            if not started:
                self.first, started = record.time, True
            self.last = record.time
            self._read(record)
        if spike not in self.born:
            raise LookupError(f"spike {spike} is not in the history that is kept")
        self.spike = self.born[spike]
        root = self.root(self.spike.group)
        self.group = {id for id, born in self.born.items() if self.root(born.group) == root}

    def root(self, group: int) -> int:
        """The group into which one has merged, at last."""
        root = group
        while root in self._into:
            root = self._into[root]
        while group != root:  # who asks again need not follow the way again
            self._into[group], group = root, self._into[group]
        return root

    def of(self, rule: str) -> list[Attempt]:
        """The attempts of a rule on spikes of the group, in the order of their beginning."""
        if rule not in self._of:
            self._of[rule] = [a for a in self.attempts.get(rule, {}).values() if self._is_ours(a)]
        return self._of[rule]

    def raised(self, signal: str) -> list[Born]:
        """The spikes of a signal in the group."""
        return [self.born[id] for id in self.group if self.born[id].signal == signal]

    def ran(self, rule: str, time: float) -> bool:
        """Whether a rule ran for the group at a time (seconds)."""
        if rule not in self._spans:
            spans = sorted(
                (attempt.started.time, NEVER if attempt.end is None else attempt.end)
                for attempt in self.of(rule)
                if attempt.started is not None
            )
            self._spans[rule] = (
                [start for start, _ in spans],
                list(accumulate((end for _, end in spans), max)),
            )
        starts, ends = self._spans[rule]
        begun = bisect_right(starts, time)
        return begun > 0 and ends[begun - 1] >= time

    def answered(self, hears: Mapping[str, Sequence[Collection[str]]]) -> Attempt | None:
        """The first run that answered for the group.

        Args:
            hears: The rules of which it may be one; for each of their clauses, the signals that it takes from others.
                What a rule only looks at (a detached constraint) it answers to nobody (L19).
        """
        return next(
            (a for a in self._answers if a.rule in hears and self._is_taken(a, hears[a.rule][a.clause])), None
        )

    def _is_taken(self, attempt: Attempt, signals: Collection[str]) -> bool:
        """Whether an attempt took a spike of one of these signals in the group."""
        started = attempt.started
        spikes = [held.spike for held in attempt.held] if started is None else started.spikes
        return any(spike in self.group and self.born[spike].signal in signals for spike in spikes)

    def before(self, run: int) -> str:
        """The rule that raised what a run of another one took of this group; empty: none, or not known."""
        attempt = self._runs.get(run)
        if attempt is None or attempt.started is None:
            return ""
        for spike in attempt.started.spikes:
            if spike in self.group:
                source = self._runs.get(self.born[spike].source)
                if source is not None and source.rule != attempt.rule:
                    return source.rule
        return ""

    def value(self, slot: str, time: float) -> Set | None:
        """The last write of a slot up to a time (seconds), if the trace has one."""
        written = self.values.get(slot, [])
        number = bisect_right(written, time, key=BY_TIME)
        return written[number - 1] if number else None

    def _is_ours(self, attempt: Attempt) -> bool:
        started = attempt.started
        return any(held.spike in self.group for held in attempt.held) or (
            started is not None and any(spike in self.group for spike in started.spikes)
        )

    def _attempt(self, id: int, rule: str, clause: int) -> Attempt:
        attempts = self.attempts.setdefault(rule, {})
        if id not in attempts:
            attempts[id] = self._runs[id] = Attempt(id, rule, clause)
        return attempts[id]

    def _read(self, record: Record) -> None:
        match record:
            case Born():
                self.born[record.spike] = record
                self.raising.add((record.source, record.signal))
            case Held():
                self._attempt(record.activation, record.rule, record.clause).take(record)
            case GaveUp():
                if record.activation in self._runs:  # else it took the spike before the trace began
                    self._runs[record.activation].lose(record)
            case Waits():
                if record.activation in self._runs:
                    self._runs[record.activation].waits.append(record)
            case Started():
                self._attempt(record.run, record.rule, record.clause).started = record
            case Settled():
                if record.run in self._runs:
                    self._runs[record.run].settled = record
                    if record.fired:
                        self._answers.append(self._runs[record.run])
                if record.fired:
                    self.fired.setdefault(record.rule, []).append(record.time)
                if record.outcome == "retired":
                    self.retired.setdefault(record.rule, record.time)
            case Passed():
                self.passed.setdefault(record.rule, []).append(record)
            case Pressed():
                self.pressed.setdefault(record.rule, []).append(record)
            case Set():
                self.writes.setdefault(record.run, []).append(record)
                self.values.setdefault(record.slot, []).append(record)
            case Merged():
                if (
                    self.root(record.into) != record.group
                ):  # a file may say anything, but groups do not merge in circles
                    self._into[record.group] = record.into
            case Told():
                if record.run in self._runs:
                    self._runs[record.run].told = record
            case Dropped():
                self.dropped[record.spike] = record
