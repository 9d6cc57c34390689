"""The plainest sentences, which are understood without the tagger."""

from __future__ import annotations

import pytest

from ravestate.modules.skill.persqa.plain import plain_tags


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
