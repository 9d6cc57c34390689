"""Play the agent's utterances while they grow, and find out which part of them the user has heard."""

from __future__ import annotations

import asyncio
import contextlib
from collections.abc import AsyncIterator
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from ravestate.modules.modality.rawio.line import IN_RATE, OUT_RATE, Line

from .playout import SECOND
from .sentences import sentences, speakable
from .sound import samples

if TYPE_CHECKING:
    from .synthesiser import Spoken, Synthesiser

HEARD = 0.5
"""A word counts as heard if this share of it has been played."""
FAINT = 0.1
"""Sound at the end of a word counts as a pause if its level is below this share of the word's greatest level."""
DRIFT = 0.06
"""The echo's reference is the loudspeaker's sound for the echo canceller. The position in the reference advances by
the length of the microphone's sound. If this position differs from the loudspeaker's position by more than this many
seconds, the mouth sets it to the loudspeaker's position."""
LEAD = 4.0
"""If the loudspeaker's queue has more than this many seconds of sound, the mouth waits before it synthesises more."""
KEPT = 30.0
"""How many seconds of sound to keep as the echo's reference."""


class Speech:
    """An utterance of the agent, which may still grow.

    Args:
        text: The text so far.
        whole: Whether the text is complete.
        counts: Whether ``rawio.heard`` reports the utterance; False for a filler.
    """

    def __init__(self, text: str = "", *, whole: bool = False, counts: bool = True) -> None:
        self.text = text
        self.whole = whole
        self.counts = counts
        self.start: float | None = None
        """The time at which the utterance's sound began (seconds on the context's clock); None if it has not begun."""
        self.end = 0.0
        """The time at which the utterance's sound ended (seconds on the context's clock)."""
        self.over = False
        """Whether the agent has finished the utterance, or has been cut short."""
        self.heard = ""
        """The part that the user heard; empty until the utterance is over."""
        self._given = 0
        self._grown = asyncio.Event()

    def __repr__(self) -> str:
        return f"Speech({self.text!r})"

    def grow(self, piece: str) -> None:
        """Add a piece of text."""
        self.text += piece
        self._grown.set()

    def finish(self) -> None:
        """End the text."""
        self.whole = True
        self._grown.set()

    async def sentences(self) -> AsyncIterator[tuple[int, str]]:
        """Yield each sentence as soon as it is complete: the index of its first character, and its text."""
        whole = False
        while not whole:
            self._grown.clear()
            whole = self.whole
            for at, sentence in sentences(self.text, self._given, whole=whole):
                self._given = at + len(sentence)
                yield at, sentence
            if not whole:
                await self._grown.wait()


@dataclass(slots=True)
class _Queued:
    """A sentence in the loudspeaker's queue. Its sound begins when the line has played `start` seconds of sound."""

    start: float
    spoken: Spoken
    place: int

    @property
    def end(self) -> float:
        return self.start + len(self.spoken.sound) / SECOND


