"""The ear reports onsets, articulate speech and pauses in speech, and nothing in noise."""

from collections.abc import Iterator

import numpy as np
import pytest

from modules.platform.voiceio.speech import noise, spoken, track
from ravestate.modules.platform.voiceio import ear as ears
from ravestate.modules.platform.voiceio.ear import Ear, is_articulate

BLOCK = 640


def hear(ear: Ear, pcm: bytes, begin: float = 0.0) -> Iterator[tuple[float, str]]:
    """Yield the events of a sound, each with its time (seconds)."""
    for at in range(0, len(pcm), BLOCK):
        now = begin + (at + BLOCK) / 32000
        for event in ear.feed(pcm[at : at + BLOCK], now):
            yield round(now, 2), event


def test_speech_causes_the_events_onset_articulate_and_pause() -> None:
    pcm = track((1.0, "What time is it?"), length=3.0)
    ear = Ear()
    events = list(hear(ear, pcm))
    assert [event for _, event in events] == ["onset", "articulate", "pause"]
    (onset, _), (sure, _), (pause, _) = events
    assert 1.0 < onset < 1.2 and sure < 1.3
    turn = ear.take()
    assert turn is not None and ear.turn is None
    assert turn.start == pytest.approx(1.0, abs=0.12)
    assert pause - turn.end == pytest.approx(0.2, abs=0.05)
    assert len(turn.sound) / 32000 > turn.end - turn.start + 0.3  # the sound has a little silence at both ends


def test_speech_after_a_pause_continues_the_turn() -> None:
    ear = Ear()
    events = list(hear(ear, track((0.5, "I would like a"), (2.0, "cup of coffee."), length=4.0)))
    assert [event for _, event in events if event != "articulate"] == ["onset", "pause", "onset", "pause"]
    turn = ear.take()
    assert turn is not None and turn.start < 0.7 and turn.end > 2.4


def test_a_second_person_who_speaks_directly_after_the_first_gets_a_separate_turn() -> None:
    first = spoken("I would like to go to the station.", "espeak:en-us")
    ear = Ear()
    pcm = track((0.5, first + spoken("No, that is much too far for us.", "espeak:en+f3")), length=5.0)
    events = [event for _, event in hear(ear, pcm)]
    assert events.count("another") == 1 and ear.parted is not None and ear.turn is not None
    assert ear.parted.end == pytest.approx(0.5 + len(first) / 32000, abs=0.3)
    assert ear.parted.end == ear.turn.start < ear.turn.end


def test_a_closed_ear_frees_its_canceller() -> None:
    closed: list[str] = []

    class Canceller:
        def clean(self, near: bytes, far: bytes) -> bytes:
            assert not closed
            return near

        def close(self) -> None:
            closed.append("freed")

    ear = Ear(canceller=Canceller())
    list(hear(ear, bytes(6400)))
    ear.close()
    ear.close()
    assert closed == ["freed"]
    assert list(hear(ear, bytes(6400))) == []


def test_two_turns_do_not_overlap() -> None:
    ear = Ear()
    pcm = track((0.5, "What time is it?"), (3.0, "Thank you."), length=5.0)
    list(hear(ear, pcm[: 2 * 40000]))
    first = ear.take()
    list(hear(ear, pcm[2 * 40000 :], 2.5))
    second = ear.take()
    assert first is not None and second is not None
    assert first.end < 2.0 < 2.9 < second.start


def test_noise_causes_no_events() -> None:
    assert list(hear(Ear(), noise(5.0, 3000))) == []


def test_a_short_hum_is_not_articulate() -> None:
    time = np.arange(6400) / 16000
    hum = sum(np.sin(2 * np.pi * 110 * k * time) / k**2.5 for k in range(1, 8)) * 8000
    assert not is_articulate(hum[:512].astype("<i2"))


def test_a_turn_ends_at_the_maximum_length(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(ears, "LONGEST", 1.0)
    pcm = track((0.0, "This is a very long sentence that goes on and on without any pause at all."))
    ear = Ear()
    events: list[str] = []
    for _, event in hear(ear, pcm):
        events.append(event)
        if event == "pause":
            turn = ear.take()
            assert turn is not None and turn.full and turn.end - turn.start < 1.2
            break
    assert events[-1] == "pause"


def test_clipped_sound_is_noticed() -> None:
    soft, loud = Ear(), Ear()
    pcm = track((0.3, "This sentence is much too loud for the microphone."), length=4.0)
    list(hear(soft, pcm))
    list(hear(loud, np.clip(np.frombuffer(pcm, "<i2").astype(float) * 20, -32768, 32767).astype("<i2").tobytes()))
    assert (soft.clipped, loud.clipped) == (False, True)


def test_blocks_of_any_size_give_the_same_events() -> None:
    pcm = track((0.5, "What time is it?"), length=2.5)

    def events(size: int) -> list[str]:
        ear, found = Ear(), list[str]()
        for at in range(0, len(pcm), size):
            found += ear.feed(pcm[at : at + size], (at + size) / 32000)
        return found

    assert events(640) == events(1000) == events(64000) == ["onset", "articulate", "pause"]
