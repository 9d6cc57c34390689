"""What happens in a context, kept for whoever looks in: bounded in memory, and in what it costs the agent.

Nobody has a queue of their own: records are numbered, and an inspector reads those that it has not seen. One that does
not read misses what is kept no more; it holds nobody up.

Making records is dear for an agent that does nothing else. So a recorder takes a burst, then so many a second, more of
them while the process has time to spare; beyond that it stops listening for a moment, in which the engine makes none,
and a `Gap` says how many spikes went unseen.

All recorders of an agent share what is kept: when it is too much, the longest are shortened to one length.
"""

from __future__ import annotations

import asyncio
from collections import deque
from collections.abc import Callable
from dataclasses import dataclass
from itertools import islice
from weakref import WeakKeyDictionary, ref

from ravestate.board.idle_share import IdleShare
from ravestate.engine.trace import Born, Record
from ravestate.runtime.context import Context

__all__ = ["BURST", "IN_ALL", "KEPT", "RATE", "Gap", "Recorder", "Recorders"]

KEPT = 100_000
"""Records of one context that are kept."""

IN_ALL = 500_000
"""Records of all contexts that are kept, as far as they are shared out: some 136 bytes each, and their payloads."""

LUMP = 100
"""Records after which a recorder tells that it has grown."""

BURST = 20_000
"""Records that are taken at once."""

RATE = 2_000
"""Records a second that are taken after that of an agent that is busy all the time."""

SPARE = 60_000
"""Records a second that are taken besides, times the share of its time that the process has to spare."""

PAUSE = 0.1
"""Seconds for which a recorder that has taken too much does not listen."""


@dataclass(slots=True)
class Gap:
    """Here something went unseen.

    Attributes:
        time: Since when (seconds).
        spikes: How many spikes were born meanwhile; -1 as long as that is not known.
    """

    time: float
    spikes: int = -1


class Recorder:
    """Keeps what happens in a context from now on.

    Args:
        context: Running, or not begun yet.
        kept: Records to keep.
        burst: Records to take at once.
        rate: Records a second to take after that.
        spare: Records a second to take besides, times the share of time that the process has to spare.
        whole: Whether the context has not begun yet, so that nothing is missed.
        grown: Called after each `LUMP` of records.
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
        self._left = 0  # the first record is granted a burst
        self._granted: float | None = None
        self._spike = 0  # the newest that was seen, whether it is still kept or not
        self._gap: Gap | None = None
        self._leave: Callable[[], None] = lambda: None
        self.records: deque[Record | Gap] = deque(maxlen=kept)
        """The newest, oldest first."""
        self.last = 0
        """The number of the newest: how many there have been."""
        self.missed = 0
        """Spikes that went unseen."""
        self.whole = whole
        """Whether it has been there from the beginning."""
        self._listen()

    @property
    def first(self) -> int:
        """The number of the oldest that is kept."""
        return self.last - len(self.records) + 1

    def since(self, number: int, most: int) -> list[Record | Gap]:
        """Records after a number, at most so many."""
        skip = max(0, number - self.first + 1)
        length = len(self.records)
        if length - skip < skip:  # a deque is quick from both ends
            tail = list(islice(reversed(self.records), length - skip))
            tail.reverse()
            return tail[:most]
        return list(islice(self.records, skip, skip + most))

    def shorten(self, length: int) -> None:
        """Keep the newest records only, so many at most."""
        while len(self.records) > length:
            self.records.popleft()

    def _listen(self) -> None:
        self._leave = self._context.observe(self._take if self._gap is None else self._take_after_gap)

    def _take(self, record: Record) -> None:
        self._keep(record)
        if type(record) is Born:
            self._spike = record.spike
        self._left -= 1
        if self._left <= 0:
            self._rest()

    def _keep(self, record: Record | Gap) -> None:
        self.records.append(record)
        self.last += 1
        if self.last % LUMP == 0:
            self._grown()

    def _take_after_gap(self, record: Record) -> None:
        """Until the number of a spike tells how many went unseen."""
        if isinstance(record, Born) and self._gap is not None:
            self._gap.spikes = record.spike - self._spike - 1
            self.missed += self._gap.spikes
            self._gap = None
            self._leave()
            self._listen()
        self._take(record)  # after which it may rest

    def _rest(self) -> None:
        """What it may take is used up: go on if there was time enough meanwhile, or else stop listening for a moment."""
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
        """Records a second that it may take now."""
        return self._rate + self._spare * self._idle_share.share()


class Recorders:
    """The recorder of each context that is, or was, looked into; it goes with the context.

    Args:
        in_all: Records to keep of all contexts together. At times it is a little more: a fiftieth, and a lump of each.
    """

    def __init__(self, in_all: int = IN_ALL) -> None:
        self._in_all = in_all
        self._grown = 0
        self._of: WeakKeyDictionary[Context, ref[Recorder]] = (
            WeakKeyDictionary()
        )  # it is held by what it listens to

    def of(self, context: Context, *, whole: bool = False) -> Recorder:
        """The recorder of a context: made when it is first asked for; `whole` as for `Recorder`."""
        known = self._of.get(context)
        found = None if known is None else known()
        if found is None:
            found = Recorder(context, whole=whole, grown=self._grow)
            self._of[context] = ref(found)
        return found

    def _grow(self) -> None:
        self._grown += LUMP
        if self._grown * 50 >= self._in_all:  # seldom, so that it costs each record next to nothing
            self._grown = 0
            recorders = [found for known in self._of.values() if (found := known()) is not None]
            length = _fair([len(recorder.records) for recorder in recorders], self._in_all)
            for recorder in recorders:
                recorder.shorten(length)


def _fair(lengths: list[int], in_all: int) -> int:
    """The length to which the longest are shortened, so that all have no more than so much together.

    Example:
        >>> _fair([10, 500, 700], 610)
        300
    """
    left = in_all
    for number, length in enumerate(sorted(lengths)):
        share = left // (len(lengths) - number)
        if length > share:
            return max(1, share)
        left -= length
    return max(lengths, default=1)
