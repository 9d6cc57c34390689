"""Recorders keep the records of contexts for inspectors (each serves one open board), with bounded memory and cost.

Inspectors have no queues. Records are numbered, and each inspector reads the records that it lacks. A slow inspector
misses records that are already deleted, and delays nothing else.

Making records is expensive for a busy agent, so each recorder has a rate limit. It allows a burst (many records at
once), then a steady rate, and a higher rate while the process is idle. Beyond the limit, a recorder stops listening for
a moment. Without other observers, the engine then makes no records. A `Gap` says how many spikes the recorder missed.

All recorders of an agent share one limit on the number of records. If the total exceeds this limit, the recorders with
the most records are cut to the same length.
"""

from __future__ import annotations

import asyncio
import dataclasses
from collections import deque
from collections.abc import Callable
from dataclasses import dataclass
from itertools import islice
from time import perf_counter, process_time
from weakref import WeakKeyDictionary, ref

from ravestate.board.rendering import render, traceback_of
from ravestate.declare.core import RuleFailure
from ravestate.engine.trace import Born, Record, Settled
from ravestate.runtime.context import Context

KEPT = 100_000  # the maximum number of records of one context

IN_ALL = 500_000
"""The maximum number of records of all contexts together. Each record takes about 136 bytes plus its payload."""

BATCH = 100  # a recorder calls its callback `grown` each time after this many records
BURST = 20_000  # the maximum number of records in one burst
RATE = 2_000  # a recorder takes at most this many records per second after a burst, in a process that is always busy

SPARE = 60_000
"""Additional records per second in an idle process. In a process that is half idle, half of this number applies."""

PAUSE = 0.1  # after too many records, a recorder stops listening for this many seconds


@dataclass(slots=True)
class Gap:
    """A gap in the records.

    Attributes:
        time: The start of the gap (seconds on the context's clock).
        spikes: How many spikes the recorder missed; -1 while that is unknown.
    """

    time: float
    spikes: int = -1


SCHEDULE = "/proc/thread-self/schedstat"
"""In this file, Linux counts the nanoseconds for which a thread ran, and those for which it waited for a processor."""


class IdleShare:
    """Measures the share of time in which the process was idle since the last `share` call. Use it in one thread only.

    The processor time of all threads counts as busy. Time in which this thread waited for a processor counts as busy,
    too, where the system measures it (Linux).
    """

    def __init__(self) -> None:
        self._since = perf_counter()
        self._busy = process_time()
        self._kept = _kept_waiting()

    def share(self) -> float:
        """Return the idle share since the last call, from 0 (always busy) to 1 (always idle)."""
        since, busy, kept = perf_counter(), process_time(), _kept_waiting()
        passed = since - self._since
        used = busy - self._busy + kept - self._kept
        self._since, self._busy, self._kept = since, busy, kept
        return min(1.0, max(0.0, 1.0 - used / passed)) if passed > 0 else 0.0


def _kept_waiting() -> float:
    """Return for how many seconds this thread has waited for a processor; 0 if the system does not measure it."""
    try:
        with open(SCHEDULE, encoding="ascii") as file:
            return int(file.read().split()[1]) / 1e9
    except (OSError, ValueError, IndexError):
        return 0.0


