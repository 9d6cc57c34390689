"""A few conversations must stay within limits. `benchmarks/questions/voice.py` measures many more."""

from __future__ import annotations

from importlib import import_module
from pathlib import Path
from typing import Any

import pytest

ROOT = Path(__file__).parents[4]


@pytest.fixture
def voice(monkeypatch: pytest.MonkeyPatch) -> Any:
    monkeypatch.syspath_prepend(str(ROOT))
    return import_module("benchmarks.questions.voice")


def test_the_agent_rarely_confuses_pauses_with_ends_of_turns(voice: Any) -> None:
    cuts, missed, count = voice.ends_of_turns("tiny.en", 6)
    assert count == 6 and cuts <= 0.17 and missed <= 0.17


def test_the_agent_takes_no_echo_of_its_own_voice_for_an_utterance(voice: Any) -> None:
    assert voice.echoes(1) == 0


def test_the_heard_text_of_an_interrupted_story_is_wrong_by_at_most_one_word(voice: Any) -> None:
    delays, _, near = voice.interruptions(1)
    assert len(delays) == 1 and near == 1.0
