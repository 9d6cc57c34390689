"""Follow-ups: replies to the user's utterance directly after a reply of the bank."""

from __future__ import annotations

import random
from collections.abc import Callable
from dataclasses import replace
from typing import Any

import pytest

from ravestate.modules.skill.wildtalk.listening import Heard, Listener, State
from ravestate.modules.skill.wildtalk.listening.bank import Bank
from ravestate.modules.skill.wildtalk.listening.material import material

from .conftest import Talk, listener_with, seen

ROWS = """
-\tthe goat is on the roof\tWhich roof is it?
>\tthe shed | the henhouse\tThe henhouse roof holds a goat.
>>\tit does not hold\tThen fetch the ladder at once.
>>>\ti have no ladder\tA table and a chair reach as high.
>>\t*\tA goat up there has a good view.
>\tyes\tSo it stands there still.
>\tno | not any more\tSo the goat came down by itself.
>\twhat shall i do now\tShake a bucket of oats.
>\ti dont know\tA bleating roof gives itself away.
>\t*\tThe goat certainly has its reasons.
-\tthe goat is a thief\tThieves have to be fed.
-\tmy fence fell over\tA fence likes company.
-\tthe goat had a birthday\tHow old is it now?
>\tit is ten minutes old | two hours\tThen it can stand up by now.
>\ttwo days | it is a week old\tThen it climbs on everything.
sad\tmy duck drowned\tThat duck was lucky in you.
>\tshe was ten\tTen years are a duck's whole life.
"""


@pytest.fixture(scope="module")
def bank() -> Bank:
    """A bank of three entries about a goat, a fence and a duck, with follow-ups."""
    found = Bank([(f"own.tsv:{number}", row) for number, row in enumerate(ROWS.splitlines(), 1) if row])
    found.load()
    return found


@pytest.fixture
def own(bank: Bank, begin: Callable[[int], Talk], monkeypatch: pytest.MonkeyPatch) -> Callable[[int], Talk]:
    """Return a function that begins a conversation with only that bank."""

    def begun(seed: int = 0) -> Talk:
        talk = begin(seed)
        talk.listener = listener_with(bank)
        return talk

    return begun


@pytest.mark.parametrize(
    ("text", "reply"),
    [
        ("it's the henhouse", "The henhouse roof holds a goat."),
        ("yeah", "So it stands there still."),
        ("nope", "So the goat came down by itself."),
        ("no, not any longer", "So the goat came down by itself."),
        ("I have no idea", "A bleating roof gives itself away."),
        ("and what should I do now?", "Shake a bucket of oats."),
        ("it stands on the old roof of straw", "The goat certainly has its reasons."),
        ("red tiles", "The goat certainly has its reasons."),
    ],
)
def test_after_an_entry_its_most_similar_follow_up_answers(text: str, reply: str, own: Callable[..., Talk]) -> None:
    talk = own()
    assert talk.say("the goat is on the roof") == "Which roof is it?"
    assert talk.say(text) == reply


def test_a_long_statement_about_another_subject_gets_no_follow_up(own: Callable[..., Talk]) -> None:
    talk = own()
    talk.say("the goat is on the roof")
    assert talk.say("my cousin plays chess with a dentist every friday") != "The goat certainly has its reasons."


def test_an_answer_in_days_gets_the_follow_up_for_days_and_not_for_minutes(own: Callable[..., Talk]) -> None:
    talk = own()
    assert [talk.say("the goat had a birthday"), talk.say("about ten days")][-1] == "Then it climbs on everything."


def test_follow_ups_can_have_follow_ups_up_to_three_levels_deep(own: Callable[..., Talk]) -> None:
    talk = own()
    said = [talk.say(text) for text in ("the goat is on the roof", "the shed", "it doesn't hold", "I have no ladder")]
    assert said[2:] == ["Then fetch the ladder at once.", "A table and a chair reach as high."]


def test_a_follow_up_of_the_entry_before_the_last_reply_can_still_answer(own: Callable[..., Talk]) -> None:
    talk = own()
    said = [talk.say(text) for text in ("the goat is on the roof", "the shed", "what shall i do now")]
    assert said[-1] == "Shake a bucket of oats."


