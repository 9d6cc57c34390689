"""Recognition of speech with real models, and what the recogniser does with other sounds and failures."""

import runpy
import threading
from pathlib import Path
from typing import Any

import pytest

from modules.platform.voiceio.speech import PEOPLE, plain, spoken, word_errors
from ravestate.errors import PlatformError
from ravestate.modules.platform.voiceio import Settings, recogniser, sound
from ravestate.modules.platform.voiceio.model_process import CHILDREN
from ravestate.modules.platform.voiceio.recogniser import Recogniser

LIBRIVOX = PEOPLE / "librivox"


def transcriptions(file: Path) -> dict[str, str]:
    found: dict[str, str] = {}
    for line in file.read_text(encoding="utf-8").splitlines():
        if "(" in line:
            words, _, name = line.rpartition("(")
            found[name.rstrip(")").strip()] = words.replace("<s>", "").replace("</s>", "").strip()
    return found


def test_recordings_of_people_are_recognised_with_few_errors() -> None:
    small = Recogniser(Settings(model="tiny.en"))
    wrong = total = 0
    for name, wanted in list(transcriptions(LIBRIVOX / "transcription").items())[:3]:
        found = small.recognise(sound.decode(LIBRIVOX / f"{name}.wav", 16000))
        wrong += word_errors(wanted.replace("mister", "mr"), found.text)
        total += len(plain(wanted))
        assert found.confidence > 0.5
    assert wrong / total < 0.15
    small.close()


def test_the_words_of_a_short_sound_are_not_repeated() -> None:
    """In a short sound, the model sometimes misses the end of the speech, and begins again."""
    small = Recogniser(Settings(model="tiny.en"))
    for text in ("Dinner is ready.", "I have never been so happy.", "Can we start again?"):
        found = small.recognise(bytes(9600) + spoken(text) + bytes(6400))
        assert plain(found.text) == plain(text) and found.confidence > 0.5
        assert found.last[plain(text)[-1]] > 0.5
    small.close()


def test_the_last_word_is_a_candidate_even_if_it_cannot_end_a_sentence() -> None:
    small = Recogniser(Settings(model="tiny.en"))
    found = small.recognise(bytes(9600) + spoken("It is a photograph of my") + bytes(6400))
    assert found.last.get("my", 0.0) > 0.05
    small.close()


@pytest.mark.parametrize(
    ("words", "at_limit", "kept"),
    [
        ("dinner is ready dinner is ready dinner", True, 3),
        ("dinner is ready dinner is ready", False, 3),
        ("no no no", False, 3),
        ("no no no no no no", True, 1),
        ("tell me what you tell me", False, 6),
        ("one two three", True, 3),
        ("", True, 0),
    ],
)
def test_repetitions_are_cut_off(words: str, at_limit: bool, kept: int) -> None:
    count = runpy.run_path(str(CHILDREN / "whisper.py"))["without_repetition"]
    assert count(words.split(), at_limit=at_limit) == kept


def test_a_grammar_recognises_its_commands_and_no_other_words() -> None:
    commands = Recogniser(Settings(recogniser="grammar", model=str(PEOPLE / "goforward.gram")))
    forward = commands.recognise(sound.resample((PEOPLE / "goforward.raw").read_bytes(), 16000, 16000))
    assert forward.text == "go forward ten meters" and forward.confidence > 0.8
    other = commands.recognise(sound.decode(PEOPLE / "cards" / "005.wav", 16000))
    assert not other.text or other.confidence < 0.2
    commands.close()


def test_the_error_names_a_missing_grammar(tmp_path: Path) -> None:
    with pytest.raises(PlatformError, match=r"there is no file 'none\.gram'"):
        Recogniser(Settings(recogniser="grammar", model="none.gram"))


def test_a_grammar_with_a_fault_is_refused(tmp_path: Path) -> None:
    (tmp_path / "bad.gram").write_text("#JSGF V1.0; grammar bad; public <x> = xyzzyq;")
    broken = Recogniser(Settings(recogniser="grammar", model=str(tmp_path / "bad.gram")))
    with pytest.raises(PlatformError, match="cannot load grammar"):
        broken.load()
    broken.close()


def test_the_error_about_a_missing_model_says_what_to_do() -> None:
    with pytest.raises(PlatformError, match=r"no model 'huge'; there are: .*ravestate voice get huge"):
        Recogniser(Settings(model="huge"))


