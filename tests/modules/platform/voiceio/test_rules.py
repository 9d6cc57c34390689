"""An agent holds spoken conversations with a recorded user, in virtual time."""

from __future__ import annotations

import hashlib
import re
import wave
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import ravestate as rs
from modules.platform.voiceio.speech import (
    FAST,
    STORY,
    Scripted,
    noise,
    spoken,
    storyteller,
    track,
    wav,
)
from ravestate.errors import PlatformError
from ravestate.modules import idle, rawio, voiceio
from ravestate.modules.platform.voiceio import Settings, opening
from ravestate.modules.platform.voiceio.synthesiser import Synthesiser
from ravestate.testing import Said, talk

WHOLE = "".join(STORY)
TELL = (0.5, "Please tell me a story.")


def script(monkeypatch: pytest.MonkeyPatch, *texts: str | Exception, confidence: float = 0.9) -> Scripted:
    """Replace the recogniser with a stand-in that returns these texts, whatever the sound."""
    one = Scripted(*texts, confidence=confidence)
    monkeypatch.setattr(opening, "Recogniser", one)
    return one


def sides(said: list[Said], speaker: str) -> list[str]:
    return [one.text for one in said if one.speaker == speaker]


def settings(**changed: Any) -> dict[str, dict[str, Any]]:
    return {"voiceio": {**FAST["voiceio"], **changed}}


def loud(file: Path, begin: float, end: float) -> bool:
    """Return whether the output file has sound between two times (seconds)."""
    with wave.open(str(file)) as out:
        sound = np.frombuffer(out.readframes(out.getnframes()), "<i2").astype(int)
    part = sound[round(begin * 24000) : round(end * 24000)]
    return bool(len(part)) and int(np.abs(part).max()) > 300


def test_the_agent_hears_a_request_and_its_answer_can_be_heard(tmp_path: Path) -> None:
    """The real recogniser transcribes the user's recording, and then the agent's speech in the output file."""
    heard: list[voiceio.Utterance] = []
    module = rs.Module("listener", requires=[voiceio])

    @module.rule(when=voiceio.utterance.max_age(None).detached(), reads=rawio.input, background=True)
    async def note(ctx: rs.RuleContext) -> None:
        heard.append(ctx.payload(voiceio.utterance))

    del note
    file = wav(tmp_path / "in.wav", track(TELL, length=2.5))
    said = talk(file, tmp_path / "out.wav", storyteller(), module, settings=settings(voice="piper"))
    assert [one.speaker for one in said] == ["user", "agent"]
    assert "story" in said[0].text.lower() and said[1].text == WHOLE and not said[1].cut
    assert heard[0].confidence > 0.45
    assert (heard[0].start, heard[0].end) == pytest.approx((0.5, 1.8), abs=0.25)
    assert said[1].start - said[0].end < 1.0
    assert not loud(tmp_path / "out.wav", 0.0, said[1].start) and loud(tmp_path / "out.wav", said[1].start, said[1].end)
    back = voiceio.transcribe(tmp_path / "out.wav", voiceio.Settings(model="tiny.en")).text.lower()
    assert "museum" in back and "cat" in back


