"""The benchmarks go with the code that they measure."""

from __future__ import annotations

from importlib import import_module
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
QUESTIONS = sorted(file.stem for file in (ROOT / "benchmarks" / "questions").glob("[!_]*.py"))


@pytest.mark.parametrize("question", QUESTIONS)
def test_a_question_can_be_asked(question: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.syspath_prepend(str(ROOT))
    asked = import_module(f"benchmarks.questions.{question}")
    assert callable(asked.ask)
    assert question in import_module("benchmarks.questions").QUESTIONS