@pytest.mark.parametrize(
    ("text", "confidence", "no_speech", "kept"),
    [
        ("Hello there.", 0.9, 0.0, "Hello there."),
        ("[Music] Hello", 0.9, 0.0, "Hello"),
        ("(coughs)", 0.9, 0.1, ""),
        ("♪ ♪", 0.9, 0.1, ""),
        ("Thank you.", 0.9, 0.7, ""),
        ("Thank you.", 0.9, 0.1, "Thank you."),
        ("you", 0.3, 0.2, ""),
        ("something unclear", 0.4, 0.8, ""),
        (" . ", 0.9, 0.0, ""),
    ],
)
def test_notes_about_sounds_and_unlikely_words_are_removed_from_the_text(
    text: str, confidence: float, no_speech: float, kept: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    one = Recogniser(Settings(model="tiny.en"))
    answer = {"text": text, "confidence": confidence, "no_speech": no_speech}
    monkeypatch.setattr(one.process, "request", lambda *_, **__: (answer, b""))
    assert one.recognise(b"").text == kept
    one.close()


@pytest.mark.parametrize("language", ["en-US", "EN"])
def test_a_language_may_have_a_region_and_capitals(language: str) -> None:
    """Whisper refuses both."""
    one, other = (Recogniser(Settings(model="tiny.en", language=code)) for code in (language, "en"))
    assert one.process is other.process
    one.close()
    other.close()


@pytest.mark.parametrize(
    ("model", "language", "reason"),
    [("tiny.en", "de-AT", "knows only English, not the language 'de'"), ("base", "xx", "'xx' is not a valid language")],
)
def test_a_language_that_the_model_does_not_know_is_refused_before_the_conversation(
    model: str, language: str, reason: str
) -> None:
    one = Recogniser(Settings(model=model, language=language))
    with pytest.raises(PlatformError, match=rf"{reason}.*\. Set voiceio\.language, or take another model"):
        one.load()
    one.close()


def test_after_a_crash_the_recogniser_tries_once_more(monkeypatch: pytest.MonkeyPatch) -> None:
    one = Recogniser(Settings(model="tiny.en"))
    attempts: list[bool] = []

    def request(*_: object, **__: object) -> tuple[dict[str, object], bytes]:
        attempts.append(True)
        if len(attempts) == 1:
            raise PlatformError("the process ended")
        return {"text": "Hello.", "confidence": 0.9, "no_speech": 0.0}, b""

    monkeypatch.setattr(one.process, "request", request)
    assert one.recognise(b"").text == "Hello." and len(attempts) == 2
    attempts.clear()
    with pytest.raises(PlatformError):
        one.recognise(b"", partial=True)
    one.close()


def test_a_long_recording_is_recognised_in_pieces(monkeypatch: pytest.MonkeyPatch) -> None:
    """The time limit applies to each piece, so a recording can have any length."""
    small = Recogniser(Settings(model="tiny.en"))
    texts = list(transcriptions(LIBRIVOX / "transcription").items())[:5]
    texts += texts[:1]
    pcm = b"".join(sound.decode(LIBRIVOX / f"{name}.wav", 16000) for name, _ in texts)
    assert len(pcm) / 32000 > recogniser.LONGEST
    asked: list[float] = []
    request = small.process.request

    def note(header: Any, data: bytes, **options: Any) -> Any:
        asked.append(len(data) / 32000)
        return request(header, data, **options)

    monkeypatch.setattr(small.process, "request", note)
    found = small.recognise(pcm)
    wanted = " ".join(text.replace("mister", "mr") for _, text in texts)
    assert word_errors(wanted, found.text) / len(plain(wanted)) < 0.2
    assert found.confidence > 0.5 and max(asked) <= recogniser.LONGEST and sum(asked) == pytest.approx(len(pcm) / 32000)
    small.close()


def test_a_turn_of_maximum_length_fits_into_the_input_of_the_model() -> None:
    small = Recogniser(Settings(model="tiny.en"))
    pcm = bytes(16000) + spoken("Dinner is ready.")
    found = small.recognise(pcm.ljust(round(32000 * recogniser.LONGEST), b"\0"))
    assert plain(found.text) == ["dinner", "is", "ready"]
    small.close()


def test_recognition_stops_as_soon_as_its_result_is_unwanted(monkeypatch: pytest.MonkeyPatch) -> None:
    """The recogniser then skips the remaining pieces and the second attempt."""
    one, unwanted, asked = Recogniser(Settings(model="tiny.en")), threading.Event(), list[bytes]()

    def request(_: object, data: bytes, **options: Any) -> Any:
        if options["unwanted"].is_set():
            raise PlatformError("dropped")
        asked.append(data)
        unwanted.set()
        return {"text": "Hello.", "confidence": 0.9, "no_speech": 0.0}, b""

    monkeypatch.setattr(one.process, "request", request)
    with pytest.raises(PlatformError, match="dropped"):
        one.recognise(bytes(32000 * 90), unwanted=unwanted)
    assert len(asked) == 1
    one.close()