def test_the_same_recording_gives_the_same_conversation(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Earlier sentences change the sound of the voice. Speech from another synthesiser must not change it."""
    file = wav(tmp_path / "in.wav", track(TELL, (5.0, "No, stop."), length=8.0))
    other = Synthesiser(Settings(voice=FAST["voiceio"]["voice"]))
    runs: list[tuple[list[Said], str]] = []
    for number in range(2):
        other.speak("Somebody else.")
        script(monkeypatch, "Tell me a story.", "No, stop.")
        said = talk(file, tmp_path / f"{number}.wav", storyteller(), settings=FAST)
        runs.append((said, hashlib.sha256((tmp_path / f"{number}.wav").read_bytes()).hexdigest()))
    other.close()
    assert runs[0] == runs[1]


@pytest.mark.parametrize("name", ["piper", "espeak:en-us"])
def test_a_user_who_still_speaks_when_the_agent_begins_interrupts_the_agent(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, name: str
) -> None:
    heard = script(monkeypatch, "Tell me a story.", "About the sea, and my grandmother.")
    begin = spoken("Please tell me a story.")
    rest = 0.5 + len(begin) / 32000 + 0.35  # at this time, the agent begins to speak
    parts = (0.5, begin), (rest, "About the sea, the mountains, and my grandmother.")
    said = talk(
        wav(tmp_path / "in.wav", track(*parts, length=8.0)),
        tmp_path / "out.wav",
        storyteller(),
        settings=settings(voice=name),
    )
    assert sides(said, "user") == ["Tell me a story.", "About the sea, and my grandmother."]
    story = next(one for one in said if one.speaker == "agent")
    assert story.cut and story.end < rest + 0.7
    assert [one.start for one in said] == sorted(one.start for one in said)
    assert heard.heard[-1] > 2.2  # the recogniser got the whole rest of the sentence


def test_the_user_interrupts_and_the_agent_stops_immediately(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    script(monkeypatch, "Tell me a story.", "Stop, that is enough.")
    file = wav(tmp_path / "in.wav", track(TELL, (5.0, "Stop, that is enough."), length=8.0))
    said = talk(file, tmp_path / "out.wav", storyteller(), settings=FAST)
    story, *_, end = [one for one in said if one.speaker == "agent"]
    assert story.cut and WHOLE.startswith(story.text) and 8 < len(story.text.split()) < 25
    assert story.end <= 5.3 and not loud(tmp_path / "out.wav", 5.3, 5.5)
    assert [one.speaker for one in said] == ["user", "agent", "user", "agent"]
    assert end.text == "Good night."


@pytest.mark.parametrize("sound", ["Yes.", "Yeah, okay.", "cough"])
def test_a_back_channel_or_a_cough_does_not_stop_the_agent(
    sound: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    script(monkeypatch, "Tell me a story.", "" if sound == "cough" else sound)
    fade = np.exp(-np.arange(5600) / 1600)
    cough = (np.frombuffer(noise(0.35, 9000), "<i2") * fade).astype("<i2").tobytes()
    pcm = track(TELL, (5.0, cough if sound == "cough" else sound), length=8.0)
    said = talk(wav(tmp_path / "in.wav", pcm), tmp_path / "out.wav", storyteller(), settings=FAST)
    assert sides(said, "agent") == [WHOLE]
    assert sides(said, "user") == ["Tell me a story."]


def test_after_a_false_alarm_the_agent_resumes_where_it_stopped(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    script(monkeypatch, "Tell me a story.", "")
    file = wav(tmp_path / "in.wav", track(TELL, (5.0, "Some words that nobody understands"), length=8.0))
    flags: list[tuple[float, bool]] = []

    def record(one: Any) -> None:
        if type(one).__name__ == "SlotWritten" and one.slot == "voiceio:held":
            flags.append((one.at, one.value))

    said = talk(file, tmp_path / "out.wav", storyteller(), settings=settings(back_channel=5.0), record=record)
    (story,) = [one for one in said if one.speaker == "agent"]
    assert story.text == WHOLE and not story.cut
    assert not loud(tmp_path / "out.wav", 5.4, 6.2) and loud(tmp_path / "out.wav", 7.2, 9.0)


def test_a_long_interruption_stops_the_agent_before_the_user_has_finished(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    script(monkeypatch, "Tell me a story.", "no")
    file = wav(
        tmp_path / "in.wav",
        track(TELL, (5.0, "I do not want to hear any more of this story because I know it already."), length=10.0),
    )
    stopped: list[float] = []
    module = rs.Module("listener", requires=[voiceio])

    @module.rule(when=voiceio.barge_in.max_age(None).detached(), background=True)
    async def note(ctx: rs.RuleContext) -> None:
        stopped.append(ctx.now)

    del note
    talk(file, None, storyteller(), module, settings=FAST)
    assert len(stopped) == 1 and 6.0 < stopped[0] < 6.5


def test_rawio_heard_holds_the_words_that_the_user_heard_of_each_output(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    script(monkeypatch, "Tell me a story.", "Stop.")
    heard: list[str] = []
    module = rs.Module("listener", requires=[rawio])

    @module.rule(when=rawio.heard.changed.max_age(None).detached(), background=True)
    async def note(ctx: rs.RuleContext) -> None:
        heard.append(ctx.payload(rawio.heard.changed))

    del note
    file = wav(tmp_path / "in.wav", track(TELL, (5.0, "Stop."), length=8.0))
    talk(file, None, storyteller(), module, settings=FAST)
    assert len(heard) == 2
    assert WHOLE.startswith(heard[0]) and heard[0] != WHOLE and heard[1] == "Good night."
    assert voiceio.heard is rawio.heard


def test_the_agent_asks_back_after_an_utterance_with_low_confidence(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    script(monkeypatch, "Tell my a storage", confidence=0.2)
    said = talk(wav(tmp_path / "in.wav", track(TELL, length=3.0)), None, storyteller(), settings=FAST)
    (answer,) = sides(said, "agent")
    assert any(word in answer for word in ("catch", "again", "repeat"))


def test_a_text_that_the_voice_cannot_speak_has_the_time_at_which_the_voice_failed(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    script(monkeypatch, "Tell me a story.")

    def fail(*_: object) -> None:
        raise PlatformError("the voice is broken")

    file = wav(tmp_path / "in.wav", track(TELL, length=3.0))
    monkeypatch.setattr(Synthesiser, "speak", fail)
    user, agent = talk(file, None, storyteller(), settings=settings(filler_after=0.0))
    assert user.end < agent.start == agent.end and WHOLE.startswith(agent.text)


def test_a_growing_utterance_counts_as_read_to_its_end_if_the_voice_fails(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The voice fails at the third sentence. The sound of the first two sentences is played to its end."""
    script(monkeypatch, "Tell me a story.")
    speak = Synthesiser.speak

    def fail(self: Synthesiser, text: str, *others: Any) -> Any:
        if "noise" in text:
            raise PlatformError("the voice is broken")
        return speak(self, text, *others)

    monkeypatch.setattr(Synthesiser, "speak", fail)
    file, out = wav(tmp_path / "in.wav", track(TELL, length=3.0)), tmp_path / "out.wav"
    _, agent = talk(file, out, storyteller(), settings=settings(filler_after=0.0))
    assert agent.text == WHOLE and not agent.cut
    assert 3.0 < agent.end - agent.start < 6.0 and loud(out, agent.end - 0.6, agent.end)


def test_speech_that_the_end_of_the_agent_cuts_off_is_in_the_transcript(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    script(monkeypatch, "Tell me a story.")
    tired = rs.Module("tired", requires=[voiceio])

    @tired.rule(when=voiceio.agent_speaking.true.min_age(2.0), background=True)
    async def go(ctx: rs.RuleContext) -> None:
        ctx.stop()

    del go
    file = wav(tmp_path / "in.wav", track(TELL, length=3.0))
    user, agent = talk(file, None, storyteller(), tired, settings=FAST)
    assert user.text == "Tell me a story." and agent.cut and agent.text and WHOLE.startswith(agent.text)


def teller(pieces: tuple[str, ...], *outputs: str) -> rs.Module:
    """Return a module that emits pieces without the flag ``rawio.speaking``, and then writes the outputs."""
    module = rs.Module("teller", requires=[rawio])

    @module.rule(when=rawio.input.changed, writes=rawio.output, emits=rawio.piece)
    async def tell(ctx: rs.RuleContext) -> None:
        for piece in pieces:
            await ctx.sleep(0.1)
            ctx.emit(rawio.piece, piece)
        for text in outputs:
            ctx[rawio.output] = text

    del tell
    return module


@pytest.mark.parametrize(
    ("pieces", "outputs", "spoken"),
    [
        (("Once there ", "was a robot. "), ("Once there was a robot.",), ["Once there was a robot."]),
        (("Once there ", "was"), ("Once there was a robot.",), ["Once there was a robot."]),
        (("It was a ",), ("Sorry, I forgot it.",), ["It was a", "Sorry, I forgot it."]),
    ],
)
def test_pieces_are_spoken_once_and_a_different_output_is_spoken_after_them(
    pieces: tuple[str, ...],
    outputs: tuple[str, ...],
    spoken: list[str],
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """The pieces can end with a space that the output lacks. The rule does not set ``rawio.speaking``."""
    script(monkeypatch, "Tell me a story.")
    file = wav(tmp_path / "in.wav", track(TELL, length=3.0))
    said = talk(file, None, teller(pieces, *outputs), settings=settings(filler_after=0))
    assert sides(said, "agent") == spoken


def test_a_filler_is_spoken_if_the_answer_takes_long(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    script(monkeypatch, "Think about it, please.")
    file = wav(tmp_path / "in.wav", track((0.5, "Think about it, please."), length=3.0))
    said = talk(file, None, storyteller(slow=3.0), settings=FAST)
    filler, answer = [one for one in said if one.speaker == "agent"]
    assert filler.filler and filler.text in voiceio.Settings().fillers and not answer.filler
    script(monkeypatch, "Think about it, please.")
    assert sides(talk(file, None, storyteller(slow=0.5), settings=FAST), "agent") == ["Good night."]


def test_a_pause_within_a_sentence_does_not_end_the_turn(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    scripted = script(monkeypatch, "I would like to hear a", "I would like to hear a good story.")
    file = wav(tmp_path / "in.wav", track((0.5, "I would like to hear a"), (2.4, "good story."), length=4.0))
    said = talk(file, None, storyteller(), settings=FAST)
    assert sides(said, "user") == ["I would like to hear a good story."]
    assert scripted.heard[1] > scripted.heard[0] + 1.0  # at its second call, the recogniser got the whole turn


def test_the_words_of_two_people_are_two_utterances(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    script(monkeypatch, "I would like to go to the", "I would like to go to the", "No, that is much too far.")
    first, second = (
        spoken("I would like to go to the", "espeak:en-us"),
        spoken("No, that is much too far.", "espeak:en+f3"),
    )
    file = wav(tmp_path / "in.wav", track((0.5, first), (0.5 + len(first) / 32000 + 0.5, second), length=5.0))
    said = [one for one in talk(file, None, storyteller(), settings=FAST) if one.speaker == "user"]
    assert len(said) == 2 and said[0].end < said[1].start


def test_the_signal_rawio_hearing_carries_the_words_recognised_so_far(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    script(monkeypatch, "I", "I would", "I would like a story.")
    seen: list[str] = []
    module = rs.Module("listener", requires=[rawio])

    @module.rule(when=rawio.hearing.max_age(None).detached(), background=True)
    async def note(ctx: rs.RuleContext) -> None:
        seen.append(ctx.payload(rawio.hearing))

    del note
    file = wav(tmp_path / "in.wav", track((0.5, "I would like to hear one of your very long stories."), length=5.0))
    talk(file, None, storyteller(), module, settings=settings(captions=0.8))
    assert seen[:2] == ["I", "I would"] and seen[-1] == "I would like a story."


def test_in_half_duplex_the_agent_hears_nothing_while_it_speaks(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    scripted = script(monkeypatch, "Tell me a story.", "Stop.")
    file = wav(tmp_path / "in.wav", track(TELL, (5.0, "Stop, that is enough."), length=8.0))
    said = talk(file, None, storyteller(), settings=settings(half_duplex=True))
    assert sides(said, "agent") == [WHOLE] and len(scripted.heard) == 1


@pytest.mark.parametrize("ask_back_below", [0.38, 0.0])
def test_the_agent_asks_back_after_a_failure_of_the_recogniser(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, ask_back_below: float
) -> None:
    script(monkeypatch, PlatformError("whisper did not answer"), "Tell me a story.")
    file = wav(tmp_path / "in.wav", track(TELL, (5.0, TELL[1]), length=8.0))
    said = talk(file, None, storyteller(), settings=settings(ask_back_below=ask_back_below))
    ask, story = sides(said, "agent")
    assert any(word in ask for word in ("catch", "again", "repeat")) and story == WHOLE


def test_noise_is_not_recognised_as_a_turn(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    scripted = script(monkeypatch, "Hello?")
    assert talk(wav(tmp_path / "in.wav", noise(5.0, 2000)), None, storyteller(), settings=FAST) == []
    assert scripted.heard == []


def test_the_agent_is_not_bored_while_it_speaks(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    script(monkeypatch, "Tell me a story.")
    bored: list[float] = []
    module = rs.Module("watcher", requires=[idle])

    @module.rule(when=idle.bored.max_age(None).detached(), background=True)
    async def note(ctx: rs.RuleContext) -> None:
        bored.append(ctx.now)

    del note
    file = wav(tmp_path / "in.wav", track(TELL, length=20.0))
    said = talk(file, None, storyteller(), module, settings={**FAST, "idle": {"bored_after": 3.0}})
    story = said[-1]
    assert bored and not any(story.start < time < story.end + 2.9 for time in bored)


def test_voiceio_uses_the_line_of_a_platform_that_serves_users_and_opens_no_device(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    """The web page, for example, provides a line (a microphone and a loudspeaker) for each of its users."""
    from ravestate.modules.platform.voiceio.wav_line import WavLine
    from ravestate.testing import simulate

    script(monkeypatch, "Tell me a story.")

    async def serve(_: Any) -> None: ...

    platform = rs.Module("page", requires=[rawio], serve=serve)
    with simulate(storyteller(), platform, voiceio, settings=FAST) as sim:
        sim.advance(3.0)
        assert sim.read(voiceio.conversation) is None and not sim.failures
        line = WavLine(wav(tmp_path / "in.wav", track(TELL, length=2.0)))
        sim.put(rawio.sound, line)
        sim.advance(20.0)
        assert sim.said == [WHOLE] and sim.read(rawio.heard) == WHOLE
        sim.put(rawio.sound, None)
        assert sim.read(voiceio.conversation) is None


def test_a_growing_utterance_ends_with_its_line(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    from ravestate.modules.platform.voiceio.wav_line import WavLine
    from ravestate.testing import simulate

    script(monkeypatch, "Tell me a story.")

    async def serve(_: Any) -> None: ...

    teller = rs.Module("teller", requires=[rawio])

    @teller.rule(when=rawio.input.changed, writes=rawio.output, emits=rawio.piece)
    async def tell(ctx: rs.RuleContext) -> None:
        for piece in STORY:
            await ctx.sleep(1.0)
            ctx.emit(rawio.piece, piece)
        ctx[rawio.output] = WHOLE

    del tell
    platform = rs.Module("page", requires=[rawio], serve=serve)
    with simulate(teller, platform, voiceio, settings=FAST) as sim:
        sim.put(rawio.sound, WavLine(wav(tmp_path / "in.wav", track(TELL, length=2.0))))
        sim.advance(4.5)
        assert sim.read(voiceio.agent_speaking)
        sim.put(rawio.sound, None)
        assert not sim.read(voiceio.agent_speaking)
        heard = sim.read(rawio.heard)
        assert heard and WHOLE.startswith(heard) and heard != WHOLE
        sim.advance(10.0)
        assert sim.said == [WHOLE] and sim.read(rawio.heard) == heard and not sim.read(rs.activity)


def test_speech_that_begins_and_is_held_at_the_time_zero_has_these_times(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    """The clock of a context may start at zero."""
    from ravestate.modules.platform.voiceio.wav_line import WavLine
    from ravestate.testing import simulate

    script(monkeypatch, "Tell me a story.")
    spoken: list[Any] = []

    async def serve(_: Any) -> None: ...

    platform = rs.Module("page", requires=[rawio], serve=serve)
    listener = rs.Module("listener", requires=[voiceio])

    @listener.rule(when=voiceio.speech.max_age(None).detached(), background=True)
    async def note(ctx: rs.RuleContext) -> None:
        spoken.append(ctx.payload(voiceio.speech))

    del note
    with simulate(listener, platform, voiceio, settings=FAST) as sim:
        sim.put(rawio.sound, WavLine(wav(tmp_path / "in.wav", track(length=20.0))))
        sim.put(rawio.output, WHOLE)
        assert sim.read(voiceio.agent_speaking)
        sim.emit(voiceio.spoke_up)
        assert sim.read(voiceio.held) and sim.now == 0.0
        sim.advance(3.0)  # meanwhile, the agent gives way
    assert [(one.start, one.end, one.over) for one in spoken] == [(0.0, 0.0, True)]


def test_a_line_that_a_platform_provides_at_the_start_is_opened_only_once(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    """A page can provide the line of its user as soon as the context starts."""

    from modules.platform.voiceio.test_wav_line import run
    from ravestate.modules.platform.voiceio.wav_line import WavLine

    script(monkeypatch, "Good evening.")
    file = wav(tmp_path / "in.wav", track((0.5, "Good evening."), length=2.0))
    opened: list[object] = []

    async def serve(_: Any) -> None: ...

    platform = rs.Module("page", requires=[rawio], serve=serve)

    async def follow() -> None:
        async with rs.Context(storyteller(), platform, voiceio, settings=FAST) as context:
            context.put(rawio.sound, WavLine(file))
            opened.append(await context.next(voiceio.conversation.changed, timeout=5))
            said = await context.next(rawio.output.changed, timeout=5)
            opened.append(context.read(voiceio.conversation))
            assert said == "Good night."

    run(follow)
    assert opened[0] is opened[1]


def test_an_output_file_that_cannot_be_written_ends_the_agent_with_an_error(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A path without .wav fails at the start. A file that becomes unwritable fails when the conversation is over."""
    script(monkeypatch, "Hello.")
    file, out = wav(tmp_path / "in.wav", track(TELL, length=2.0)), tmp_path / "out.wav"
    with pytest.raises(PlatformError, match=r"ends in \.wav"):
        talk(file, tmp_path / "out", storyteller(), settings=FAST)

    def lose(_: Said) -> None:
        if out.is_file():
            out.unlink()
            out.mkdir()

    with pytest.raises(PlatformError, match="cannot write"):
        talk(file, out, storyteller(), settings=FAST, show=lose)


def test_the_module_exports_the_names_in_its_readme() -> None:
    readme = (Path(voiceio.__file__).parent / "README.md").read_text(encoding="utf-8")
    names = re.findall(r"^\| `voiceio\.(\w+)", readme, re.MULTILINE)
    assert len(names) > 10 and set(names) <= set(voiceio.__all__)


def test_a_missing_model_ends_the_agent_with_advice(tmp_path: Path) -> None:
    file = wav(tmp_path / "in.wav", spoken("Hello."))
    with pytest.raises(PlatformError, match="ravestate voice get huge"):
        talk(file, None, storyteller(), settings=settings(model="huge"))
