"""Find the words that the user really heard: the part of each synthesised sentence in the loudspeaker's file."""

from __future__ import annotations

import contextlib
from collections.abc import Iterator, Sequence
from typing import Any
from unittest.mock import patch

import numpy as np

from ravestate.modules import rawio
from ravestate.modules.platform.voiceio import sound
from ravestate.modules.platform.voiceio.synthesiser import Spoken, Synthesiser

PIECE, STEP = 480, 48
"""The number of samples of a piece to look for in the file (20 ms), and of samples between two pieces (2 ms)."""
LOUD = 300
"""The minimum level of a piece. A piece that is at least this loud occurs in the file only if its sentence does."""
FRAME = 240
"""The number of samples of a frame, for measuring its power: 10 ms."""


@contextlib.contextmanager
def noted() -> Iterator[list[Spoken]]:
    """Give a list that gets each sentence that is synthesised within the ``with`` block."""
    found: list[Spoken] = []
    real = Synthesiser.speak

    def speak(self: Synthesiser, *given: Any, **named: Any) -> Spoken:
        found.append(real(self, *given, **named))
        return found[-1]

    with patch.object(Synthesiser, "speak", speak):
        yield found


def heard_words(story: str, sentences: Sequence[Spoken], played: bytes) -> str:
    """Return the part of a story of which at least half of the last word is in a sound.

    The sound has the samples of the synthesiser unchanged, so the place of the cut is exact. The synthesiser tells where
    each word begins; a word ends where its sound does.

    Args:
        story: The text.
        sentences: The synthesised sentences.
        played: The sound of the loudspeaker (PCM at `rawio.OUT_RATE`) during the story.
    """
    end = 0
    for sentence in sentences:
        place = story.find(sentence.text.strip())
        if place < 0:
            continue
        place -= len(sentence.text) - len(sentence.text.lstrip())
        until = _until(sentence.sound, played)
        bounds = [*(round(word.time * rawio.OUT_RATE) for word in sentence.words), len(sentence.sound) // 2]
        for word, begin, following in zip(sentence.words, bounds, bounds[1:], strict=False):
            if begin + _length(sound.samples(sentence.sound)[begin:following]) / 2 <= until:
                end = max(end, place + word.end)
    return story[:end].strip()


def _until(pcm: bytes, played: bytes) -> int:
    """Return the samples of a sentence after its beginning until the last one that was played."""
    for end in range(len(pcm) // 2, PIECE, -STEP):
        piece = pcm[2 * (end - PIECE) : 2 * end]
        if np.abs(sound.samples(piece).astype(int)).max() > LOUD and piece in played:
            return end
    return 0


def _length(samples: sound.Samples) -> int:
    """Return the samples of a word until its power falls below a hundredth of the word's greatest power."""
    frames = samples[: len(samples) // FRAME * FRAME].reshape(-1, FRAME).astype(float)
    if not len(frames):
        return len(samples)
    power = (frames**2).mean(axis=1)
    return FRAME * (int(np.flatnonzero(power >= power.max() / 100)[-1]) + 1)
