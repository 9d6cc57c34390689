"""The plainest sentences, which are understood without the tagger."""

from __future__ import annotations

from types import SimpleNamespace

import pytest

from ravestate.modules.meta.nlp.analysis import analyse
from ravestate.modules.meta.nlp.pipeline import pipeline
from ravestate.modules.skill.persqa.plain import plain_tags
from ravestate.modules.skill.persqa.reading import Reader


@pytest.mark.parametrize(
    ("text", "found"),
    [
        ("My name is Ada.", {("name", "Ada")}),
        ("I live in New York.", {("home", "New York")}),
        ("I am 36 years old, and I work as a nurse.", {("age", "36"), ("occupation", "nurse")}),
        ("My sister is called Rosa.", {("sister", "Rosa")}),
        ("It is cold.", set[tuple[str, str]]()),
    ],
)
def test_a_plain_sentence_tells_its_facts(text: str, found: set[tuple[str, str]]) -> None:
    assert {(tag.label, tag.text) for tag in plain_tags(text, "")} == found


def test_a_few_bare_words_answer_a_question() -> None:
    assert [(tag.label, tag.text) for tag in plain_tags("New York.", "home")] == [("home", "New York")]
    assert plain_tags("New York.", "") == ()
    assert plain_tags("I would rather not tell you that.", "home") == ()


@pytest.mark.parametrize(
    ("text", "asked", "name"),
    [
        ("hi im Nora", "", "Nora"),
        ("im nora", "", "Nora"),
        ("Good evening. I am Li Wenyan, mining engineer", "", "Li Wenyan"),
        ("I'm Nora and I live in Ulm", "", "Nora"),
        ("this is Bob", "", "Bob"),
        ("Call me Ilka", "", "Ilka"),
        ("I'm Harjit", "name", "Harjit"),
        ("it's me, Ilka", "name", "Ilka"),
        ("I'm tired", "name", None),
        ("I'm German", "name", None),
        ("I'm Rosa's sister", "name", None),
        ("call me tomorrow", "", None),
        ("I'm tired", "", None),
        ("I'm Rosa's sister", "", None),
        ("I am from Spain", "", None),
        ("Our cat is small, it's Max", "", None),
    ],
)
@pytest.mark.usefixtures("reader")
def test_an_introduction_gives_the_name_even_without_the_tagger(
    text: str, asked: str, name: str | None, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("ravestate.modules.skill.persqa.reading.tagger", lambda: SimpleNamespace(loaded=False))
    facts = {fact.topic: fact.values for fact in Reader(analyse(text, pipeline("")), asked).facts()}
    assert facts.get("name") == ((name,) if name else None)
