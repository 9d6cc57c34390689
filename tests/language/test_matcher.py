"""A matcher finds the class of a sentence, or none, with a score. All matchers share one run of the encoder."""

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import pytest

from ravestate.language import cache as cache_module
from ravestate.language.encoder import Encoder
from ravestate.language.matcher import Matcher, bundled_matcher
from ravestate.language.model import SentenceModel
from ravestate.modules.meta.nlp.analysis import MATCHERS, analyse
from ravestate.modules.meta.nlp.pipeline import pipeline

EXAMPLES = {
    "hours": ["when do you open", "how late are you open", "are you open on Sundays"],
    "table": ["I would like to book a table", "a table for two please", "can I reserve a table"],
}
NONE = ["the train leaves at nine", "my brother is tall", "what is the capital of Peru", "I like green tea"]


@pytest.fixture(scope="module")
def matcher() -> Matcher:
    matcher = Matcher(EXAMPLES, NONE)
    matcher.load()
    return matcher


@pytest.mark.parametrize(
    ("sentence", "name"),
    [
        ("until when are you open today?", "hours"),
        ("At what time do you open?", "hours"),
        ("Could I book a table for tonight?", "table"),
        ("My sister sings in a choir.", None),
        ("How tall is your brother?", None),
        ("", None),
    ],
)
def test_a_sentence_belongs_to_the_class_that_it_resembles(matcher: Matcher, sentence: str, name: str | None) -> None:
    match = matcher.match(sentence)
    assert (match and match.name) == name


def test_the_matcher_is_surer_of_its_examples_than_of_similar_sentences(matcher: Matcher) -> None:
    example, similar = matcher.match_all(["When do you open?", "Say, until when are you open?"])
    assert example is not None and similar is not None
    assert example.score > similar.score > 0.5
    assert example.margin > similar.margin > 0
    assert example.example == "when do you open"


def test_the_ranking_contains_all_classes_and_none(matcher: Matcher) -> None:
    (first, second, third) = matcher.ranked("when do you open")
    assert {first.name, second.name, third.name} == {"hours", "table", ""}
    assert first.margin > 0 > second.margin >= third.margin


def test_a_matcher_that_is_not_loaded_recognises_only_its_exact_examples() -> None:
    matcher = Matcher(EXAMPLES, NONE)
    assert not matcher.loaded
    match = matcher.match("When do u open?")
    assert match is not None and (match.name, match.score) == ("hours", 1.0)
    assert matcher.match("until when are you open") is None
    assert matcher.match("I like green tea") is None


@pytest.mark.parametrize("load", [False, True])
def test_a_sentence_without_words_belongs_to_a_class_only_if_it_equals_an_example(load: bool) -> None:
    matcher = Matcher({"smile": ["🙂", "i smile"], "surprise": ["?!"]}, none=["the sun shines"])
    if load:
        matcher.load()
    found = matcher.match_all(["🙂", "?!", "👍", "!", "the sun shines"])
    assert [match and match.name for match in found] == ["smile", "surprise", None, None, None]


def test_an_example_that_resembles_another_class_is_a_confusion() -> None:
    matcher = Matcher({**EXAMPLES, "late": ["until when are you open", "how long are you open"]}, NONE)
    assert ("until when are you open", "late", "hours") in matcher.confusions()


@pytest.fixture
def runs(monkeypatch: pytest.MonkeyPatch) -> list[list[str]]:
    """The texts that each run of the model gets."""
    seen: list[list[str]] = []
    run = SentenceModel.run

    def counted(self: SentenceModel, texts: Sequence[Any]) -> Any:
        seen.append([str(text) for text in texts])
        return run(self, texts)

    monkeypatch.setattr(SentenceModel, "run", counted)
    return seen


def test_each_sentence_of_an_utterance_is_encoded_once_for_all_matchers(
    matcher: Matcher, runs: list[list[str]]
) -> None:
    for name in MATCHERS:
        bundled_matcher(name).load()
    pipeline("").load()
    runs.clear()
    seen = analyse("Hey, my polka is purple. Can I book a table?", pipeline(""), designed=matcher)
    assert len(seen.sentences) == 2
    assert len(runs) == len({text for texts in runs for text in texts})


def test_the_vectors_of_examples_are_computed_once_and_later_read_from_a_file(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path, runs: list[list[str]]
) -> None:
    monkeypatch.setattr(cache_module, "user_folder", lambda kind: tmp_path)
    texts = ["a purple cow", "a yellow horse"]
    first = Encoder().encode_lasting(texts).unpacked()
    assert runs == [["a purple cow"], ["a yellow horse"]]
    assert (Encoder().encode_lasting(texts).unpacked() == first).all()
    assert len(runs) == 2
