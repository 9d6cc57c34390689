"""Material for the measurements of speech: sentences, tracks of a microphone, a room with an echo, a narrator."""

from __future__ import annotations

import contextlib
import sys
import tempfile
from collections.abc import AsyncIterator, Iterator, Sequence
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from typing import Any
from unittest.mock import patch

import numpy as np

import ravestate as rs
from ravestate.modules import rawio, voiceio
from ravestate.modules.platform.voiceio import opening, sound
from ravestate.modules.platform.voiceio.recogniser import Recogniser
from ravestate.modules.platform.voiceio.synthesiser import Synthesiser
from ravestate.modules.platform.voiceio.wav_line import WavLine
from ravestate.testing import Said, talk

MODELS = Path(sys.prefix) / "share" / "ravestate" / "voice"
PEOPLE = Path("/usr/share/pocketsphinx/test/data")

COMPLETE = (
    "What time is it?", "I would like a cup of coffee.", "My name is Robert.", "Do you like music?",
    "Tell me about your family.", "It was raining all day yesterday.", "Can you help me with this?",
    "I live in a small town near the sea.", "Where did you put the keys?", "My sister plays the piano.",
    "That is a very good idea.", "I have two cats and a dog.", "How old is your brother?", "We went to the cinema last night.",
    "Please turn on the light.", "I do not like this film.", "The train leaves at seven.", "What is your favourite book?",
    "He works as a teacher in London.", "Let us talk about something else.", "I am tired today.",
    "Have you ever been to Paris?", "She bought a new car last week.", "There is nobody at home.", "I think it will rain tomorrow.",
    "Could you repeat the last sentence?", "My phone is broken.", "Why are you laughing?", "They moved to a bigger house.",
    "Good morning.", "Thank you very much.", "I forgot my umbrella.",
)  # fmt: skip
"""Sentences that are complete."""

OPEN = (
    ("I would like to go to the", "station."), ("My favourite colour is", "green."), ("When I was a child, I", "had a dog."),
    ("Could you please tell me where the", "toilet is?"), ("I think that the", "weather is nice."),
    ("The weather was so bad that we", "stayed at home."), ("Yesterday I met a man who", "sells old clocks."),
    ("What I really want to know is whether", "you like me."), ("We bought bread and", "cheese."),
    ("I need a ticket to", "Berlin."), ("She told me that her", "brother is ill."), ("I am looking for a", "red hat."),
    ("He gave the book to my", "sister."), ("It is cold because the", "window is open."), ("I came here with", "my friends."),
    ("Do you know if the", "shop is open?"), ("I want", "a glass of water."), ("There is a letter from", "your mother."),
    ("If you have time, we", "can go for a walk."), ("I usually get up at", "six."), ("Let's", "go home now."),
    ("I have been waiting for", "an hour."), ("The best thing about this town is the", "river."),
    ("You can come with us or", "stay here."), ("My father worked in an", "office."), ("Would you like tea or", "coffee?"),
    ("I was on my way to the", "market."), ("They asked us to", "wait outside."), ("It is a photograph of my", "house."),
    ("Before we leave, I", "have to call him."),
)  # fmt: skip
"""Beginnings of sentences, each with its continuation after a pause."""

INTERRUPTIONS = (
    "Stop, that is enough.", "Wait a moment please.", "Excuse me, I have a question.", "Can you tell me something else?",
    "No, I do not want to hear this.", "Sorry, what did you say?", "Please be quiet now.", "What is the time?",
    "Hold on, I need a break.", "My name is Robert, by the way.",
)  # fmt: skip
BACK_CHANNELS = (
    "Yes.",
    "Yeah.",
    "Okay.",
    "I see.",
    "Mhm.",
    "Right.",
    "Ha ha ha!",
    "Oh.",
    "Uh-huh.",
    "Sure.",
    "Hmm.",
    "Yeah, okay.",
)

STORIES = (
    "Once there was a robot. It lived in a museum full of old paintings. One night it heard a strange noise in the hall, and "
    "it went to look for the reason. There was a small cat behind the door. The robot gave the cat some milk, and the two "
    "became friends. Every evening they walked through the empty rooms and looked at the pictures of ships and mountains.",
    "A long time ago a baker had a shop beside the river. His bread was so good that people came from far away to buy it. "
    "One morning the oven was cold, and nobody knew the reason. The baker looked under the floor and found a family of mice. "
    "They had built a warm nest of paper and wool between the stones of the oven.",
    "In the middle of the forest stood a tower with a golden bell. Nobody had heard its sound for a hundred years. One day a "
    "girl climbed up the stairs and touched the bell with her hand. It began to ring, and all the birds in the forest "
    "answered with their songs until the evening.",
)


@lru_cache(maxsize=8)
def voice(name: str) -> Synthesiser:
    """Return a voice; it stays loaded."""
    return Synthesiser(voiceio.Settings(voice=name))


@lru_cache(maxsize=4)
def recogniser(model: str) -> Recogniser:
    """Return a recogniser; it stays loaded."""
    return Recogniser(voiceio.Settings(model=model))


@lru_cache(maxsize=1024)
def spoken(text: str, name: str = "piper") -> bytes:
    """Return a text as a microphone hears it (16 kHz), without silence at its ends."""
    pcm = sound.resample(voice(name).speak(text).sound, rawio.OUT_RATE, rawio.IN_RATE)
    loud = np.flatnonzero(np.abs(sound.samples(pcm).astype(int)) > 150)
    return pcm[2 * int(loud[0]) : 2 * int(loud[-1])]


