"""An agent for tests of the sound on a page. It distinguishes loud from quiet, and answers with tones."""

from __future__ import annotations

import array
import math

import ravestate as rs
from ravestate.modules import rawio

LOUD = 0.02
"""The level from which a block of sound counts as loud. The maximum level is 1."""

PAUSE = 0.4
"""The time of quiet that ends an utterance (seconds)."""

WORD = 0.3
"""The length of the tone that the agent plays for each word (seconds)."""

ears = rs.Module("ears", requires=(rawio,))
level = ears.slot("level", 0.0)


def level_of(block: bytes) -> float:
    """Return the level of 16-bit samples, from 0 to 1."""
    samples = array.array("h", block)
    return math.sqrt(sum(sample * sample for sample in samples) / max(1, len(samples))) / 32768


def tone(seconds: float, rate: int = rawio.OUT_RATE) -> bytes:
    """Return a tone of 440 Hz."""
    return array.array(
        "h", (round(12000 * math.sin(2 * math.pi * 440 * n / rate)) for n in range(round(seconds * rate)))
    ).tobytes()


def babble(seconds: float, rate: int = rawio.IN_RATE) -> bytes:
    """Return a sound like a voice: a hoarse tone in syllables. A browser does not take it for noise."""
    samples = array.array("h")
    for n in range(round(seconds * rate)):
        time = n / rate
        pitch = 130 + 25 * math.sin(2 * math.pi * 1.3 * time)
        sound = sum(math.sin(2 * math.pi * k * pitch * time) / k for k in range(1, 12))
        samples.append(round(6000 * sound * max(0.0, math.sin(2 * math.pi * 2.2 * time)) ** 0.5))
    return samples.tobytes()


@ears.rule(
    when=rawio.sound.changed.where(lambda line: line is not None).max_age(None).detached(),
    writes=(rawio.input, level),
    emits=rawio.hearing,
    detached=True,
    background=True,
)
async def listen(ctx: rs.RuleContext) -> None:
    """Turn each loud period into an input. While a period lasts, report its length so far."""
    line = ctx.payload(rawio.sound.changed)
    loud = quiet = told = 0.0
    async for block in line.blocks():
        seconds = len(block) / 2 / rawio.IN_RATE
        ctx[level] = level_of(block)
        if level_of(block) >= LOUD:
            loud, quiet = loud + quiet + seconds, 0.0
            if loud - told > 0.2:
                told = loud
                ctx.emit(rawio.hearing, f"a sound of {loud:.1f} seconds so far")
        elif loud:
            quiet += seconds
            if quiet >= PAUSE:
                if loud > 0.2:
                    ctx[rawio.input] = "a sound"
                loud = quiet = told = 0.0


@ears.rule(when=rawio.output.changed.max_age(None).detached(), reads=rawio.sound, writes=rawio.heard, background=True)
async def speak(ctx: rs.RuleContext) -> None:
    """Play a tone for each word. Then report the words that the visitor heard, even if the sound was cut short."""
    line, words = ctx[rawio.sound], ctx.payload(rawio.output.changed).split()
    if line is None:
        return
    before = line.played
    for _ in words:
        line.play(tone(WORD))
    await line.drained()
    heard = round((line.played - before) / WORD, 1)
    ctx[rawio.heard] = " ".join(words[: math.floor(heard)])


@ears.rule(when=rawio.hearing.max_age(None).detached(), reads=rawio.sound, background=True)
async def give_way(ctx: rs.RuleContext) -> None:
    """Stop speaking while the visitor speaks."""
    if line := ctx[rawio.sound]:
        line.stop()


story = rs.Module("story", requires=(rawio,))


@story.rule(when=rawio.input.changed, writes=rawio.output)
async def tell(ctx: rs.RuleContext) -> None:
    ctx[rawio.output] = f"I heard {ctx.payload(rawio.input.changed)}, and that pleases me."


saga = rs.Module("saga", requires=(rawio,))
SAGA = "I heard a sound, and that reminds me of" + 30 * " far" + " hills."


@saga.rule(when=rawio.input.changed, writes=rawio.output)
async def tell_at_length(ctx: rs.RuleContext) -> None:
    """Say something long, so that the visitor can interrupt the agent."""
    ctx[rawio.output] = SAGA
