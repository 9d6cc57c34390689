"""How well does the agent understand speech, take turns, and give way; and how long does the user wait?

- Words: the share of wrong words in recordings of people (LibriVox, from Debian's pocketsphinx-testdata).
- Wait: the time from the end of the user's speech to the first sound of the answer, on the clock of this machine. It
  has four parts: the pause that the settings demand, understanding, synthesis, and the rest, which is our own share. To
  understand, one model finds the words, and another judges whether the turn has ended. Both work at the same time, so
  only the slower model adds to the wait.
- False cuts and missed ends: a recording has complete sentences, and sentences with a pause of a second in the middle.
  A false cut ends the turn in such a pause. With a missed end, the agent does not notice that a sentence is complete,
  and waits for the longest pause of the settings.
- Interruptions, back-channels and the echo are measured on the time line of a recording, in virtual time.
- Heard: the words of an interrupted story that the user heard, according to the agent and according to the
  loudspeaker's file. A word counts as heard if at least half of it is in the file.
"""

from __future__ import annotations

import asyncio
import statistics
import tempfile
import time
from collections.abc import AsyncIterator, Iterable
from pathlib import Path
from typing import Any

import ravestate as rs
from benchmarks.bench import Bench
from benchmarks.figures import Figure, measured
from benchmarks.peers import speech
from benchmarks.peers.heard import heard_words, noted
from benchmarks.peers.speech import BACK_CHANNELS, COMPLETE, INTERRUPTIONS, OPEN, PEOPLE, STORIES, plain, spoken, track
from ravestate.modules import rawio, voiceio
from ravestate.modules.platform.voiceio import sound
from ravestate.modules.platform.voiceio.playout import PlayOut

OWN, WHOLE = 0.020, {"tiny.en": 0.9, "base": 1.5}
"""The maximum seconds of our own share, and of the whole wait with each model."""


def ask(bench: Bench) -> Iterable[Figure]:
    """Measure everything against the claims."""
    for model in WHOLE:
        bench.progress(f"words, {model}")
        wrong = word_error_rate(model)
        yield measured(
            "voice", f"wrong words of people, {model}", [wrong], unit="core", target="<= 12%", reach=lambda x: x <= 0.12
        )
    for model, limit in WHOLE.items():
        bench.progress(f"wait, {model}")
        waits = asyncio.run(wait_for_answer(model, bench.several(7, 2)))
        for part, name in (
            ("recogniser", "recogniser"),
            ("melody", "end of turn"),
            ("voice", "first sentence of piper"),
        ):
            yield measured("voice", f"{model}: {name}", [one[part] for one in waits])
        yield measured(
            "voice", f"{model}: our own share", [one["own"] for one in waits], target="< 20 ms", reach=lambda x: x < OWN
        )
        yield measured(
            "voice", f"{model}: end of speech to first sound", [one["whole"] for one in waits],
            target=f"< {limit:g} s", reach=lambda x, limit=limit: x < limit,
        )  # fmt: skip
    bench.progress("end of turn")
    for model in WHOLE:
        cuts, missed, count = ends_of_turns(model, bench.several(30, 8))
        for name, share in ((f"false cuts of {count} pauses", cuts), (f"missed ends of {count} sentences", missed)):
            yield measured("voice", f"{model}: {name}", [share], unit="core", target="<= 10%", reach=lambda x: x <= 0.1)
    bench.progress("interruptions")
    delays, exact, near = interruptions(bench.several(20, 4))
    worst = statistics.quantiles(delays, n=20, method="inclusive")[-1]
    yield measured(
        "voice", f"onset to silence, 95 % of {len(delays)}", [worst], target="<= 300 ms", reach=lambda x: x <= 0.3
    )
    yield measured(
        "voice", "heard text right to the word", [exact], unit="core", target=">= 90%", reach=lambda x: x >= 0.9
    )
    yield measured("voice", "heard text right within a word", [near], unit="core")
    bench.progress("back-channels")
    stopped, count = back_channels(bench.several(3, 1))
    yield measured(
        "voice", f"stopped by {count} back-channels", [stopped], unit="core", target="<= 5%", reach=lambda x: x <= 0.05
    )
    bench.progress("echo")
    yield measured(
        "voice",
        "utterances out of the echo",
        [float(echoes(bench.several(3, 1)))],
        unit="",
        target="none",
        reach=lambda x: x == 0,
    )


# ---------------------------------------------------------------------------------------- words