class Recorder:
    """Keeps the records that a context makes after the recorder is created.

    For the limits, see `KEPT`, `BURST`, `RATE` and `SPARE`. Set `whole` if the context has not started yet: the records
    then reach back to its start. The callback `grown` runs after every `BATCH` records.
    """

    def __init__(
        self,
        context: Context,
        *,
        kept: int = KEPT,
        burst: int = BURST,
        rate: float = RATE,
        spare: float = SPARE,
        whole: bool = False,
        grown: Callable[[], None] = lambda: None,
    ) -> None:
        self._context = context
        self._grown = grown
        self._burst = burst
        self._rate = rate
        self._spare = spare
        self._idle_share = IdleShare()
        self._left = 0  # how many records the recorder may still take; the first record raises this number to `burst`
        self._granted: float | None = None  # the time at which `_left` was last computed; None at first
        self._spike = 0  # the number of the newest spike so far
        self._gap: Gap | None = None  # the gap that has no end yet
        self._leave: Callable[[], None] = lambda: None  # stops listening
        self.records: deque[Record | Gap] = deque(maxlen=kept)
        """The newest records, oldest first."""
        self.last = 0
        """The number of the newest record, which equals the number of all records so far."""
        self.missed = 0
        """How many spikes the recorder missed."""
        self.whole = whole
        """Whether the recorder has listened since the context started."""
        self._listen()

    @property
    def first(self) -> int:
        """The number of the oldest record that is kept."""
        return self.last - len(self.records) + 1

    def since(self, number: int, most: int) -> list[Record | Gap]:
        """Return the records with numbers greater than `number`, oldest first, at most `most`."""
        skip = max(0, number - self.first + 1)
        length = len(self.records)
        if length - skip < skip:  # a deque is fast at its ends only, so begin at the nearer end
            tail = list(islice(reversed(self.records), length - skip))
            tail.reverse()
            return tail[:most]
        return list(islice(self.records, skip, skip + most))

    def shorten(self, length: int) -> None:
        """Keep at most `length` records, the newest ones."""
        while len(self.records) > length:
            self.records.popleft()

    def _listen(self) -> None:
        self._leave = self._context.observe(self._take if self._gap is None else self._take_after_gap)

    def _take(self, record: Record) -> None:
        if type(record) is Born:
            self._spike = record.spike
            if type(record.payload) is RuleFailure:
                record = dataclasses.replace(record, payload=render(record.payload))
        elif type(record) is Settled and isinstance(record.error, BaseException):
            # The traceback of an exception would keep all variables of the rule alive.
            record = dataclasses.replace(record, error=traceback_of(record.error))
        self._keep(record)
        self._left -= 1
        if self._left <= 0:
            self._rest()

    def _keep(self, record: Record | Gap) -> None:
        self.records.append(record)
        self.last += 1
        if self.last % BATCH == 0:
            self._grown()

    def _take_after_gap(self, record: Record) -> None:
        """Take a record. The first spike ends the gap: its number shows how many spikes were missed."""
        if isinstance(record, Born) and self._gap is not None:
            self._gap.spikes = record.spike - self._spike - 1
            self.missed += self._gap.spikes
            self._gap = None
            self._leave()
            self._listen()
        self._take(record)  # this call may begin the next gap

    def _rest(self) -> None:
        """Compute how many records the recorder may take now. If none, stop listening for a moment."""
        loop = asyncio.get_running_loop()
        now = loop.time()
        earned = self._burst if self._granted is None else (now - self._granted) * self._speed()
        self._granted = now
        self._left = min(self._burst, int(earned))
        if self._left > 0:
            return
        self._leave()
        if self._gap is None:
            self._gap = Gap(self.records[-1].time)
            self._keep(self._gap)
        loop.call_later(PAUSE, self._listen_again)

    def _listen_again(self) -> None:
        self._granted = asyncio.get_running_loop().time()
        self._left = max(1, int(self._speed() * PAUSE))
        self._listen()

    def _speed(self) -> float:
        """Return the current rate (records per second)."""
        return self._rate + self._spare * self._idle_share.share()


class Recorders:
    """The recorders of an agent's contexts. Each lives as long as its context.

    All records together may exceed `in_all` by a fiftieth, plus one batch for each context.
    """

    def __init__(self, in_all: int = IN_ALL) -> None:
        self._in_all = in_all
        self._grown = 0
        # Weak references are enough: a context keeps its recorder alive.
        self._of: WeakKeyDictionary[Context, ref[Recorder]] = WeakKeyDictionary()

    def of(self, context: Context, *, whole: bool = False) -> Recorder:
        """Return the recorder of a context; the first call makes it. For `whole`, see `Recorder`."""
        known = self._of.get(context)
        found = None if known is None else known()
        if found is None:
            found = Recorder(context, whole=whole, grown=self._grow)
            self._of[context] = ref(found)
        return found

    def _grow(self) -> None:
        self._grown += BATCH
        if self._grown * 50 >= self._in_all:  # seldom true, so most records cost almost nothing
            self._grown = 0
            recorders = [found for known in self._of.values() if (found := known()) is not None]
            length = fair_length([len(recorder.records) for recorder in recorders], self._in_all)
            for recorder in recorders:
                recorder.shorten(length)


def fair_length(lengths: list[int], in_all: int) -> int:
    """Return the maximum length for each recorder: at least 1.

    With this limit, the total is at most `in_all`, unless there are more than `in_all` recorders.
    """
    left = in_all
    for number, length in enumerate(sorted(lengths)):
        share = left // (len(lengths) - number)
        if length > share:
            return max(1, share)
        left -= length
    return max(lengths, default=1)
