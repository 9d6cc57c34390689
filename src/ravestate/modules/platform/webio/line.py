"""The audio line between the agent and a visitor's browser: microphone and loudspeaker."""

from __future__ import annotations

import asyncio
from collections import deque
from collections.abc import AsyncGenerator, Callable
from typing import TYPE_CHECKING, Any, Protocol

from ravestate.modules import rawio

if TYPE_CHECKING:
    from ravestate.declare.slot import Slot
    from ravestate.policy.policy import Policy

SAMPLE = 2  # the size of a sample in bytes

BLOCK = rawio.IN_RATE // 50 * SAMPLE
"""The size in bytes of a 20 ms block of the visitor's sound."""

MOST_HEARD = 5 * rawio.IN_RATE * SAMPLE
"""At most this many bytes (5 s) of the visitor's sound wait for the agent. The line drops older sound."""

TRAIL = bytes(2 * rawio.IN_RATE * SAMPLE)
"""2 s of silence. The agent hears it when the microphone goes off or loses the line, so that the visitor's utterance
ends."""

CHUNK = rawio.OUT_RATE // 5 * SAMPLE
"""The maximum number of bytes of the agent's sound in one frame (0.2 s)."""

AHEAD = rawio.OUT_RATE
"""At most about this many unplayed samples (1 s) are in the browser window. The line sends no more in advance,
because `stop` would drop it."""

BETWEEN = 0.2
"""After a report of progress from the browser window, `played` assumes for this many seconds that the sound keeps
playing."""

STALL = 5.0
"""A browser window loses the line if it plays none of its sound for this many seconds."""

DEAF = 30.0
"""A browser window loses the line if no rule listens to the line within this many seconds. Models may load slowly."""


class Window(Protocol):
    """A browser window of the visitor, which can have the line."""

    def wake(self) -> None:
        """Note that there is sound to fetch, or that sound was dropped."""
        ...

    def lose_sound(self, why: str) -> None:
        """Note that the window has lost the line, and why."""
        ...


def hears(policy: Policy) -> bool:
    """Return whether the agent can hear and speak: whether a rule of its policy uses `rawio.sound`."""
    return uses(policy, rawio.sound)


def uses(policy: Policy, slot: Slot[Any]) -> bool:
    """Return whether a rule of a policy reads a slot, or reacts to a change of it."""
    if any(slot in rule.reads for rule in policy.rules.values()):
        return True
    return any(slot.changed in clause.signals for clause in policy.clause_plans.values())


