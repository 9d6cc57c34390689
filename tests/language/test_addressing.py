"""In a sentence, the agent's name either means *you* or only addresses the agent."""

from __future__ import annotations

import pytest

from quality.measure import labelled
from ravestate.language.addressing import addressed


@pytest.mark.parametrize("name", ["Robin", "Robo Lina", "R2-D2"])
def test_any_name_becomes_you_unless_it_only_addresses_the_agent(name: str) -> None:
    assert addressed(f"How old is {name}?", [name, ""]) == "How old are you?"
    assert addressed(f"What are {name.lower()}'s hobbies?", [name]) == "What are your hobbies?"
    assert addressed(f"{name}, how are you?", [name]) == "how are you?"


def test_a_sentence_without_the_name_stays_as_it_is() -> None:
    for sentence in ("", "Robinson is nice.", "The robot sleeps.", "How are you?"):
        assert addressed(sentence, ["Robin"]) == sentence


def test_replacing_the_name_a_second_time_changes_nothing() -> None:
    once = [addressed(sentence, ["Robin"]) for sentence, _ in labelled("addressed_rows")]
    assert [addressed(sentence, ["Robin"]) for sentence in once] == once
