"""The listening skill answers what was said, and does not repeat itself. `tests/quality` measures how well it listens."""

import itertools
import re
from collections.abc import Callable
from dataclasses import replace
from typing import Any

import pytest

from quality.measure import labelled
from ravestate.language.examples import bundled
from ravestate.language.matcher import bundled_matcher
from ravestate.modules.skill.wildtalk.listening import Heard, State
from ravestate.modules.skill.wildtalk.listening import hearing as hearing_module
from ravestate.modules.skill.wildtalk.listening.bank import Bank
from ravestate.modules.skill.wildtalk.listening.hearing import hear, likely
from ravestate.modules.skill.wildtalk.listening.material import Line, material
from ravestate.modules.skill.wildtalk.listening.moment import roles_in
from ravestate.modules.skill.wildtalk.listening.roles import roles_of
from ravestate.modules.skill.wildtalk.listening.state import Pending

from .conftest import Talk, lines_of, listener_with, seen

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
    groups = (phrases.acts, phrases.feelings, phrases.moments, phrases.taking_up, phrases.plain)
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


def no_responses(*_: Any, **__: Any) -> list[Any]:
    """Stand in for `responses_to`: no reply suits."""
    return []


def test_if_no_reply_suits_the_listener_takes_up_the_highlight(
    begin: Callable[[int], Any], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(hearing_module, "responses_to", no_responses)
    for seed in range(6):
        said = begin(seed).say("he came home with two rusty lanterns")
        assert "two rusty lanterns" in said.lower(), said


def test_a_sad_statement_gets_no_exclamation(begin: Callable[[int], Any]) -> None:
    for seed in range(6):
        talk = begin(seed)
        talk.say("my uncle died in May")
        assert "!" not in talk.say("he left me a crate of rusty lanterns")


def test_the_listener_asks_no_third_question_in_a_row(begin: Callable[[int], Any]) -> None:
    for seed in range(6):
        talk = begin(seed)
        asked = [talk.say(text).endswith("?") for text in ODD]
        assert (True, True, True) not in zip(asked, asked[1:], asked[2:], strict=False)


@pytest.mark.parametrize(
    ("advice", "reason"),
    [("should i lend him the ladder", "because he broke"), ("can you sing", "")],
)
def test_why_after_advice_gets_the_statement_before_the_advice_as_the_reason(
    advice: str, reason: str, talk: Any
) -> None:
    talk.say("my cousin broke the last ladder")
    talk.say(advice)
    said = talk.say("why?")
    assert ("your cousin broke the last ladder" in said) == bool(reason)


@pytest.mark.parametrize(
    ("text", "thing"),
    [("I love my old maps.", "your old maps"), ("she found your red ball", "my red ball"), ("he likes it lol", None)],
)
def test_the_role_thing_is_a_noun_phrase_in_which_my_becomes_your(text: str, thing: str | None) -> None:
    assert roles_of(seen(text), "", None, material()).values.get("thing") == thing


@pytest.mark.parametrize(
    ("text", "move"),
    [
        ("What was the name of my sister, do you remember?", "recall"),
        ("I was so lonely and cried all evening.", "console"),
        ("We moved to a village by the lake, and now we keep ducks.", "interest"),
        ("But I just told you that, are you even listening?", "apologise"),
    ],
)
def test_a_likely_move_gets_an_answer_of_its_kind(text: str, move: str, talk: Any) -> None:
    assert move in likely(material(), seen(text))
    hearing = hear(material(), Heard(text, seen(text)), State())
    said = talk.say(text)
    replies = {line.text for name in (move, "tell", "ask") for line in lines_of(material().replies[name])}
    situations = (*material().moments.values(), *material().feelings.values())
    fitting = {line.text for one in situations if move in one.moves or one.tone == "sad" for line in lines_of(one)}
    suiting = {line.text for one in material().bank.similar([text], text) for line in lines_of(one.moment)}
    told = {line.text for one in material().taking_up.values() for line in lines_of(one)}
    suiting |= {one.line.text for one in hearing.responses}
    taken = hearing.taken is not None and any(said.endswith(text) for text in told)
    assert said in replies | fitting | suiting or (taken and move == "interest")


def test_every_situation_lists_the_moves_that_its_phrases_suit() -> None:
    replies = material().replies.keys()
    assert not [one.name for one in material().moments.values() if not one.moves or one.moves - replies]


def test_every_move_has_replies_and_a_minimum_confidence() -> None:
    moves = set(bundled("moves").classes) - {"like"}
    assert moves == material().replies.keys() - {"tell", "ask"}
    for move in moves:
        assert 0 < material().replies[move].least < 1
        assert len(material().replies[move].groups["say"]) >= 5


def test_a_reply_to_sorrow_is_neither_cheerful_nor_an_excuse() -> None:
    for move in ("console", "mourn", "tell", "ask"):
        for line in material().replies[move].groups["say"] + material().replies[move].groups.get("sad", ()):
            assert "!" not in line.text


def test_a_farewell_at_the_end_of_an_utterance_gets_a_farewell(talk: Any) -> None:
    groups = material().acts["farewell"], material().replies["farewell"]
    assert talk.say("Right. I have to load the van. See you.") in [
        line.text for one in groups for line in lines_of(one)
    ]


@pytest.mark.parametrize(
    "text", ["the baby wakes as soon as I put her down", "my friend is late again", "he fell asleep on my arm"]
)
def test_the_listener_mourns_only_after_a_word_for_death(text: str, begin: Callable[[int], Any]) -> None:
    for seed in range(5):
        talk = begin(seed)
        talk.say(text)
        assert talk.state.moment not in ("grief", "pet_died_child", "widowed", "old_friend_died")


def test_after_an_unfinished_sentence_the_listener_waits(talk: Any) -> None:
    broken = {line.text for line in material().plain["broken"].groups["say"]}
    assert talk.say("wait she's") in broken
    assert talk.say("hold on my") in broken


def test_an_answer_is_one_of_the_lines_of_its_situation(talk: Any) -> None:
    said = talk.say("did that make you laugh?")
    assert said in {line.text for line in lines_of(material().moments[talk.state.moment])}


def test_a_sad_sentence_outweighs_a_farewell_that_it_resembles(talk: Any) -> None:
    talk.say("I am at the end of my tether")
    assert talk.state.tone == "sad"


def test_after_a_wish_for_no_questions_the_listener_asks_none(talk: Any) -> None:
    talk.say("no more questions please")
    assert not any(talk.say(text).endswith("?") for text in PLAIN)


@pytest.mark.parametrize(
    ("text", "pronoun"),
    [("my mother is ill", "her"), ("my grandfather is in hospital", "him"), ("my parents are ill", "them")],
)
def test_the_listener_uses_the_right_pronoun_for_a_relative(
    text: str, pronoun: str, begin: Callable[[int], Any]
) -> None:
    said: list[str] = []
    for seed in range(20):
        talk = begin(seed)
        talk.listener = listener_with(Bank([]))  # the replies of the bank have no roles
        said.append(talk.say(text))
    assert any(re.search(rf"\b{pronoun}\b", answer) for answer in said)
    others = {"her", "him", "them"} - {pronoun}
    assert not any(re.search(rf"\b{other}\b", answer) for answer in said for other in others)


def test_a_pronoun_stands_for_the_person_mentioned_before(talk: Any) -> None:
    talk.say("my grandfather is in hospital")
    talk.say("he broke his leg")
    assert talk.state.being is not None
    assert talk.state.being.text == "your grandfather"


def test_the_listener_keeps_a_sad_tone_for_a_while(begin: Callable[[int], Any]) -> None:
    for seed in range(5):
        talk = begin(seed)
        talk.say("my grandmother died yesterday")
        assert talk.state.tone == "sad"
        assert "!" not in talk.say("she had a red chair")


def test_an_answer_to_the_listeners_question_gets_a_fitting_reply(begin: Callable[[int], Any]) -> None:
    replies: set[str] = set()
    for seed in range(30):
        talk = begin(seed)
        talk.listener = listener_with(Bank([]))
        if "Is somebody with her?" in talk.say("my mother is ill"):
            replies.add(talk.say("yes"))
    assert replies
    assert replies <= {"That's good. I'm glad she has somebody there.", "I'm glad she has company."}


def test_a_short_answer_to_any_question_is_acknowledged(talk: Any) -> None:
    talk.state = replace(talk.state, pending=Pending("Who makes the tea?"), said=("Who makes the tea?",))
    took = [line.text for line in lines_of(material().plain["took"])]
    assert talk.say("my aunt") in took


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
        lines = [line for group in heard.asked.lines(material(), "", heard.asking) for line in group]
        lines += [line for one in heard.near for group in one.moment.lines("say") for line in group]
        known = [line.text for line in lines if line.roles <= heard.roles.values.keys()]
        assert begin(2).say(text) in map(heard.roles.fill, known), text


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
    roles = {"thing", "who", "they", "them", "their", "are", "were", "have", "do", "last"}
    roles |= {"first", "second", "called", "user", "told", "ground", "highlight"}
    assert {role for line in lines for role in line.roles} <= roles


def test_a_phrase_also_needs_the_roles_of_its_reactions() -> None:
    lines = [line for line in all_lines() if line.then]
    assert len(lines) >= 50
    assert all(roles_in(text) <= line.roles for line in lines for texts in line.then.values() for text in texts)


def test_no_phrase_claims_what_a_machine_cannot_do() -> None:
    assert not [line.text for line in all_lines() if CLAIMS.search(line.text)]


def test_every_act_and_feeling_has_an_answer() -> None:
    phrases = material()
    feelings = {one for one in bundled_matcher("feelings").exact.values() if one}
    acts = {one for one in bundled_matcher("acts").exact.values() if one}
    assert feelings - phrases.feelings.keys() <= {"boredom"}
    assert acts - phrases.acts.keys() <= {"joke", "song", "story", "play", "repeat", "wish"}


@pytest.mark.parametrize("text", ["I only wondered whether the light is still on", "no eggs left in the fridge again"])
def test_a_remark_is_neither_a_question_nor_a_correction(text: str, begin: Callable[[int], Any]) -> None:
    excuses = {
        line.text for name in ("fact", "recall", "apologise", "ask") for line in lines_of(material().replies[name])
    }
    assert not {begin(seed).say(text) for seed in range(5)} & excuses


@pytest.mark.parametrize(
    "text", ["he used to sing in the garden", "please, not a song", "how can you sing now?", "i didn't ask for a song"]
)
def test_words_about_a_song_that_ask_for_none_get_none(text: str, begin: Callable[[int], Talk]) -> None:
    talk = begin(0)
    talk.say("sing a song about a dog")
    assert "\u266a" not in talk.say(text)


def test_a_pronoun_is_looked_up_as_the_person_whom_the_user_mentioned(begin: Callable[[int], Talk]) -> None:
    """The bank is asked about *my dad is in hospital*, and not only about *he is in hospital*."""
    talk, other = begin(0), begin(0)
    talk.say("i am worried about my dad")
    talk.say("he is in hospital")
    other.say("my dad is in hospital")
    assert talk.state.moment == other.state.moment != ""
