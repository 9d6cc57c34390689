"""Laws of the normal form, which is correct written English. The quality set ``written_rows`` measures how good it is."""

import threading
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor

import pytest
from hypothesis import given
from hypothesis import strategies as st

from quality.measure import labelled
from ravestate.language import normal
from ravestate.language.contractions import WRITTEN
from ravestate.language.lexicon import load_lexicon
from ravestate.language.normal import Normal, normalise, plain


@pytest.fixture(autouse=True, scope="module")
def lexicon() -> None:
    assert load_lexicon() is not None


def test_names_are_not_corrected_and_get_a_capital() -> None:
    assert normalise("hello freinda how are you", ["Freinda"]).text == "Hello Freinda. How are you?"
    assert normalise("my name is kira and i come from hildesheim").text == "My name is Kira and I come from Hildesheim."


SENTENCES = sorted(
    text
    for text, _ in labelled("triples_rows")
    if text[0].isupper() and text[-1] in ".?!" and " i " not in text and text not in ("Its", "Hello how are you?")
)


def test_a_correct_sentence_stays_as_it_is() -> None:
    assert len(SENTENCES) > 100
    assert [(text, normalise(text).text) for text in SENTENCES if normalise(text).text != text] == []


ODD = ["()", "it's", "’", "\n", "brohter", "sooo", "2", "4", ",", ".", "?", "!"]
words = st.sampled_from([*WRITTEN, *ODD, "I", "you", "munich", "where", "do", "are", "what", "hello", "yes"])
texts = st.lists(words, max_size=14).map(" ".join) | st.text(max_size=40)


def check_offsets(normal: Normal) -> None:
    assert len(normal.origin) == len(normal.text) + 1
    assert list(normal.origin) == sorted(normal.origin)
    assert all(0 <= place <= len(normal.original) for place in normal.origin)
    assert normal.origin[-1] == len(normal.original)
    assert len(normal.typed) == len(normal.text)


@given(texts)
def test_offsets_never_decrease_and_lie_within_the_original(text: str) -> None:
    check_offsets(normalise(text))


@given(texts)
def test_normalising_a_normal_form_does_not_change_it(text: str) -> None:
    once = normalise(text).text
    assert normalise(once).text == once


def test_each_word_has_its_position_in_the_original() -> None:
    mended = normalise("u dont like my brohter")
    for word, typed in (("You", "u"), ("don't", "dont"), ("like", "like"), ("brother", "brohter")):
        start = mended.text.index(word)
        first, last = mended.span(start, start + len(word))
        assert mended.original[first:last] == typed
    assert mended.adds(len(mended.text) - 1, len(mended.text))


def test_a_word_that_differs_only_in_capitals_keeps_the_typed_capitals() -> None:
    assert normalise("i live in munich, u KNOW").typed == "i live in munich, you KNOW."


def test_the_plain_form_has_no_contractions() -> None:
    assert plain("What's up, u CAN'T?") == "what is up you can not"
    assert plain("Im here") == plain("I am here.")


def test_the_normal_form_of_an_utterance_is_kept_for_all_rules() -> None:
    first = normalise("hullo rosie its me", ["Rosie"])
    assert normalise("hullo rosie its me", ("Rosie",)) is first


class Knowing:
    """A lexicon that knows every word. Its method `heard` runs for each word that `normalise` looks up."""

    def __init__(self, heard: Callable[[str], object]) -> None:
        self.heard = heard

    def name(self, word: str) -> str:
        self.heard(word)
        return word

    unstretched = correction = possible_name = name

    def known(self, word: str) -> bool:
        return True


def test_a_long_text_does_not_delay_other_texts(monkeypatch: pytest.MonkeyPatch) -> None:
    """Contexts share the normal forms. A text of 2,000 characters takes 0.1 s, and other users must not wait for it."""
    begun, go_on = threading.Event(), threading.Event()

    def wait(word: str) -> None:
        if word == "another":
            begun.set()
            assert go_on.wait(60)

    lexicon = Knowing(wait)
    monkeypatch.setattr(normal, "loaded_lexicon", lambda: lexicon)
    with ThreadPoolExecutor(1) as pool:
        other = pool.submit(normalise, "hi another user")
        assert begun.wait(60)
        assert normalise("u cant hold me up").text == "You can't hold me up."
        go_on.set()
        assert other.result(60).text == "Hi another user."


def test_simultaneous_rules_compute_the_normal_form_of_an_utterance_only_once(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    together = threading.Barrier(8)

    def looked_up_by(threads: int) -> list[str]:
        words: list[str] = []
        lexicon = Knowing(words.append)
        monkeypatch.setattr(normal, "loaded_lexicon", lambda: lexicon)

        def ask(_: int) -> Normal:
            if threads > 1:
                together.wait(60)
            return normalise("everybody reads this at the same time")

        with ThreadPoolExecutor(threads) as pool:
            found = list(pool.map(ask, range(threads)))
        assert len(set(map(id, found))) == 1
        return words

    assert "everybody" in looked_up_by(1)
    assert looked_up_by(8) == looked_up_by(1)