class PageLine:
    """A `rawio.Line` to a visitor's browser. At most one browser window has the line at a time.

    The agent's sound consists of streams. A new stream begins when sound is dropped, and when a window gets the line.
    The window reports how much of the present stream it has played. While no window has the line, sound counts as
    played immediately, because the visitor reads the words.

    Args:
        on_left: The line calls this function when the window that has the line leaves it.
    """

    cancels_echo = True
    """Always True: browsers remove the loudspeaker's echo from the microphone's sound."""
    ended = False
    """Always False: the visitor may turn the microphone on again."""

    def __init__(self, on_left: Callable[[], None] = lambda: None) -> None:
        self.window: Window | None = None
        """The window that has the line; None if no window has it."""
        self.stream = 0
        """The number of the present stream."""
        self._heard = bytearray()
        self._arrived = asyncio.Event()
        self.closed = False
        """Whether the line is closed."""
        self._on_left = on_left
        self.listens = False
        """Whether a rule has begun to listen to the visitor. Before that, the rule may have to load its models."""
        self._waiting: deque[memoryview] = deque()
        self._queued = self._sent = self._reported = 0  # samples of the present stream
        self._earlier = 0  # played samples of earlier streams
        self._most = 0  # the greatest result of `played` so far, in samples
        self._moved: float | None = None  # the time of the last report; None if this report showed no progress
        self._drained = asyncio.Event()
        self._drained.set()
        self._watch: asyncio.TimerHandle | None = None

    def __repr__(self) -> str:
        return f"line to a web page, {'off' if self.window is None else 'on'}"

    # -------------------------------------------------------------------------------- the agent's side

    async def blocks(self) -> AsyncGenerator[bytes]:
        """Yield the visitor's sound in blocks of 20 ms, until the line is closed. Wait while the microphone is off."""
        self.listens = True
        if self.window is not None:
            self.window.wake()
        while not self.closed:
            if len(self._heard) >= BLOCK:
                block = bytes(self._heard[:BLOCK])
                del self._heard[:BLOCK]
                yield block
            else:
                self._arrived.clear()
                await self._arrived.wait()

    def play(self, sound: bytes) -> None:
        """Queue sound for the window that has the line."""
        samples = len(sound) // SAMPLE
        if self.closed or samples == 0:
            return
        if self.window is None:
            self._earlier += samples
            return
        self._waiting.append(memoryview(sound)[: samples * SAMPLE])
        self._queued += samples
        self._drained.clear()
        if self._watch is None:
            self._expect(STALL, self._find_stalled)
        self.window.wake()

    def stop(self) -> None:
        """Drop all queued sound here and in the window, and begin a new stream."""
        self._earlier = round(self.played * rawio.OUT_RATE)
        self.stream += 1
        self._waiting.clear()
        self._queued = self._sent = self._reported = 0
        self._moved = None
        self._stop_watch()
        self._drained.set()
        if self.window is not None:
            self.window.wake()

    @property
    def played(self) -> float:
        """How many seconds of sound the loudspeaker has played. Between two reports of the window, it is an estimate."""
        since = 0.0
        if self._moved is not None:
            since = min(asyncio.get_running_loop().time() - self._moved, BETWEEN)
        of_stream = min(self._sent, self._reported + int(since * rawio.OUT_RATE))
        self._most = max(self._most, self._earlier + of_stream)
        return self._most / rawio.OUT_RATE

    async def drained(self) -> None:
        """Wait until all queued sound has been played or dropped."""
        await self._drained.wait()

    def close(self) -> None:
        """Close the line, and take it away from its window."""
        self.closed = True
        self._arrived.set()
        self._lose("the agent does not listen any more")

    # -------------------------------------------------------------------------------- the window's side

    def take(self, window: Window) -> None:
        """Give the line to a window, and take it away from any other window."""
        if self.window is window:
            return
        if self.window is not None:
            self.window.lose_sound("the microphone is on in another window")
        self.window = window
        self.stop()
        if not self.listens:
            self._expect(DEAF, self._find_deaf)

    def leave(self, window: Window) -> None:
        """Take the line away from a window, and drop the queued sound. Ignore a window that does not have the line."""
        if self.window is not window:
            return
        self.window = None
        self.stop()
        self._listen(TRAIL)
        self._on_left()

    def hear(self, window: Window, sound: bytes) -> None:
        """Accept the visitor's sound from a window; ignore it if the window does not have the line."""
        if self.window is window:
            self._listen(sound)

    def _listen(self, sound: bytes) -> None:
        self._heard += sound
        if len(self._heard) > MOST_HEARD:
            del self._heard[: len(self._heard) - MOST_HEARD]
        self._arrived.set()

    def fetch(self, window: Window) -> memoryview | None:
        """Return the next sound for a window, at most `CHUNK` bytes.

        Return None if no sound waits, or if the window does not have the line, or already has `AHEAD` unplayed samples.
        """
        if self.window is not window or not self._waiting or self._sent - self._reported >= AHEAD:
            return None
        first = self._waiting.popleft()
        if len(first) > CHUNK:
            self._waiting.appendleft(first[CHUNK:])
            first = first[:CHUNK]
        self._sent += len(first) // SAMPLE
        return first

    def report(self, window: Window, stream: int, samples: int) -> None:
        """Note how many samples of a stream a window has played; ignore a report on an earlier stream."""
        if self.window is not window or stream != self.stream:
            return
        samples = min(samples, self._sent)
        if samples <= self._reported:
            self._moved = None
            return
        self._reported = samples
        self._moved = asyncio.get_running_loop().time()
        self._stop_watch()
        if samples == self._queued:
            self._drained.set()
        else:
            self._expect(STALL, self._find_stalled)
        window.wake()

    def _expect(self, seconds: float, late: Callable[[], None]) -> None:
        self._stop_watch()
        self._watch = asyncio.get_running_loop().call_later(seconds, self._find_late, late)

    def _find_late(self, late: Callable[[], None]) -> None:
        self._watch = None
        late()

    def _stop_watch(self) -> None:
        if self._watch is not None:
            self._watch.cancel()
            self._watch = None

    def _find_stalled(self) -> None:
        self._lose("the sound does not play")

    def _find_deaf(self) -> None:
        if not self.listens:
            self._lose("the agent cannot hear at the moment")

    def _lose(self, why: str) -> None:
        if self.window is not None:
            window = self.window
            self.leave(window)
            window.lose_sound(why)
