"""The replies that suit an utterance. The quality sets ``responses_rows`` and ``responses_grades`` measure them."""

from __future__ import annotations

from dataclasses import replace

import pytest
from hypothesis import given
from hypothesis import strategies as st

from quality.measure import labelled
from ravestate.language.replies import replies
from ravestate.modules.skill.wildtalk.listening import Heard
from ravestate.modules.skill.wildtalk.listening.hearing import hear, likely
from ravestate.modules.skill.wildtalk.listening.material import Material, material
from ravestate.modules.skill.wildtalk.listening.phrases import Line
from ravestate.modules.skill.wildtalk.listening.responses import LIGHT, responses_to
from ravestate.modules.skill.wildtalk.listening.state import State

from .conftest import Talk, lines_of, seen

NEW = Line("Ha, that one is new to me.", frozenset())
ROWS = [text for text, _ in labelled("responses_rows")]


def test_the_network_knows_all_replies_and_no_others() -> None:
    replies().load()
    assert set(replies().labels) == {line.text for kind in material().responses.values() for line in lines_of(kind)}


def test_a_new_reply_has_the_mean_grade_of_its_kind() -> None:
    replies().load()
    phrases = Material()
    kind = phrases.responses["laughs"]
    phrases.responses = {"laughs": replace(kind, groups={"say": (*kind.groups["say"], NEW)})}
    found = {one.line.text: one.grade for one in responses_to(phrases, "hahaha")}
    known = replies().grades("hahaha")
    mean = sum(known[line.text][0] for line in kind.groups["say"]) / len(kind.groups["say"])
    assert found[NEW.text] == pytest.approx(mean)


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
def test_the_replies_come_in_the_order_of_their_ranks(text: str, dark: bool) -> None:
    replies().load()
    found = responses_to(material(), text, without=LIGHT if dark else ())
    ranks = [one.rank for one in found]
    assert ranks == sorted(ranks, reverse=True)
    assert all(0 <= one.grade <= 2 for one in found)


@given(st.sampled_from(ROWS))
def test_a_dark_utterance_gets_no_light_reply(text: str) -> None:
    replies().load()
    assert not any(one.kind.tone in LIGHT for one in responses_to(material(), text, without=LIGHT))


@given(st.sampled_from(ROWS))
def test_a_sad_conversation_has_a_light_reply_only_to_clear_joy(text: str) -> None:
    hearing = hear(material(), Heard(text, seen(text)), State(tone="sad", turns=2))
    tones = {one.kind.tone for one in hearing.responses}
    assert "funny" not in tones
    assert "glad" not in tones or "rejoice" in likely(seen(text))


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
    first = hearing.responses[0]
    hearing.leave_out(first.line.text, "")
    assert first.kind not in [one.kind for one in hearing.responses]
