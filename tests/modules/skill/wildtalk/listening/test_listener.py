"""The listening skill answers what was said, and does not repeat itself. `tests/quality` measures how well it listens."""

import itertools
import re
from collections.abc import Callable
from typing import Any

import pytest

from quality.measure import labelled
from ravestate.modules.skill.wildtalk.listening import Heard, State
from ravestate.modules.skill.wildtalk.listening.hearing import hear
from ravestate.modules.skill.wildtalk.listening.material import Line, material
from ravestate.modules.skill.wildtalk.listening.phrases import filled
from ravestate.modules.skill.wildtalk.listening.roles import thing_in

from .conftest import Talk, lines_of, seen

PLAIN = [
    "the bus came late", "i bought some bread", "my aunt has a garden", "ok", "we sat in the park", "hm",
    "it was warm",
]  # fmt: skip
ODD = [
    "the clerk stamped a form", "a man with a ladder stood there", "he carried a bucket", "then he whistled",
    "the lamp swung", "she pointed at a wall", "they lifted the lid",
]  # fmt: skip
"""Statements of which no phrase is worth repeating, and that show no feeling."""
CLAIMS = re.compile(
    r"\b(yesterday|last (?:week|night|year)) I\b|\bI (?:ate|drank|slept|drove|walked|went|visited)\b|\bmy (?:wife|husband|mother)\b"
)


def all_lines() -> list[Line]:
    phrases = material()
    groups = (phrases.responses, phrases.asked, phrases.areas, phrases.plain)
    return [line for group in groups for moment in group.values() for line in lines_of(moment)]


@pytest.mark.parametrize("seed", range(2))
def test_the_listener_says_nothing_twice_within_a_dozen_answers(seed: int, begin: Callable[[int], Any]) -> None:
    talk = begin(seed)
    said = [talk.say(text) for text in PLAIN * 6]
    for place, answer in enumerate(said):
        assert answer == "Mhm." or answer not in said[max(0, place - 12) : place]


@pytest.mark.parametrize("text", ["I see no reason.", "who knows", "my cat sleeps", "hello", "what is a quark"])
def test_a_repeated_utterance_gets_different_answers(text: str, talk: Any) -> None:
    said = [talk.say(text) for _ in range(6)]
    assert all(first != second for first, second in itertools.pairwise(said))


def test_a_sad_statement_gets_no_exclamation(begin: Callable[[int], Any]) -> None:
    for seed in range(6):
        talk = begin(seed)
        talk.say("my uncle died in May")
        assert "!" not in talk.say("he left me a crate of rusty lanterns")


@pytest.mark.parametrize(
    ("text", "thing"),
    [("I love my old maps.", "your old maps"), ("she found your red ball", "my red ball"), ("he likes it lol", None)],
)
def test_the_role_thing_is_a_noun_phrase_in_which_my_becomes_your(text: str, thing: str | None) -> None:
    assert thing_in(seen(text)) == (thing or "")


def test_a_farewell_at_the_end_of_an_utterance_gets_a_farewell(talk: Any) -> None:
    farewells = [line.text for line in lines_of(material().plain["farewell"])]
    assert talk.say("Right. I have to load the van. See you.") in farewells


def test_after_an_unfinished_sentence_the_listener_waits(talk: Any) -> None:
    broken = {line.text for line in material().plain["broken"].groups["say"]}
    assert talk.say("wait she's") in broken
    assert talk.say("hold on my") in broken


def test_a_sad_sentence_outweighs_a_farewell_that_it_resembles(talk: Any) -> None:
    farewells = {line.text for line in lines_of(material().plain["farewell"])}
    assert talk.say("I am at the end of my tether") not in farewells


def test_after_a_wish_for_no_questions_the_listener_asks_none(talk: Any) -> None:
    talk.say("no more questions please")
    assert not any(talk.say(text).endswith("?") for text in PLAIN)


def test_the_listener_keeps_a_sad_tone_for_a_while(begin: Callable[[int], Any]) -> None:
    for seed in range(5):
        talk = begin(seed)
        talk.say("my grandmother died yesterday")
        assert talk.state.tone == "sad"
        assert "!" not in talk.say("she had a red chair")


def test_the_listener_seldom_asks_three_times_in_a_row(begin: Callable[[int], Any]) -> None:
    rows = 0
    for seed in range(3):
        talk = begin(seed)
        said = [talk.say(text).endswith("?") for text in PLAIN * 2]
        rows += sum(all(said[place : place + 3]) for place in range(len(said) - 2))
    assert rows <= 9  # of 36: questions of the bank come before general remarks


