"""Find the beginnings and pauses of the user's speech, and keep the sound of the turn so far.

A *chunk* has `CHUNK` samples (32 ms). A chunk of speech is *articulate* if it comes from an open mouth (see
`is_articulate`). An *onset* is the beginning of speech. A *turn* is the user's speech, with its short pauses, until the
agent may answer.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Literal, Protocol

import numpy as np

from ravestate.modules.modality.rawio.line import IN_RATE

from .activity import CHUNK, Activity
from .echo import FRAME
from .leak import Leak
from .pitch import NEEDED, change, is_another, pitch
from .sound import Samples, samples

BEFORE = 12
"""A turn begins with this many chunks up to its onset and including it, so that a soft beginning is not cut off."""
ONSET = 2
"""This many successive chunks of speech are an onset. A click lasts for fewer chunks."""
STAY = 0.7
"""While the user speaks, the threshold of speech is multiplied by this factor, so that soft chunks continue the
speech."""
ARTICULATE = 3
"""This many articulate chunks since the onset prove speech, rather than a hum or a cough."""
LONG = 16
"""This many chunks since the onset (half a second) prove speech, even if they are not articulate."""
LONGEST = 60.0
"""The longest turn (seconds). A longer turn is split into several turns."""
CLIPPED = 0.02
"""A second of speech counts as clipped (too loud) if more than this share of its samples is at the limit of 16 bits."""

COMPARED = round(2.0 * IN_RATE / CHUNK)
"""When a pause begins, the ear compares the voices before and after the previous pause: at most this many chunks (2 s)
on each side."""
SEARCHED = round(8.0 * IN_RATE / CHUNK)
"""If that comparison finds no other person, the ear looks for a change of voice in the last chunks of the turn so far:
at most this many (8 s)."""

Event = Literal["onset", "articulate", "another", "pause"]


class Canceller(Protocol):
    """The part of an echo canceller that an ear uses. See `EchoCanceller`."""

    def clean(self, near: bytes, far: bytes) -> bytes: ...

    def close(self) -> None: ...


@dataclass(slots=True, eq=False)
class Turn:
    """The user's turn so far.

    Attributes:
        start: The time of the onset (seconds).
        end: The time of the last speech so far.
        agent_spoke: Whether the agent was speaking at the onset.
        full: Whether the turn has reached its greatest length, and is therefore over.
    """

    start: float
    end: float
    agent_spoke: bool = False
    full: bool = False
    chunks: list[bytes] = field(default_factory=list[bytes])
    pitches: list[float | None] = field(default_factory=list[float | None])
    """The pitch (Hz) of each chunk; None for a chunk without a voice."""
    continued: tuple[int, float, float] | None = None
    """How the turn continued after its last pause: the index of the first new chunk, its time, and the time at which
    the pause began."""

    @property
    def sound(self) -> bytes:
        """The sound (PCM at `IN_RATE`) with a little silence on both sides."""
        return b"".join(self.chunks)


class Ear:
    """The ear of one `Line` (a user's microphone and loudspeaker).

    The ear gets blocks of sound and yields events, for example onsets and pauses.

    Args:
        speech: The minimum probability of speech for a chunk to count as speech.
        pause: This many seconds of silence are a pause.
        canceller: The canceller that removes the echo; None for a line without echo.
    """

    def __init__(self, speech: float = 0.5, pause: float = 0.2, canceller: Canceller | None = None) -> None:
        self.turn: Turn | None = None
        """The present turn, even during a pause. None if there has been no onset since the last turn."""
        self.speaking = False
        """Whether the user is speaking."""
        self.parted: Turn | None = None
        """The turn of the first person, after another person has begun to speak (event ``another``)."""
        self.clipped = False
        """Whether the sound has been so loud that its peaks were cut off."""
        self._activity = Activity()
        self._speech = speech
        self._pause = round(pause * IN_RATE / CHUNK)
        self._canceller = canceller
        self._leak = Leak()
        self._frames = bytearray()  # the microphone's sound that does not fill a frame of the canceller yet
        self._far = bytearray()  # the loudspeaker's sound at the same time
        self._clean = bytearray()  # the sound without echo that does not fill a chunk yet
        self._before: deque[bytes] = deque(maxlen=BEFORE)  # the last chunks before a turn
        self._lately: deque[bool] = deque(maxlen=ONSET)  # whether the last chunks are articulate
        # How many of the newest chunks in a row are speech; while the user speaks, how many came since the last speech.
        self._in_a_row = self._silent = 0
        self._spoken = self._articulate = 0  # how many chunks, and how many articulate ones, came since the onset
        self._at_limit = 0  # how many samples in this second of speech are clipped
        self._sure = False  # whether the ear has yielded ``articulate`` since the onset

    def feed(self, block: bytes, now: float, far: bytes = b"", *, agent_speaks: bool = False) -> Iterator[Event]:
        """Listen to a block of sound, and yield the events in it.

        Args:
            block: The sound (PCM at `IN_RATE`), of any length.
            now: The time at the end of the block (seconds).
            far: The loudspeaker's sound at the same time, of the same length as `block`; empty for silence.
            agent_speaks: Whether the agent is speaking.
        """
        self._clean += self._without_echo(block, far)
        while len(self._clean) >= 2 * CHUNK:
            chunk, self._clean = bytes(self._clean[: 2 * CHUNK]), self._clean[2 * CHUNK :]
            yield from self._hear(chunk, now - len(self._clean) / 2 / IN_RATE, agent_speaks)

    def take(self) -> Turn | None:
        """End the turn, and return it; None if there is none."""
        turn, self.turn = self.turn, None
        return turn

    def reset(self) -> None:
        """Forget the present turn, and the chunks before it. Keep what the ear knows about the echo."""
        self.take()
        self.speaking = False
        self._in_a_row = self._silent = 0
        self._before.clear()
        self._activity.reset()

    def close(self) -> None:
        """Free the memory of the canceller; from now on, echo stays in the sound."""
        canceller, self._canceller = self._canceller, None
        if canceller is not None:
            canceller.close()

    # ------------------------------------------------------------------------------- internals

    def _without_echo(self, block: bytes, far: bytes) -> bytes:
        self._frames += block
        self._far += far if len(far) == len(block) else bytes(len(block))
        clean = bytearray()
        while len(self._frames) >= 2 * FRAME:
            near, played = bytes(self._frames[: 2 * FRAME]), bytes(self._far[: 2 * FRAME])
            del self._frames[: 2 * FRAME], self._far[: 2 * FRAME]
            self._leak.play(samples(near), samples(played))
            cleaned = near if self._canceller is None else self._canceller.clean(near, played)
            # If there is no echo, the canceller would only damage the user's speech while the agent speaks.
            clean += cleaned if self._leak.echoes else near
        return bytes(clean)

    def _hear(self, chunk: bytes, now: float, agent_speaks: bool) -> Iterator[Event]:
        sound = samples(chunk)
        likely = self._activity.probability(sound)
        length = CHUNK / IN_RATE
        hidden = self._leak.hides(sound)
        is_speech = likely >= (self._speech * STAY if self.speaking else self._speech) and not hidden
        self._in_a_row = self._in_a_row + 1 if is_speech else 0
        articulate = is_speech and is_articulate(sound)
        self._lately.append(articulate)
        if self.turn is not None:
            self.turn.chunks.append(chunk)
            self.turn.pitches.append(self._pitch() if is_speech else None)
        else:
            self._before.append(chunk)
        if not self.speaking:
            if self._in_a_row >= ONSET:
                self._begin(now - ONSET * length, agent_speaks)
                yield "onset"
            return
        assert self.turn is not None
        self._spoken += 1
        self._articulate += articulate
        self._note_clipping(sound)
        if not self._sure and (self._articulate >= ARTICULATE or self._spoken >= LONG):
            self._sure = True
            yield "articulate"
        if is_speech:
            self._silent = 0
            self.turn.end = now
        else:
            self._silent += 1
        self.turn.full = now - self.turn.start > LONGEST
        if self._silent >= self._pause or self.turn.full:
            self.speaking = False
            if self._part(now):
                yield "another"
            yield "pause"

    def _begin(self, now: float, agent_speaks: bool) -> None:
        self.speaking, self._sure = True, False
        self._silent, self._spoken, self._articulate = 0, ONSET, sum(self._lately)
        if self.turn is None:
            self.turn = Turn(now, now, agent_speaks, chunks=list(self._before))
            self.turn.pitches = [None] * len(self.turn.chunks)
            self._before.clear()
        else:
            first = max(1, len(self.turn.chunks) - ONSET - 2)
            self.turn.continued = first, now, self.turn.end

    def _pitch(self) -> float | None:
        """Return the pitch of the newest chunk, measured together with the end of the previous chunk."""
        assert self.turn is not None
        lately = samples(b"".join(self.turn.chunks[-2:]))[-NEEDED:]
        return pitch(lately) if len(lately) == NEEDED else None

    def _part(self, now: float) -> bool:
        """If a second person has begun to speak in the turn, split the turn in two. Return whether it was split."""
        turn = self.turn
        if turn is None:
            return False
        continued, turn.continued = turn.continued, None
        if continued is not None and is_another(
            turn.pitches[max(0, continued[0] - COMPARED) : continued[0]],
            turn.pitches[continued[0] : continued[0] + COMPARED],
        ):
            first, begun, ended = continued
        else:
            searched = max(0, len(turn.chunks) - SEARCHED)
            if (place := change(turn.pitches[searched:])) is None:
                return False
            first = searched + place
            begun = ended = now - (len(turn.chunks) - first) * CHUNK / IN_RATE
        self.parted = Turn(turn.start, ended, turn.agent_spoke, chunks=turn.chunks[:first])
        self.turn = Turn(begun, turn.end, turn.agent_spoke, turn.full, turn.chunks[first:], turn.pitches[first:])
        return True

    def _note_clipping(self, sound: Samples) -> None:
        self._at_limit += int(np.count_nonzero(np.abs(sound.astype(np.int32)) >= 32700))
        if self._spoken % round(IN_RATE / CHUNK) == 0:
            self.clipped = self.clipped or self._at_limit > CLIPPED * IN_RATE
            self._at_limit = 0


def is_articulate(sound: Samples) -> bool:
    """Return whether a chunk of speech comes from an open mouth. A hum has hardly any power above 600 Hz."""
    power = np.abs(np.fft.rfft(sound * np.hanning(len(sound)))) ** 2
    per_hertz = len(sound) / IN_RATE
    low = power[round(80 * per_hertz) : round(600 * per_hertz)].sum() + 1e-9
    high = power[round(600 * per_hertz) :].sum()
    return bool(high > 0.1 * low)
