"""The user's words from the agent's view."""

import pytest

from ravestate.modules.meta.nlp.pipeline import pipeline
from ravestate.modules.skill.wildtalk.listening.turning import clause, turned_text


@pytest.mark.parametrize(
    ("text", "turned"),
    [
        ("I painted a dragon at school.", "you painted a dragon at school"),
        ("Well, I am tired.", "you're tired"),
        ("I was late and my boss was angry.", "you were late"),
        ("We have lost our keys.", "you have lost your keys"),
        ("You are nice.", "I am nice"),
        ("You told me that.", "I told you that"),
        ("My sister gave you my book.", "your sister gave me your book"),
        ("I can not swim.", "you can't swim"),
        ("I do not like it because it is cold.", "you don't like it"),
        ("I hurt myself.", "you hurt yourself"),
        ("My mother she is ill.", "your mother is ill"),
        ("Raining again.", ""),
    ],
)
def test_a_clause_is_turned(text: str, turned: str) -> None:
    tree, _ = pipeline("").read(text)
    root = next(word for word in tree.words if word.dep == "ROOT")
    assert clause(tree, root) == turned


def test_words_without_a_parse_are_turned() -> None:
    assert turned_text(["my", "brother", "and", "me"]) == "your brother and you"