def test_the_listener_keeps_its_opinions(begin: Callable[[int], Any]) -> None:
    talk = begin(4)
    talk.say("what do you think of opera")
    stance = dict(talk.state.stances)
    talk.say("I see")
    talk.say("what do you think of opera")
    assert dict(talk.state.stances) == stance
    assert len(stance) == 1


def test_the_same_seed_gives_the_same_conversation(begin: Callable[[int], Any]) -> None:
    one, other = begin(7), begin(7)
    assert [one.say(text) for text in PLAIN] == [other.say(text) for text in PLAIN]


@pytest.mark.parametrize(
    ("text", "group"),
    [("asdfghj", "nonsense"), ("42", "number"), ("Ich verstehe das nicht", "tongue"), ("где ты живёшь", "tongue")],
)
def test_to_an_utterance_that_is_not_english_the_listener_says_that_it_does_not_understand(
    text: str, group: str, talk: Any
) -> None:
    assert talk.say(text) in [line.text for line in lines_of(material().plain[group])]


@pytest.mark.parametrize(
    ("text", "named"),
    [
        ("how long is the Danube", "the danube"),
        ("which key opens the shed", "the shed"),
    ],
)
def test_the_answer_to_an_unknown_fact_names_its_subject(text: str, named: str, begin: Callable[[int], Any]) -> None:
    assert all(named in begin(seed).say(text).lower() for seed in range(4))


def test_a_question_is_answered_by_its_kind_and_its_area_of_life(begin: Callable[[int], Any]) -> None:
    for text, _ in labelled("asked_rows"):
        heard = hear(material(), Heard(text, seen(text)), State())
        assert heard.asked is not None
        lines = [line for group in heard.asked.lines(material(), heard.tone, heard.asking) for line in group]
        known = [line.text for line in lines if line.roles <= heard.values.keys()]
        assert begin(2).say(text) in [filled(one, heard.values) for one in known], text


@pytest.mark.parametrize(
    ("text", "options"),
    [
        ("should I bake a cake or buy one", ("bake a cake", "buy one")),
        ("which hat suits me, the red one or the grey one?", ("the red one", "the grey one")),
        ("should I call my boss or wait till Monday?", ("call your boss", "wait till Monday")),
    ],
)
def test_the_listener_chooses_one_of_two_options(
    text: str, options: tuple[str, str], begin: Callable[[int], Any]
) -> None:
    for seed in range(4):
        assert any(option.lower() in begin(seed).say(text).lower() for option in options)


def test_the_listener_does_what_can_be_done_in_words(talk: Any) -> None:
    assert "pickle" in talk.say("say the word pickle").lower()
    assert "pickle" in talk.say("say that again").lower()
    assert talk.say("name three animals").count(",") == 1


def test_something_else_gets_another_answer_of_the_same_kind(talk: Any) -> None:
    first = talk.say("what is a good film for a rainy evening")
    second = talk.say("something else")
    films = {line.text for line in material().areas["film"].groups["recommend"]}
    assert {first, second} <= films
    assert first != second


def test_the_listener_answers_even_without_an_analysis(talk: Any) -> None:
    assert talk.say("my dog is called Max", parsed=False)
    assert talk.say("where is Max?", parsed=False)


@pytest.mark.parametrize("text", ["", "...", "🙂", "{clause}", "x" * 5000, "a" * 50, "\x00", "{} {0}"])
def test_odd_input_gets_an_answer(text: str, talk: Any) -> None:
    assert talk.say(text)


def test_there_are_many_phrases_and_all_their_roles_are_known() -> None:
    lines = all_lines()
    assert len({line.text for line in lines}) >= 400
    roles = {"thing", "last", "first", "second", "about", "word", "short", "picked"}
    assert {role for line in lines for role in line.roles} <= roles


def test_no_phrase_claims_what_a_machine_cannot_do() -> None:
    assert not [line.text for line in all_lines() if CLAIMS.search(line.text)]


@pytest.mark.parametrize(
    "text", ["he used to sing in the garden", "please, not a song", "how can you sing now?", "i didn't ask for a song"]
)
def test_words_about_a_song_that_ask_for_none_get_none(text: str, begin: Callable[[int], Talk]) -> None:
    talk = begin(0)
    talk.say("sing a song about a dog")
    assert "\u266a" not in talk.say(text)
