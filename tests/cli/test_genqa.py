"""``ravestate genqa`` indexes documents and answers questions. A bad file gives a message, not a traceback."""

import json
import sqlite3
from pathlib import Path

import pytest

from cli.examples import call
from ravestate.modules.skill.genqa import collecting


@pytest.fixture
def docs(folder: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A folder with two documents. The index goes into a data folder for this test."""
    monkeypatch.setattr("sys.platform", "linux")
    monkeypatch.setenv("XDG_DATA_HOME", str(folder / "data"))
    monkeypatch.delenv("RAVESTATE_GENQA_INDEX", raising=False)
    docs = folder / "docs"
    docs.mkdir()
    (docs / "engine.txt").write_text("The Zorbex engine was invented by Mira Kolm in 1987.", encoding="utf-8")
    (docs / "tram.md").write_text("# Tram 7\n\nIt runs every ten minutes.", encoding="utf-8")
    return docs


def test_documents_can_be_indexed_listed_and_forgotten(docs: Path, capsys: pytest.CaptureFixture[str]) -> None:
    code, out, errors = call(capsys, "genqa", "index", "docs")
    assert (code, errors) == (0, "")
    assert out == f"2 added; 2 new passages in {docs.parent / 'data' / 'ravestate' / 'genqa.sqlite'}\n"
    assert call(capsys, "genqa", "index", "docs")[1].startswith("2 unchanged; 0 new passages")
    code, out, _ = call(capsys, "genqa", "list")
    assert code == 0
    assert [line.split() for line in out.splitlines()][:2] == [
        ["1", "passages", str(docs / "engine.txt")],
        ["1", "passages", str(docs / "tram.md")],
    ]
    assert call(capsys, "genqa", "forget", "docs/tram.md")[:2] == (0, "forgot docs/tram.md: 1 file\n")
    code, _, errors = call(capsys, "genqa", "forget", "docs/tram.md")
    assert code == 1
    assert "nothing was read from docs/tram.md" in errors


def test_the_action_ask_shows_the_answer_with_its_source_confidence_and_candidates(
    docs: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    call(capsys, "genqa", "index", "docs")
    code, out, _ = call(capsys, "genqa", "ask", "Who invented the Zorbex engine?")
    assert code == 0
    lines = out.splitlines()
    assert lines[0] == "The Zorbex engine was invented by Mira Kolm in 1987."
    assert lines[1].split() == ["source", "docs/engine.txt"]
    assert "(sure; the agent is sure from 0.7, unsure from 0.5)" in lines[2]
    assert lines[4].split()[1] == "100%"


def test_the_action_ask_works_without_quotation_marks_and_without_documents(
    docs: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert call(capsys, "genqa", "ask", "what", "is", "the", "capital", "of", "Peru")[1].startswith(
        "The capital of Peru is Lima."
    )


def test_the_action_ask_says_why_there_is_no_answer(docs: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert call(capsys, "genqa", "ask", "How are you?")[:2] == (
        0,
        "no answer: it is about the user or the agent\n",
    )


def test_a_message_names_an_unreadable_file_and_the_exit_code_is_1(
    docs: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (docs / "latin.txt").write_bytes(b"caf\xe9")
    (docs / "broken.pdf").write_bytes(b"%PDF-1.4")
    code, out, errors = call(capsys, "genqa", "index", "docs", "nowhere")
    assert code == 1
    assert out.startswith("3 unreadable, 2 added; 2 new passages")
    assert f"ravestate genqa: {docs / 'latin.txt'}: it is not UTF-8 (byte 3)" in errors
    assert f"ravestate genqa: {docs / 'broken.pdf'}: it is not a PDF, or damaged" in errors
    assert "nowhere: it does not exist" in errors


def test_an_interrupted_command_says_how_to_continue(
    docs: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    read = collecting.read

    def interrupted(path: Path, source: str) -> object:
        if path.name == "tram.md":
            raise KeyboardInterrupt
        return read(path, source)

    monkeypatch.setattr(collecting, "read", interrupted)
    code, _, errors = call(capsys, "genqa", "index", "docs")
    assert code == 130
    assert "interrupted: to continue, run the same command again" in errors
    monkeypatch.undo()
    monkeypatch.setattr("sys.platform", "linux")
    monkeypatch.setenv("XDG_DATA_HOME", str(docs.parent / "data"))
    monkeypatch.chdir(docs.parent)
    assert call(capsys, "genqa", "index", "docs")[1].startswith("1 unchanged, 1 added")


def test_an_option_or_a_variable_names_the_index_file(
    docs: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    call(capsys, "genqa", "--index", "my.sqlite", "index", "docs")
    assert (docs.parent / "my.sqlite").exists()
    monkeypatch.setenv("RAVESTATE_GENQA_INDEX", str(docs.parent / "my.sqlite"))
    assert "engine.txt" in call(capsys, "genqa", "list")[1]


def test_the_option_for_the_index_can_also_follow_the_action(docs: Path, capsys: pytest.CaptureFixture[str]) -> None:
    call(capsys, "genqa", "index", "docs", "--index", "my.sqlite")
    assert (docs.parent / "my.sqlite").exists()
    before = call(capsys, "genqa", "--index", "my.sqlite", "list")
    assert "engine.txt" in before[1] and call(capsys, "genqa", "list", "--index", "my.sqlite") == before
    assert call(capsys, "genqa", "--index", "none.sqlite", "list", "--index", "my.sqlite") == before
    assert call(capsys, "genqa", "forget", "docs", "--index", "my.sqlite")[0] == 0
    assert call(capsys, "genqa", "ask", "Who invented the Zorbex engine?", "--index", "my.sqlite")[0] == 0


@pytest.mark.parametrize(
    "action", [["list"], ["index", "docs"], ["forget", "docs"], ["ask", "What is the capital of Peru?"]]
)
def test_a_file_that_is_not_an_index_is_refused_with_a_message(
    docs: Path, capsys: pytest.CaptureFixture[str], action: list[str]
) -> None:
    (docs / "index.txt").write_text("This is a letter and no index of anything.", encoding="utf-8")
    code, _, errors = call(capsys, "genqa", "--index", str(docs / "index.txt"), *action)
    assert code == 1
    assert errors.startswith(f"ravestate genqa: the index {docs / 'index.txt'}: it is not an index, or damaged")
    assert "--index /path/to/index.sqlite" in errors


def test_an_index_of_a_newer_version_is_refused_with_a_message(docs: Path, capsys: pytest.CaptureFixture[str]) -> None:
    call(capsys, "genqa", "--index", "my.sqlite", "index", "docs")
    base = sqlite3.connect("my.sqlite")
    base.execute("PRAGMA user_version = 99")
    base.close()
    code, _, errors = call(capsys, "genqa", "--index", "my.sqlite", "list")
    assert code == 1
    assert "written by a newer Ravestate (format 99" in errors


def test_the_action_list_without_documents_is_not_an_error(docs: Path, capsys: pytest.CaptureFixture[str]) -> None:
    code, out, _ = call(capsys, "genqa", "list")
    assert code == 0
    assert out.startswith("nothing has been read yet: to read files into")


@pytest.mark.parametrize("arguments", [[], ["index"], ["forget"], ["ask"], ["ask", " "], ["eat"], ["--index"]])
def test_wrong_use_has_exit_code_2(docs: Path, capsys: pytest.CaptureFixture[str], arguments: list[str]) -> None:
    assert call(capsys, "genqa", *arguments)[0] == 2


def test_control_codes_in_a_document_do_not_reach_the_terminal(docs: Path, capsys: pytest.CaptureFixture[str]) -> None:
    evil = {
        "title": "\x1b]0;evil\x07Zorbex",
        "text": "The \x1b[2JZorbex pump was built by Anna Berg.",
        "source": "\x1b[31mred",
    }
    (docs / "evil.jsonl").write_text(json.dumps(evil), encoding="utf-8")
    (docs / "\x1b[2Jx.txt").write_bytes(b"\xff")
    _, _, errors = call(capsys, "genqa", "index", "docs")
    _, out, _ = call(capsys, "genqa", "ask", "Who built the Zorbex pump?")
    assert out.startswith("The Zorbex pump was built by Anna Berg.\n  source      red\n")
    assert "\x1b" not in out + errors
