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


def test_a_page_gets_the_tables_that_it_has_a_place_for(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.syspath_prepend(str(ROOT))
    figures, table = import_module("benchmarks.figures"), import_module("benchmarks.table")
    page = tmp_path / "page.md"
    page.write_text((ROOT / "docs/reference/speech-figures.md").read_text(encoding="utf-8"), encoding="utf-8")
    for share in (0.5, 0.25):  # a later table replaces the earlier one
        found = [figures.measured("voice", "wrong words", [share], unit="core")]
        table.write_page(page, "Two cores", found)
        assert f"{share:.3%}" in page.read_text(encoding="utf-8")
    assert "50.000%" not in page.read_text(encoding="utf-8") and "Two cores." in page.read_text(encoding="utf-8")
    page.write_text("no place", encoding="utf-8")
    with pytest.raises(ValueError, match="has no comment"):
        table.write_page(page, "Two cores", found)
