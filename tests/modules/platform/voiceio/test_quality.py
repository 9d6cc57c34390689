"""Limits for the shares that `benchmarks/questions/voice.py` measures in full."""

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


def test_pauses_are_not_taken_for_ends_nor_ends_for_pauses(voice: Any) -> None:
    cuts, missed, count = voice.ends_of_turns("tiny.en", 6)
    assert count == 6 and cuts <= 0.17 and missed <= 0.17


def test_the_agents_own_voice_is_no_utterance(voice: Any) -> None:
    assert voice.echoes(1) == 0


def test_the_heard_text_of_an_interrupted_story_is_right_within_a_word(voice: Any) -> None:
    delays, _, near = voice.interruptions(1)
    assert len(delays) == 1 and near == 1.0
