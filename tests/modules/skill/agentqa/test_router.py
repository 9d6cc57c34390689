"""The router finds the topic of a question about the agent.

These properties hold for any question. The quality set ``agentqa_asks`` measures how often the router is right.
"""

from __future__ import annotations

import sys
from pathlib import Path

import pytest

from ravestate.errors import PlatformError
from ravestate.language import Encoder
from ravestate.language.matcher import bundled_matcher
from ravestate.modules.skill.agentqa import Life, Match, Router, Topic, read_life
from ravestate.modules.skill.agentqa.router import Miss


def topic(router: Router, text: str, **more: bool) -> str:
    found = router.route(text, **more)
    return found.topic if isinstance(found, Match) else "-"


def test_each_example_question_is_routed_to_its_own_topic(router: Router) -> None:
    for one in router.life.topics.values():
        wrong = [q for q in one.questions if topic(router, q) != one.name]
        assert not wrong, (one.name, wrong)


def test_a_match_has_the_nearest_example_with_a_score_and_a_margin(router: Router) -> None:
    found = router.route("How old are you?")
    assert isinstance(found, Match)
    assert found.question == found.example == "how old are you"
    assert 0.5 < found.score <= 1 and found.margin > 0.3


def test_a_miss_names_the_nearest_topic_and_the_reason_against_it(router: Router) -> None:
    found = router.route("what are you up to this evening")
    assert isinstance(found, Miss)
    assert "the topic nearest to " in found.reason and "but an example that is not about me is nearer (" in found.reason


def test_the_first_sentence_with_a_topic_decides(router: Router) -> None:
    assert topic(router, "What do you mean? I am Tom. How old are you? Where do you live?") == "age"


def test_a_topic_that_the_designer_adds_is_distinguished_from_the_others() -> None:
    life = read_life()
    wheels = Topic("wheels", ("do you have wheels", "how many wheels do you have", "what do you roll on"), ("Three.",))
    router = Router(Life(life.facts, {**life.topics, "wheels": wheels}, life.others))
    assert topic(router, "do you roll on wheels?") == "wheels"
    assert topic(router, "how many friends do you have") == "friends"
    assert topic(router, "how old are you") == "age"


@pytest.mark.parametrize(
    "text", ["", "🙂", "\x00\x1b[31m", "a" * 100_000, "word " * 20_000, "مرحبا كيف حالك", "Il pleut.", "you " * 50_000]
)
def test_nonsense_and_long_texts_are_left_to_other_modules(text: str, router: Router) -> None:
    assert isinstance(router.route(text, question=True), Miss)


def test_an_indirect_question_counts_if_the_utterance_is_a_question(router: Router) -> None:
    assert topic(router, "I have been asking myself for weeks how old you are", question=True) == "age"


def test_without_numpy_only_the_exact_example_questions_are_understood(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("ravestate.language.acts.bundled_matcher", bundled_matcher.__wrapped__)  # not the cached one
    monkeypatch.setitem(sys.modules, "numpy", None)
    router = Router(read_life())
    with pytest.raises(PlatformError, match=r"need numpy: pip install 'ravestate\[sentences\]'"):
        router.load()
    assert isinstance(router.route("what is your name?"), Match)


def test_the_error_about_a_missing_model_names_its_file(tmp_path: Path) -> None:
    router = Router(read_life(), Encoder(tmp_path / "none"))
    with pytest.raises(PlatformError, match=r"model\.onnx"):
        router.route("how old are you")
