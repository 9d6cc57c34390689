"""Sentences that the agent once understood are still understood, with few exceptions."""

from __future__ import annotations

from collections import Counter

import pytest

from quality import modules
from quality.language import LABELLED, SETS, measured, ordinary_statements, triples_of, typed
from quality.measure import labelled
from ravestate.language.examples import bundled

FLOOR = 0.97
FLOORS = {
    "acts_rows": 0.9,
    "intents_rows": 0.93,
    "feelings_rows": 0.93,
    "emotion_rows": 0.95,
    "quiet_rows": 0.9,
    "typed_rows": 0.93,
    "yesno_rows": 0.88,
    "answers_rows": 0.84,
    "answers_fresh_rows": 0.88,
    "kinds_rows": 0.95,
    "questions_rows": 0.95,
}
"""Lower floors, for sets that share no sentence with the examples, and for sentences that people typed in a hurry."""
LABELS = {
    "questions_rows": {"PERSON", "PLACE", "OBJECT", "FORM", "TIME", "REASON", "AMOUNT", "YES_NO", "-"},
    "kinds_rows": {"PERSON", "PLACE", "OBJECT", "FORM", "TIME", "REASON", "AMOUNT", "YES_NO", "-"},
    "kinds_fresh_rows": {"PERSON", "PLACE", "OBJECT", "FORM", "TIME", "REASON", "AMOUNT", "YES_NO", "-"},
    "answers_rows": {"yes 2", "yes 1", "no 2", "no 1", "unsure", "-"},
    "answers_fresh_rows": {"yes 2", "yes 1", "no 2", "no 1", "unsure", "-"},
    "yesno_rows": {"yes 2", "yes 1", "no 2", "no 1", "unsure", "-"},
    "intents_rows": {"hi", "bye", "play", "-"},
    "quiet_rows": {"quiet", "leave", "-"},
    "feelings_rows": {"shy", "surprised", "happy", "affectionate", "sad", "-"},
    "flags_rows": {"negated", "past", "hearsay", "conditional", "plan", "question", "request", "-"},
    "emotion_rows": {"shy", "surprised", "happy", "affectionate", "sad", "-"},
}


@pytest.mark.parametrize("name", SETS)
def test_known_sentences_are_understood(name: str) -> None:
    result = measured(name)
    share = result.shares["right" if name in LABELLED else "exact"]
    print(f"{name}: {share:.1%} of {result.cases}", *result.misses, sep="\n  ")
    assert share >= FLOORS.get(name, FLOOR), "\n".join(result.misses)


def test_the_fast_measurements_give_the_same_results_as_the_whole_analysis_of_nlp() -> None:
    for text, _ in (*labelled("triples_rows")[::30], *labelled("questions_rows")[::20]):
        whole = modules.analysed(text)
        assert [tuple(map(modules.text_of, triple)) for triple in whole.triples] == modules.triples(text)
        assert whole.question == modules.question(text)


def test_ordinary_statements_are_no_answers() -> None:
    texts = ordinary_statements()
    read = [text for text in texts if modules.yesno(text) != "-"]
    print(f"{len(read)} of {len(texts)}", *read, sep="\n  ")
    assert len(texts) >= 300
    assert len(read) <= 0.1 * len(texts)


@pytest.mark.parametrize("name", SETS)
def test_no_set_of_nlp_has_a_sentence_twice(name: str) -> None:
    rows = typed() if name == "typed_rows" else labelled(name)
    assert [text for text, count in Counter(text for text, _ in rows).items() if count > 1] == []


@pytest.mark.parametrize("name", LABELLED)
def test_each_label_is_known_and_occurs(name: str) -> None:
    labels = {label for _, label in labelled(name)}
    if name == "acts_rows":
        labels = {act for label in labels for act in label.split("+")} - {"-"}
        assert labels <= bundled("acts").classes.keys()
    else:
        assert labels == LABELS[name]


def test_triples_are_read_from_their_notation() -> None:
    assert triples_of("My_sister sing _; I not_like tea") == {
        ("My sister", "sing", ""),
        ("I", "not like", "tea"),
    }
    assert triples_of("") == frozenset()
