"""The kinds of reply that suit an utterance. The quality set ``responses_rows`` measures more of them."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from quality.measure import labelled
from ravestate.modules.skill.wildtalk.listening import Heard
from ravestate.modules.skill.wildtalk.listening.hearing import hear
from ravestate.modules.skill.wildtalk.listening.material import material
from ravestate.modules.skill.wildtalk.listening.responses import LEAST, LIGHT, network, responses_to
from ravestate.modules.skill.wildtalk.listening.state import State

from .conftest import Talk, seen

ROWS = [text for text, _ in labelled("responses_rows")]


def test_the_network_and_the_phrases_have_the_same_kinds() -> None:
    network().load()
    assert set(network().labels) == material().responses.keys()


@pytest.mark.parametrize("name", sorted(material().responses))
def test_each_kind_has_enough_replies_and_most_of_them_ask_nothing(name: str) -> None:
    (lines,) = material().responses[name].lines("say")
    assert len(lines) >= 10
    assert sum(not line.asks for line in lines) >= 6
    assert not any(line.roles for line in lines), "a reply fits every utterance of its kind, so it has no gaps"


def test_no_reply_belongs_to_two_kinds() -> None:
    texts = [line.text for kind in material().responses.values() for lines in kind.lines("say") for line in lines]
    assert len(texts) == len(set(texts))


@given(st.text(max_size=200), st.booleans())
def test_the_kinds_come_with_their_probabilities_in_order(text: str, dark: bool) -> None:
    network().load()
    chances = [chance for chance, _ in responses_to(material(), text, dark=dark)]
    assert chances == sorted(chances, reverse=True)
    assert sum(chances) <= 1.001 and all(chance >= LEAST for chance in chances)


@given(st.sampled_from(ROWS))
def test_a_dark_utterance_gets_no_light_reply(text: str) -> None:
    network().load()
    assert not any(kind.tone in LIGHT for _, kind in responses_to(material(), text, dark=True))


@given(st.sampled_from(ROWS))
def test_a_sad_conversation_has_a_light_reply_only_to_clear_joy(text: str) -> None:
    hearing = hear(material(), Heard(text, seen(text)), State(tone="sad", turns=2))
    assert "rejoice" in hearing.moves or not any(kind.tone in LIGHT for _, kind in hearing.responses)


def test_a_user_who_wants_no_questions_is_asked_none(talk: Talk) -> None:
    talk.say("stop asking me questions")
    assert not talk.state.asks
    said = [talk.say(text) for text in ROWS[:12] if "?" not in text]
    assert not any(answer.endswith("?") for answer in said)


def test_the_replies_of_a_kind_take_turns() -> None:
    (lines,) = material().responses["laughs"].lines("say")
    talk, texts = Talk(), {line.text for line in lines}
    said = [talk.say("haha " * (1 + number % 3)) for number in range(len(lines))]
    found = [answer for answer in said if answer in texts]
    assert len(found) >= 4
    assert len(set(found)) == len(found)


def test_a_reply_that_the_user_has_rejected_is_not_said_again(talk: Talk) -> None:
    hearing = hear(material(), Heard("haha", seen("haha")), talk.state)
    (first, *_) = [kind for _, kind in hearing.responses]
    hearing.leave_out(first.name, "")
    assert first not in [kind for _, kind in hearing.responses]
