"""``ravestate nlp`` prints the analysis of a text."""

import io
import json
import subprocess
import sys
from pathlib import Path

import pytest

from cli.examples import call

Capture = pytest.CaptureFixture[str]


def test_the_analysis_is_printed_as_a_table(capsys: Capture) -> None:
    code, out, errors = call(capsys, "nlp", "Where do you live? I live in Berlin.")
    assert (code, errors) == (0, "")
    lines = out.splitlines()
    assert lines[0].split() == ["TOKEN", "LEMMA", "POS", "TAG", "DEP", "HEAD"]
    assert lines[3].split() == ["you", "you", "PRON", "PRP", "nsubj", "live"]
    facts = dict(line.split(None, 1) for line in lines[lines.index("") + 1 :])
    assert facts == {
        "normal": "Where do you live? I live in Berlin.",
        "acts": "-",
        "feelings": "-",
        "entities": "Berlin (GPE)",
        "triples": "(you, live, PLACE) (I, live, Berlin)",
        "yes/no": "-",
        "question": "PLACE",
        "signals": "is_question, about_agent",
    }


@pytest.mark.parametrize(
    ("text", "shown"),
    [("yes", "yes, surely"), ("probably not", "no, weakly"), ("no idea", "unsure"), ("I swim", "-")],
)
def test_an_answer_of_the_user_is_described_in_words(text: str, shown: str, capsys: Capture) -> None:
    _, out, _ = call(capsys, "nlp", text)
    assert f"yes/no    {shown}\n" in out


def test_the_normal_form_acts_and_feelings_are_shown(capsys: Capture) -> None:
    _, out, _ = call(capsys, "nlp", "thx! my mother is ill")
    assert "normal    Thanks! My mother is ill.\n" in out
    assert "acts      thanks 0." in out or "acts      thanks 1." in out
    assert "illness" in out


def test_the_scores_of_the_intents_of_a_module_are_shown(capsys: Capture, tmp_path: Path) -> None:
    file = tmp_path / "cafe.py"
    file.write_text(
        "import ravestate as rs\nfrom ravestate.modules import nlp\nmodule = rs.Module('cafe', requires=[nlp])\n"
        "nlp.intent(module, 'hours', examples=['when do you open', 'how late are you open'])\n"
        "nlp.intent(module, 'table', examples=['I would like to book a table', 'a table for two please'])\n"
    )
    code, out, _ = call(capsys, "nlp", "-m", str(file), "until when are you open")
    assert code == 0
    assert "signals   is_question, about_agent, cafe:hours\n" in out
    assert "\nintents   cafe:hours 0." in out and ", cafe:table 0." in out
    _, out, _ = call(capsys, "nlp", "--json", "-m", str(file), "until when are you open")
    scores = json.loads(out)["intents"]
    assert list(scores) == ["cafe:hours", "cafe:table"] and scores["cafe:hours"] > 0.5 > scores["cafe:table"]


def test_the_command_loads_the_same_networks_as_an_agent() -> None:
    # A process of its own: in this one, other tests may have loaded the networks.
    command = [sys.executable, "-m", "ravestate", "nlp", "at what time do you open"]
    run = subprocess.run(command, capture_output=True, text=True, timeout=60, check=True)
    assert "question  TIME" in run.stdout


def test_a_text_needs_no_quotation_marks(capsys: Capture) -> None:
    code, out, _ = call(capsys, "nlp", "who", "are", "you")
    assert code == 0 and "(you, be, PERSON)" in out


def test_each_line_of_standard_input_becomes_a_line_of_json(capsys: Capture, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("sys.stdin", io.StringIO("Grüße aus Rom!\n\nwho wrote Hamlet\n"))
    code, out, errors = call(capsys, "nlp", "--json")
    assert (code, errors) == (0, "")
    first, second = (json.loads(line) for line in out.splitlines())
    assert first["text"] == "Grüße aus Rom!" and "Grüße" in out
    assert second["triples"] == [[{"asks_for": "PERSON"}, "write", "Hamlet"]]
    assert second["question"] == "PERSON" and second["signals"] == ["is_question"]
    assert second["yesno"] == {"yes": None, "no": None, "unsure": None}
    assert [token["text"] for token in second["tokens"]] == ["who", "wrote", "Hamlet"]


def test_an_option_gives_the_agents_name(capsys: Capture) -> None:
    _, out, _ = call(capsys, "nlp", "--agent-name", "Lina", "lina is here")
    assert "signals   about_agent\n" in out


def test_control_codes_do_not_reach_the_terminal(capsys: Capture) -> None:
    code, out, _ = call(capsys, "nlp", "\x1b[31mred\udcff")
    assert code == 0 and "\x1b" not in out and "red" in out


def test_an_unknown_pipeline_gives_a_message(capsys: Capture) -> None:
    code, out, errors = call(capsys, "nlp", "--pipeline", "nonsense", "hello")
    assert (code, out) == (1, "") and "there is no spaCy pipeline 'nonsense'" in errors


def test_on_a_terminal_nlp_says_how_to_begin_and_end(capsys: Capture, monkeypatch: pytest.MonkeyPatch) -> None:
    class Terminal(io.StringIO):
        def isatty(self) -> bool:
            return True

    monkeypatch.setattr(sys, "stdin", Terminal(""))
    assert call(capsys, "nlp") == (0, "", "Type a text; Ctrl-D ends.\n")