def track(parts: Sequence[tuple[float, bytes]], length: float) -> bytes:
    """Return a microphone's track with sounds at their times (seconds)."""
    found = np.zeros(round(length * rawio.IN_RATE))
    for at, pcm in parts:
        begin = round(at * rawio.IN_RATE)
        part = sound.samples(pcm)[: len(found) - begin]
        found[begin : begin + len(part)] += part
    return np.clip(found, -32768, 32767).astype("<i2").tobytes()


def cough(seed: int) -> bytes:
    """Return a burst of noise that fades."""
    noise = np.random.default_rng(seed).normal(0, 9000, 5600) * np.exp(-np.arange(5600) / 1600)
    return np.clip(noise, -32768, 32767).astype("<i2").tobytes()


class Room(WavLine):
    """A line (microphone and loudspeaker) in a room. The microphone hears the loudspeaker, 30 ms later and softer, with
    two reflections."""

    decibels = -10.0

    async def blocks(self) -> AsyncIterator[bytes]:
        """Yield the recording and the echo."""
        size = 2 * round(0.02 * rawio.IN_RATE)
        gain = 10 ** (self.decibels / 20)
        heard = np.zeros(rawio.IN_RATE * 2)  # the loudspeaker's last two seconds
        async for block in super().blocks():
            far = np.frombuffer(self._lately(size), "<i2").astype(float)
            heard = np.concatenate([heard[len(far) :], far])
            echo = sum(
                share * heard[len(heard) - shift - len(far) : len(heard) - shift]
                for share, shift in ((1.0, 480), (0.4, 672), (0.2, 976))
            )
            mixed = np.frombuffer(block, "<i2").astype(float) + gain * np.asarray(echo)
            yield np.clip(mixed, -32768, 32767).astype("<i2").tobytes()

    def _lately(self, size: int) -> bytes:
        """Return the sound (16 kHz) that the loudspeaker played in the last 20 ms."""
        import asyncio

        end = asyncio.get_running_loop().time()
        out = np.zeros(size // 2)
        for begin, pcm in self._out.parts():
            offset = begin - (end - 0.02)
            if not -len(pcm) / 48000 < offset < 0.02:
                continue
            times = np.arange(size // 2) / rawio.IN_RATE - offset
            data = sound.samples(pcm).astype(float)
            inside = (times >= 0) & (times < (len(data) - 1) / rawio.OUT_RATE)
            out[inside] += np.interp(times[inside] * rawio.OUT_RATE, np.arange(len(data)), data)
        return np.clip(out, -32768, 32767).astype("<i2").tobytes()


@contextlib.contextmanager
def echoing() -> Iterator[None]:
    """Make every recording play in a `Room`, within the ``with`` block."""
    with patch.object(opening, "WavLine", Room):
        yield


def narrator() -> rs.Module:
    """Return an agent that answers everything with the next story."""
    module = rs.Module("narrator", requires=[rawio])
    number = module.slot("number", 0)

    @module.rule(when=rawio.input.changed, writes=(rawio.output, number))
    async def tell(ctx: rs.RuleContext) -> None:
        ctx[rawio.output] = STORIES[ctx[number] % len(STORIES)]
        ctx[number] += 1

    del tell
    return module


def conversation(pcm: bytes, output: Path | None = None, record: Any = None, **settings: Any) -> list[Said]:
    """Hold a conversation between a microphone's track and the narrator; return the utterances of both."""
    given = {"model": "tiny.en", "voice": "piper", "captions": 0, **settings}
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "in.wav"
        sound.write_wav(file, pcm, rawio.IN_RATE)
        return talk(file, output, narrator(), settings={"voiceio": given}, record=record)


@dataclass(frozen=True, slots=True)
class Decision:
    """A moment at which the agent decided that the user's turn was over.

    Attributes:
        time: The moment: seconds on the track's time line.
        end: The end of the speech in the turn; if the sound is not an utterance, the same as `time`.
        text: The words, or the reason why the sound is not an utterance.
    """

    time: float
    end: float
    text: str


def decisions(pcm: bytes, **settings: Any) -> list[Decision]:
    """Return the ends of turns that a silent agent finds in a microphone's track. Recognition takes no time."""
    found: list[Decision] = []
    listener = rs.Module("listener", requires=[voiceio])

    @listener.rule(when=voiceio.utterance.max_age(None).detached(), background=True)
    async def note(ctx: rs.RuleContext) -> None:
        said = ctx.payload(voiceio.utterance)
        found.append(Decision(ctx.now, said.end, said.text))

    @listener.rule(when=voiceio.false_alarm.max_age(None).detached(), background=True)
    async def note_false(ctx: rs.RuleContext) -> None:
        found.append(Decision(ctx.now, ctx.now, ctx.payload(voiceio.false_alarm)))

    del note, note_false
    given = {"model": "tiny.en", "voice": "espeak", "captions": 0, "filler_after": 0, **settings}
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "in.wav"
        sound.write_wav(file, pcm, rawio.IN_RATE)
        talk(file, None, listener, settings={"voiceio": given})
    return found


def word_errors(wanted: Sequence[str], found: Sequence[str]) -> int:
    """Return the number of words that are missing, wrong or too many."""
    row = list(range(len(found) + 1))
    for i, x in enumerate(wanted, 1):
        before, row[0] = row[0], i
        for j, y in enumerate(found, 1):
            before, row[j] = row[j], min(row[j] + 1, row[j - 1] + 1, before + (x != y))
    return row[-1]


def plain(text: str) -> list[str]:
    """Return the words of a text in lower case, without punctuation."""
    return "".join(c if c.isalnum() or c == "'" else " " for c in text.lower()).split()