def test_a_search_of_the_bank_finds_no_follow_ups(bank: Bank, own: Callable[..., Talk]) -> None:
    assert own().say("the henhouse") != "The henhouse roof holds a goat."
    names = {found.moment.name for found in bank.similar(["the henhouse"], "the henhouse")}
    assert names <= {one.name for one in bank.moments}


@pytest.mark.parametrize(
    ("text", "unsaid"),
    [
        ("my father died this morning", "goat"),
        ("what is the capital of Peru?", "goat"),
        ("tell me a joke", "goat"),
        ("bye, see you tomorrow", "goat"),
        ("please write a poem about it", "goat"),
        ("my fence has fallen over", "goat"),
    ],
)
def test_the_follow_up_for_any_other_statement_does_not_answer_sorrows_questions_or_requests(
    text: str, unsaid: str, own: Callable[..., Talk]
) -> None:
    talk = own()
    talk.say("the goat is on the roof")
    assert unsaid not in talk.say(text)


def test_the_reply_of_a_follow_up_is_not_repeated_soon(own: Callable[..., Talk]) -> None:
    talk = own()
    talk.say("the goat is on the roof")
    state = talk.state
    first = talk.say("the henhouse")
    talk.state = replace(state, said=talk.state.said, recent=talk.state.recent)
    assert talk.say("the henhouse") != first


def test_a_follow_up_has_the_tone_of_its_entry(own: Callable[..., Talk]) -> None:
    talk = own()
    assert [talk.say("my duck drowned"), talk.say("she was ten")][-1] == "Ten years are a duck's whole life."
    assert talk.state.tone == "sad"


def test_only_a_clear_follow_up_takes_precedence_over_other_modules(own: Callable[..., Talk]) -> None:
    talk = own()
    talk.say("the goat is on the roof")
    texts = ("it's the henhouse", "nope", "red tiles", "Anna", "what is a goat?")
    assert [talk.listener.continues(Heard(text, seen(text)), talk.state) for text in texts] == [
        True,
        True,
        False,
        False,
        False,
    ]
    assert not talk.listener.continues(Heard("it's the henhouse", seen("it's the henhouse")), State())


def test_after_an_answer_of_another_module_a_yes_gets_no_follow_up(own: Callable[..., Talk]) -> None:
    talk = own()
    talk.say("the goat is on the roof")
    talk.state = replace(talk.state, moment="")  # another module has answered
    assert talk.say("yes") != "So it stands there still."


def test_the_same_seed_gives_the_same_conversation(begin: Callable[[int], Talk]) -> None:
    texts = ["we got a puppy", "ten weeks old", "no, he cries all night", "my bus was late", "yes, very", "good"]
    assert [begin(3).say(text) for text in texts[:1]] == [begin(3).say(text) for text in texts[:1]]
    first, second = begin(3), begin(3)
    assert [first.say(text) for text in texts] == [second.say(text) for text in texts]


def test_a_built_in_follow_up_continues_the_thread(begin: Callable[[int], Any]) -> None:
    talk = begin(1)
    talk.say("my train was cancelled again")
    before = material().bank.follow_ups(talk.state.moment)
    talk.say("yes, I missed a meeting")
    assert talk.state.moment in [one.name for one in before]


def test_before_the_model_is_loaded_a_follow_up_is_found_by_equal_words() -> None:
    bank = Bank([("own.tsv:1", "-\tthe kettle sings\tThen tea."), ("own.tsv:2", ">\tgreen tea\tA good cup.")])
    assert bank.likeness(["Green tea!"], bank.named["own.tsv:2"]) == [("green tea", 1.0)]


def test_the_listener_expects_a_follow_up_only_after_an_entry() -> None:
    listener, chance = Listener(), random.Random(0)
    state = listener.answer(Heard("my bus was late", seen("my bus was late")), State(), chance).state
    assert state.thread and listener.expects(state)
    assert not listener.expects(State())