class Mouth:
    """The mouth of one line (a microphone and a loudspeaker). It speaks one utterance after another."""

    def __init__(self, line: Line, voice: Synthesiser) -> None:
        self.line = line
        self.voice = voice
        self.turn = asyncio.Lock()
        """A lock that lets the mouth speak only one utterance at a time."""
        self.growing: Speech | None = None
        """The utterance that is still growing; None if there is none."""
        self.said = ""
        """The last queued sentences. With them, the agent recognises its own words in the microphone's sound."""
        self.speaking = False
        """Whether an utterance is being spoken, even if the speech is held (paused by `hold`)."""
        self.silent_since: float | None = None
        """The time at which `hold` stopped the speech; None if the speech is not held."""
        self._queue: list[_Queued] = []
        self._heard = 0  # how many characters the user had heard before the last `release`
        self._end = 0.0
        self._held_at: float | None = None
        self._released = asyncio.Event()
        self._track: list[tuple[float, bytes]] = []  # start (played seconds) and PCM of each sound, for `reference`
        self._at = 0.0  # the position of the reference (played seconds)
        self._before = 0.0  # the position of the line at the last call of `reference`

    @property
    def held(self) -> bool:
        """Whether `hold` has stopped the speech for the time being."""
        return self._held_at is not None

    @property
    def position(self) -> float:
        """How many seconds of sound the line has played; while the speech is held, the position at which it stopped."""
        return self.line.played if self._held_at is None else self._held_at

    @property
    def lead(self) -> float:
        """How many seconds of sound wait in the queue."""
        return max(0.0, self._end - self.position)

    @property
    def sounding(self) -> bool:
        """Whether sound comes out of the loudspeaker."""
        return self.speaking and self._held_at is None

    @staticmethod
    def words(sentence: str) -> str:
        """Return a sentence without characters that the voice cannot speak; empty if it has no words."""
        return speakable(sentence)

    def begin(self) -> None:
        """Begin a new utterance."""
        self._queue.clear()
        self._heard = 0
        self._held_at = None
        self._end = self.line.played

    def queue(self, spoken: Spoken, place: int) -> None:
        """Queue a sentence, which begins at the character `place` of the utterance."""
        self.said = f"{self.said} {spoken.text}"[-600:]
        if self._held_at is None:
            self._end = max(self._end, self.line.played)
            self.line.play(spoken.sound)
            self._note(spoken.reference, self._end)
        self._queue.append(_Queued(self._end, spoken, place))
        self._end += len(spoken.sound) / SECOND

    def hold(self, now: float) -> None:
        """Silence the loudspeaker immediately, at the time `now`, and keep the rest of the speech."""
        if self._held_at is None:
            self._held_at = self.line.played
            self.silent_since = now
            self._released.clear()
            self.line.stop()
            self._cut_track(self._held_at)

    def release(self) -> None:
        """Continue the speech that `hold` stopped, from the beginning of the word that was cut."""
        if self._held_at is None:
            return
        self._heard = self._heard_end()
        stopped, self._held_at, self.silent_since = self._held_at, None, None
        at = self.line.played
        left = [part for part in self._queue if part.end > stopped]
        for part in left:
            skip = 0.0
            if part.start < stopped:
                skip = max([word.time for word in part.spoken.words if part.start + word.time <= stopped], default=0.0)
                if stopped - part.start - skip > 1.0:  # in the silence after the last word
                    skip = stopped - part.start
            rest = part.spoken.sound[2 * round(skip * OUT_RATE) :]
            part.start = at - skip
            self.line.play(rest)
            self._note(part.spoken.reference[2 * round(skip * IN_RATE) :], at)
            at += len(rest) / SECOND
        self._end = at
        self._released.set()

    async def played_out(self) -> None:
        """Wait until all sound has been played. While the speech is held, keep waiting."""
        while True:
            await self.line.drained()
            if self._held_at is None:
                return
            await self._released.wait()

    async def room(self) -> None:
        """Wait until little sound is left in the queue. Do not wait for sound that the line dropped without playing it."""
        while (left := self.lead - LEAD) > 0.0:
            with contextlib.suppress(TimeoutError):
                async with asyncio.timeout(max(0.05, left)):
                    await self.played_out()
                    self._end = self.line.played

    def stop(self) -> None:
        """Silence the loudspeaker, and drop the rest of the utterance."""
        if self._held_at is None:
            self.line.stop()
            self._cut_track(self.line.played)
        self._held_at = self.silent_since = None
        self.speaking = False
        self._queue.clear()

    def heard(self, text: str) -> str:
        """Return the words of the utterance `text` that the user has heard."""
        return text[: self._heard_end()].strip()

    def _heard_end(self) -> int:
        position, end = self.position, self._heard
        for part in self._queue:
            words, sound = part.spoken.words, part.spoken.sound
            for number, word in enumerate(words):
                following = words[number + 1].time if number + 1 < len(words) else len(sound) / SECOND
                length = _speech_end(sound[2 * round(word.time * OUT_RATE) : 2 * round(following * OUT_RATE)])
                if part.start + word.time + HEARD * length <= position:
                    end = max(end, part.place + word.end)
        return end

    # ------------------------------------------------------------------------------- the echo's reference

    def reference(self, size: int) -> bytes:
        """Return the sound (PCM at `IN_RATE`) that played while the microphone recorded its last `size` bytes."""
        now, length = self.line.played, size / 2 / IN_RATE
        advances, self._before = now > self._before + 1e-6, now
        if not advances:
            self._at = now
            return bytes(size)
        if abs(self._at + length - now) > DRIFT:
            self._at = max(0.0, now - length)
        begin, self._at = self._at, self._at + length
        return self._slice(begin, size)

    def _slice(self, begin: float, size: int) -> bytes:
        out = bytearray(size)
        for start, sound in self._track:
            offset = 2 * round((start - begin) * IN_RATE)
            if -len(sound) < offset < size:
                part = sound[max(0, -offset) : max(0, -offset) + size - max(0, offset)]
                out[max(0, offset) : max(0, offset) + len(part)] = part
        return bytes(out)

    def _note(self, sound: bytes, at: float) -> None:
        self._track = [(start, old) for start, old in self._track if start > at - KEPT]
        self._track.append((at, sound))

    def _cut_track(self, at: float) -> None:
        self._track = [
            (start, sound[: 2 * max(0, round((at - start) * IN_RATE))]) for start, sound in self._track if start < at
        ]


def _speech_end(pcm: bytes) -> float:
    level = np.abs(samples(pcm).astype(np.int32))
    loud = np.flatnonzero(level > FAINT * level.max(initial=0))
    return float(loud[-1]) / OUT_RATE if len(loud) else 0.0
