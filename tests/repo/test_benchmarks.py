"""The benchmarks can be imported, and their tables and pictures fit into the pages."""

from __future__ import annotations

import asyncio
from importlib import import_module
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import pytest

from ravestate.cli.complete import COMPLETE

ROOT = Path(__file__).parents[2]
SVG = "{http://www.w3.org/2000/svg}"
QUESTIONS = sorted(file.stem for file in (ROOT / "benchmarks" / "questions").glob("[!_]*.py"))


@pytest.mark.parametrize("question", QUESTIONS)
def test_each_benchmark_can_be_imported(question: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.syspath_prepend(str(ROOT))
    asked = import_module(f"benchmarks.questions.{question}")
    assert callable(asked.ask)
    assert question in import_module("benchmarks.questions").QUESTIONS


def test_the_agent_of_the_benchmark_web_users_has_the_modules_of_the_text_agent_without_small_talk(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.syspath_prepend(str(ROOT))
    web_users = import_module("benchmarks.questions.web_users")
    agents: list[list[str]] = []

    class Stop(Exception):
        pass

    def server(agent: Any) -> None:
        agents.append([module.name for module in agent.policy.modules])
        raise Stop

    monkeypatch.setattr("ravestate.modules.platform.webio.server.Server", server)
    with pytest.raises(Stop):
        asyncio.run(web_users.serve_agent(print))
    [names] = agents
    assert set(COMPLETE) - {"wildtalk"} <= set(names)
    assert sorted(set(names) - set(COMPLETE)) == ["core", "rawio", "stand_in", "webio"]


def test_a_page_gets_only_the_tables_for_which_it_has_a_place(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
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


def test_the_picture_of_a_comparison_has_a_bar_for_each_compared_library(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.syspath_prepend(str(ROOT))
    compare, plot = import_module("benchmarks.figures").compare, import_module("benchmarks.plot").plot
    times = {"one": 2e-3, "other": 3e-5, "slow & steady": 0.4, "floor: 2 callbacks": 6e-6}
    found = [compare("answer", "k=1", [1e-5], name, [seconds]) for name, seconds in times.items()]
    picture = ElementTree.fromstring(plot([*found, compare("answer", "alone", [1.0], "one", [2.0])]))
    bars = {bar.get("class"): float(bar.get("width", 0)) for bar in picture.iter(f"{SVG}rect") if bar.get("x")}
    assert sorted(bars) == ["floor", "ours", "theirs"] and bars["floor"] < bars["ours"] < bars["theirs"]
    words = [text.text for text in picture.iter(f"{SVG}text")]
    assert [word for word in words if word in {"floor", "Ravestate", *times}] == [
        "floor", "Ravestate", "other", "one", "slow & steady",
    ]  # fmt: skip  # the shortest time first
    assert "400 ms" in words and "alone" not in words


def test_the_sentences_for_development_can_be_measured(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.syspath_prepend(str(ROOT))
    development, voice = import_module("benchmarks.peers.development"), import_module("benchmarks.questions.voice")
    asked: list[object] = []

    def ends_of_turns(*arguments: object) -> tuple[float, float, int]:
        asked.extend(arguments)
        return 0.025, 0.1, 40

    monkeypatch.setattr(voice, "ends_of_turns", ends_of_turns)
    development.main("base")
    assert asked == ["base", 40, development.OPEN, development.COMPLETE]
    assert capsys.readouterr().out == "base: 2.5% false cuts of 40 pauses, 10.0% missed ends of 40 sentences\n"
