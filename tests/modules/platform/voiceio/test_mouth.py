"""A `Mouth` speaks a text while the text grows, knows which part the user has heard, and can pause (`hold`)."""

import asyncio

import pytest

from modules.platform.voiceio.test_wav_line import run
from ravestate.modules.platform.voiceio.alignment import by_places
from ravestate.modules.platform.voiceio.mouth import Mouth, Speech
from ravestate.modules.platform.voiceio.playout import SECOND
from ravestate.modules.platform.voiceio.synthesiser import Spoken
from ravestate.modules.platform.voiceio.wav_line import WavLine

TEXT = "one two three four five"


def said(text: str = TEXT, per_word: float = 0.5, level: bytes = b"\0\x10") -> Spoken:
    """Return a spoken text in which each word takes `per_word` seconds."""
    words = text.split()
    length = per_word * len(words)
    places = [(text.index(word), number * per_word) for number, word in enumerate(words)]
    return Spoken(
        text,
        level * round(length * SECOND / 2),
        level * round(length * 16000),
        by_places(text, places, length),
    )


def mouth() -> Mouth:
    return Mouth(WavLine(None), None)  # type: ignore[arg-type]  # these tests need no synthesiser


@pytest.mark.parametrize(
    ("seconds", "heard"),
    [(0.1, ""), (0.2, ""), (0.31, "one"), (1.2, "one two"), (1.4, "one two three"), (2.4, TEXT), (9.0, TEXT)],
)
def test_the_method_heard_returns_the_words_that_have_sounded_so_far(seconds: float, heard: str) -> None:
    async def listen() -> None:
        one = mouth()
        one.begin()
        one.queue(said(), 0)
        await _wait(seconds)
        assert one.heard(TEXT) == heard

    run(listen)


async def _wait(seconds: float) -> None:
    loop = asyncio.get_running_loop()
    done = loop.create_future()
    loop.call_later(seconds, done.set_result, None)
    await done


@pytest.mark.parametrize(("seconds", "heard"), [(0.09, ""), (0.11, "one,"), (1.09, "one,"), (1.11, "one, two.")])
def test_a_word_counts_as_heard_before_the_pause_after_it(seconds: float, heard: str) -> None:
    text, word, pause = "one, two.", b"\0\x10" * round(0.2 * SECOND / 2), bytes(round(0.8 * SECOND))

    async def listen() -> None:
        one = mouth()
        one.begin()
        one.queue(Spoken(text, (word + pause) * 2, b"", by_places(text, [(0, 0.0), (5, 1.0)], 2.0)), 0)
        await _wait(seconds)
        assert one.heard(text) == heard

    run(listen)


def test_the_method_heard_joins_the_sentences_of_an_utterance() -> None:
    async def listen() -> None:
        one = mouth()
        one.begin()
        one.queue(said("one two."), 0)
        one.queue(said(" three four"), 8)
        await _wait(1.4)
        assert one.heard("one two. three four") == "one two. three"
        await one.played_out()
        assert one.heard("one two. three four") == "one two. three four"
        assert asyncio.get_running_loop().time() == pytest.approx(2.0)

    run(listen)


def test_released_speech_continues_with_the_word_that_was_cut() -> None:
    async def listen() -> None:
        one = mouth()
        one.begin()
        one.queue(said(), 0)
        await _wait(1.3)  # in the middle of "three"
        one.hold(1.3)
        await _wait(5.0)
        assert one.position == pytest.approx(1.3)
        assert one.heard(TEXT) == "one two three"
        one.release()
        await one.played_out()
        assert asyncio.get_running_loop().time() == pytest.approx(1.3 + 5.0 + 1.5)  # the mouth says "three" once more
        assert one.heard(TEXT) == TEXT

    run(listen)


def test_a_word_that_was_heard_before_a_hold_still_counts_when_it_is_repeated() -> None:
    async def listen() -> None:
        one = mouth()
        one.begin()
        one.queue(said(), 0)
        await _wait(0.9)
        assert one.heard(TEXT) == "one two"
        one.hold(0.9)
        one.release()  # "two" begins again
        assert one.heard(TEXT) == "one two"
        one.begin()
        assert one.heard(TEXT) == ""

    run(listen)


def test_a_sentence_queued_during_a_hold_waits_for_the_release() -> None:
    async def listen() -> None:
        one = mouth()
        one.begin()
        one.queue(said("one two."), 0)
        await _wait(0.5)
        one.hold(0.5)
        one.queue(said(" three four"), 8)
        await _wait(3.0)
        assert one.heard("one two. three four") == "one"
        one.release()
        await one.played_out()
        assert one.heard("one two. three four") == "one two. three four"

    run(listen)


def test_nothing_of_a_new_utterance_counts_as_heard_before_it_sounds() -> None:
    async def listen() -> None:
        one = mouth()
        one.begin()
        one.queue(said(), 0)
        await _wait(1.0)
        one.stop()
        one.begin()
        assert one.heard("other words") == ""
        one.queue(said("other words"), 0)
        await _wait(0.6)
        assert one.heard("other words") == "other"

    run(listen)


def test_the_method_reference_returns_the_sound_that_is_playing() -> None:
    async def listen() -> None:
        one = mouth()
        one.begin()
        assert one.reference(640) == bytes(640)
        one.queue(said("one two", 0.1), 0)
        heard = []
        for _ in range(15):
            await _wait(0.02)
            heard.append(any(one.reference(640)))
        assert heard[:10] == [True] * 10 and not any(heard[11:])

    run(listen)


def test_the_class_speech_yields_each_sentence_as_soon_as_it_is_complete() -> None:
    async def listen() -> None:
        speech, found = Speech(), list[tuple[int, str]]()

        async def follow() -> None:
            async for sentence in speech.sentences():
                found.append(sentence)

        following = asyncio.create_task(follow())
        for piece, count in (("Once there was ", 0), ("a robot. It ", 1), ("lived in a museum.", 1)):
            speech.grow(piece)
            await _wait(0.1)
            assert len(found) == count
        speech.grow(" The end.")
        speech.finish()
        await following
        assert "".join(text for _, text in found) == speech.text
        assert found[1][0] == 23

    run(listen)