def word_error_rate(model: str) -> float:
    """Return the share of wrong words in recordings of people."""
    wrong = total = 0
    for line in (PEOPLE / "librivox" / "transcription").read_text(encoding="utf-8").splitlines():
        words, _, name = line.rpartition("(")
        wanted = plain(words.replace("<s>", "").replace("</s>", "").replace("mister", "mr"))
        pcm = sound.decode(PEOPLE / "librivox" / f"{name.rstrip(')').strip()}.wav", rawio.IN_RATE)
        wrong += speech.word_errors(wanted, plain(speech.recogniser(model).recognise(pcm).text))
        total += len(wanted)
    return wrong / total


# ----------------------------------------------------------------------------------------- waits


class LiveLine:
    """A line (microphone and loudspeaker) whose microphone plays a track. It notes when the first sound of an answer
    comes."""

    cancels_echo = True
    ended = False

    def __init__(self, pcm: bytes) -> None:
        self._pcm = pcm
        self._out = PlayOut()
        self.first: float | None = None
        self.begun = 0.0

    async def blocks(self) -> AsyncIterator[bytes]:
        """Yield the track in blocks of 20 ms."""
        loop = asyncio.get_running_loop()
        self.begun = loop.time()
        for number in range(len(self._pcm) // 640):
            await asyncio.sleep(max(0.0, self.begun + (number + 1) * 0.02 - loop.time()))
            yield self._pcm[640 * number : 640 * (number + 1)]

    def play(self, sound: bytes) -> None:
        """Note the time of the first sound."""
        now = asyncio.get_running_loop().time()
        self.first = self.first or now
        self._out.play(sound, now)

    def stop(self) -> None:
        """Drop the queued sound."""
        self._out.stop(asyncio.get_running_loop().time())

    @property
    def played(self) -> float:
        """The seconds that were played."""
        return self._out.played(asyncio.get_running_loop().time())

    async def drained(self) -> None:
        """Wait until the sound has been played."""
        await asyncio.sleep(max(0.0, self._out.end - asyncio.get_running_loop().time()))

    def close(self) -> None:
        """Do nothing."""


async def wait_for_answer(model: str, rounds: int) -> list[dict[str, float]]:
    """Return the parts of the wait for an answer (seconds), for each round."""
    module = rs.Module("echo", requires=[rawio])

    @module.rule(when=rawio.input.changed, writes=rawio.output)
    async def answer(ctx: rs.RuleContext) -> None:
        ctx[rawio.output] = "That is a good question. I will think about it."

    del answer
    found: list[dict[str, float]] = []
    settings = {"voiceio": {"model": model, "voice": "piper", "source": "", "captions": 0, "filler_after": 0}}
    asked = spoken("Could you help me with this problem?")
    for number in range(rounds + 1):
        line = LiveLine(track([(0.6, asked)], 6.0))

        async def serve(_: Any) -> None: ...

        platform = rs.Module("live", requires=[rawio], serve=serve)
        async with rs.Context(module, platform, voiceio, settings=settings) as context:
            context.put(rawio.sound, line)
            talk = await context.next(voiceio.conversation.changed, timeout=60)
            times: dict[str, list[tuple[float, float]]] = {}
            _time(talk.recogniser, "recognise", times)
            _time(talk.melody, "complete", times)
            _time(talk.mouth.voice, "speak", times)
            await context.next(rawio.heard.changed, timeout=60)
            assert line.first is not None
            end = line.begun + 0.6 + sound.seconds(asked, rawio.IN_RATE)
            (heard, understood), (_, judged) = times["recognise"][-1], times["complete"][-1]
            asked_voice, sounded = times["speak"][0]  # the first sentence
            thinking = max(understood, judged) - heard
            own = (line.first - heard) - thinking - (sounded - asked_voice)
            if number:  # the first round loads everything
                found.append(
                    {
                        "recogniser": understood - heard,
                        "melody": judged - times["complete"][-1][0],
                        "voice": sounded - asked_voice,
                        "own": own,
                        "whole": line.first - end,
                    }
                )
    return found


def _time(thing: Any, name: str, times: dict[str, list[tuple[float, float]]]) -> None:
    """Note the beginnings and ends of the calls of a method."""
    call = getattr(thing, name)

    def timed(*args: Any, **named: Any) -> Any:
        begin = time.monotonic()
        try:
            return call(*args, **named)
        finally:
            times.setdefault(name, []).append((begin, time.monotonic()))

    setattr(thing, name, timed)


# ---------------------------------------------------------------------------------------- turns


PAUSE, APART = 1.0, 2.5
"""The seconds of a pause within a sentence, and of the silence after a sentence."""


def ends_of_turns(model: str, many: int, open_: Any = OPEN, complete: Any = COMPLETE) -> tuple[float, float, int]:
    """Return the shares of false cuts and of missed ends, and the number of sentences of each kind.

    A false cut is a turn that ends in the pause of a sentence. A missed end is a turn that ends only after the longest
    pause, which ends any turn.
    """
    broken = [(spoken(begin), spoken(rest)) for begin, rest in open_[:many]]
    whole = [spoken(text) for text in complete[:many]]
    parts: list[tuple[float, bytes]] = []
    pauses: list[tuple[float, float]] = []
    ends: list[float] = []
    now = 0.5
    for begin, rest in broken:
        pause = now + sound.seconds(begin, rawio.IN_RATE)
        pauses.append((pause, pause + PAUSE))
        parts += [(now, begin), (pause + PAUSE, rest)]
        now = pause + PAUSE + sound.seconds(rest, rawio.IN_RATE) + APART
    for one in whole:
        parts.append((now, one))
        ends.append(now + sound.seconds(one, rawio.IN_RATE))
        now = ends[-1] + APART
    found = speech.decisions(track(parts, now), model=model)
    slow = voiceio.Settings().longest_pause - 0.1
    cuts = [any(begin < one.time < end + 0.2 for one in found) for begin, end in pauses]
    missed = [not any(end - 0.3 < one.time < end + slow for one in found) for end in ends]
    return statistics.fmean(cuts), statistics.fmean(missed), len(broken)


# ------------------------------------------------------------------------------- interruptions


def interruptions(many: int) -> tuple[list[float], float, float]:
    """Return the seconds from each onset to silence, and the shares of heard texts that are exact, or right within a word."""
    delays: list[float] = []
    off: list[int] = []
    for first in range(0, many, len(INTERRUPTIONS)):
        texts = INTERRUPTIONS[: many - first]
        name = "piper" if first % 20 == 0 else "espeak:en-us"
        onsets = [3.5 + 9.0 * number + 0.37 * (number % 3) for number in range(1, len(texts) + 1)]
        parts = [(0.5, spoken("Please tell me a story."))]
        parts += [(at, spoken(text, name)) for at, text in zip(onsets, texts, strict=True)]
        with tempfile.TemporaryDirectory() as folder, noted() as sentences:
            out = Path(folder) / "out.wav"
            said = speech.conversation(track(parts, onsets[-1] + 6.0), out)
            played = sound.decode(out, rawio.OUT_RATE)
        stories = [one for one in said if one.speaker == "agent"]
        for onset in onsets:
            under_way = [one for one in stories if one.start < onset < one.end]
            delays += [min(one.end - onset, 2.0) for one in under_way]  # else there was nothing to interrupt
            for one in under_way:
                begin, end = (2 * round(time * rawio.OUT_RATE) for time in (one.start - 0.05, one.end + 0.1))
                story = next(text for text in STORIES if text.startswith(one.text[:20]))
                true = heard_words(story, sentences, played[begin:end])
                off.append(abs(len(true.split()) - len(one.text.split())))
    return delays, statistics.fmean(x == 0 for x in off), statistics.fmean(x <= 1 for x in off)


def back_channels(rounds: int) -> tuple[float, int]:
    """Return the share of back-channels, laughs and coughs that stopped the agent, and their number."""
    stopped = count = 0
    for number, name in enumerate(("piper", "espeak:en-us", "espeak:en+f3")[:rounds]):
        sounds = [spoken(text, name) for text in BACK_CHANNELS] + [speech.cough(number), speech.cough(number + 10)]
        for begin in range(0, len(sounds), 4):
            some = sounds[begin : begin + 4]
            parts = [(0.5, spoken("Please tell me a story.")), *((5.0 + 3.2 * at, one) for at, one in enumerate(some))]
            said = speech.conversation(track(parts, 18.5))
            count += len(some)
            stopped += sum(one.speaker == "user" for one in said[1:])
    return stopped / count, count


def echoes(rounds: int) -> int:
    """Return the number of utterances and cuts that the agent's own voice caused, with an echo at -10 dB."""
    faults = 0
    with speech.echoing():
        for number in range(rounds):
            said = speech.conversation(track([(0.5 + number / 10, spoken("Please tell me a story."))], 3.0))
            faults += sum(one.speaker == "user" for one in said[1:]) + sum(one.cut for one in said)
    return faults
