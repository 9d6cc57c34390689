"""Sound for the tests: synthesised speech at given times, and recordings of people."""

from __future__ import annotations

import sys
import threading
from collections.abc import Callable, Sequence
from functools import lru_cache
from pathlib import Path
from typing import Any

import numpy as np

import ravestate as rs
from ravestate.modules import rawio
from ravestate.modules.platform.voiceio import Settings, sound
from ravestate.modules.platform.voiceio.manner import Prosody
from ravestate.modules.platform.voiceio.synthesiser import Synthesiser

FOLDER = Path(sys.prefix) / "share" / "ravestate" / "voice"
PEOPLE = Path("/usr/share/pocketsphinx/test/data")
FAST = {"voiceio": {"model": "tiny.en", "voice": "espeak", "captions": 0}}
"""Settings with which conversations need little computing time."""


@lru_cache(maxsize=8)
def voice(name: str = "piper") -> Synthesiser:
    return Synthesiser(Settings(voice=name))


@lru_cache(maxsize=256)
def spoken(text: str, name: str = "piper") -> bytes:
    """Return a text as sound for a microphone (16 kHz), without silence at the beginning and the end.

    The voice is monotonous, because otherwise its sound would depend on earlier texts and on the order of the tests.
    """
    pcm = sound.resample(voice(name).speak(text, Prosody(range=0.0)).sound, 24000, 16000)
    loud = np.flatnonzero(np.abs(sound.samples(pcm).astype(int)) > 150)
    return pcm[2 * loud[0] : 2 * loud[-1]]


def track(*parts: tuple[float, str | bytes], length: float = 0.0, name: str = "piper") -> bytes:
    """Return a recording in which each part begins at its time (seconds). A part is a text or a sound."""
    found = np.zeros(round(length * 16000))
    for at, what in parts:
        part = sound.samples(spoken(what, name) if isinstance(what, str) else what).astype(float)
        begin = round(at * 16000)
        found = np.pad(found, (0, max(0, begin + len(part) - len(found))))
        found[begin : begin + len(part)] += part
    return np.clip(found, -32768, 32767).astype("<i2").tobytes()


def noise(length: float, level: float, seed: int = 0) -> bytes:
    return (np.random.default_rng(seed).normal(0, level, round(length * 16000))).astype("<i2").tobytes()


def wav(path: Path, pcm: bytes) -> Path:
    sound.write_wav(path, pcm, 16000)
    return path


def word_errors(wanted: str, found: str) -> int:
    """Return the number of missing, wrong and superfluous words in `found`, compared with `wanted`."""
    a, b = plain(wanted), plain(found)
    row = list(range(len(b) + 1))
    for i, x in enumerate(a, 1):
        before, row[0] = row[0], i
        for j, y in enumerate(b, 1):
            before, row[j] = row[j], min(row[j] + 1, row[j - 1] + 1, before + (x != y))
    return row[-1]


def plain(text: str) -> list[str]:
    kept = "".join(c if c.isalnum() or c == "'" else " " for c in text.lower())
    return kept.split()


STORY = (
    "Once there was a robot. ",
    "It lived in a museum full of old paintings. ",
    "One night it heard a strange noise in the hall, and it went to look for the reason. ",
    "There was a small cat behind the door.",
)


def storyteller(slow: float = 0.0) -> rs.Module:
    """Return a module that tells a story piece by piece. To all other inputs, it says good night after `slow` seconds."""
    module = rs.Module("storyteller", requires=[rawio])

    @module.rule(
        when=rawio.input.changed,
        writes=(rawio.output, rawio.speaking),
        emits=rawio.piece,
        until=rawio.input.changed,
    )
    async def tell(ctx: rs.RuleContext) -> None:
        if "story" not in ctx.payload(rawio.input.changed).lower():
            await ctx.sleep(slow)
            ctx[rawio.output] = "Good night."
            return
        ctx[rawio.speaking] = True
        try:
            for piece in STORY:
                await ctx.sleep(0.1)
                ctx.emit(rawio.piece, piece)
            ctx[rawio.output] = "".join(STORY)
        finally:
            ctx[rawio.speaking] = False

    del tell
    return module


class Scripted:
    """A stand-in for a recogniser. It returns the given texts one after another, and then repeats the last one."""

    busy = False

    def __init__(self, *texts: str | Exception, confidence: float = 0.9) -> None:
        self.texts: Sequence[str | Exception] = texts
        self.confidence = confidence
        self.heard: list[float] = []
        self.begun = threading.Event()
        """Set when a recognition begins."""

    def __call__(self, _: Any) -> Scripted:
        return self

    def load(self) -> None: ...

    def close(self, *, linger: bool = False) -> None: ...

    def recognise(self, pcm: bytes, *, partial: bool = False, unwanted: Any = None) -> Any:
        from ravestate.modules.platform.voiceio.recogniser import Recognised

        self.heard.append(len(pcm) / 32000)
        self.begun.set()
        text = self.texts[min(len(self.heard), len(self.texts)) - 1]
        if isinstance(text, Exception):
            raise text
        return Recognised(text, self.confidence if text else 0.0)


Change = Callable[[Any], Any]
