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
"""The length of a piece of a sentence (20 ms), and the distance between the ends of two pieces (2 ms), in samples.

The file of the loudspeaker is searched for the pieces.
"""
LOUD = 300
"""Only pieces whose greatest amplitude is above this level are used. Such a loud piece is in the file only if its
sentence was played."""
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
    """Return a story up to the last word that the user heard. A word counts if at least half of its sound was played.

    The loudspeaker plays the synthesiser's samples unchanged. So the last loud piece that was played is found to within
    2 ms. The synthesiser gives the time at which each word begins, and `_length` finds where its sound ends.

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
    """Return how many samples of a sentence lie before the end of its last loud piece that was played; 0 if none was."""
    for end in range(len(pcm) // 2, PIECE, -STEP):
        piece = pcm[2 * (end - PIECE) : 2 * end]
        if np.abs(sound.samples(piece).astype(int)).max() > LOUD and piece in played:
            return end
    return 0


def _length(samples: sound.Samples) -> int:
    """Return the number of samples until a word's power stays below a hundredth of its greatest power."""
    frames = samples[: len(samples) // FRAME * FRAME].reshape(-1, FRAME).astype(float)
    if not len(frames):
        return len(samples)
    power = (frames**2).mean(axis=1)
    return FRAME * (int(np.flatnonzero(power >= power.max() / 100)[-1]) + 1)
