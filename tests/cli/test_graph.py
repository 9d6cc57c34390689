"""``ravestate graph``: the diagram as SVG, DOT or Mermaid, on standard output or in a file."""

import re
import sys
import xml.etree.ElementTree as ElementTree
from pathlib import Path

import pytest

from cli.examples import HELLO, call, write
from ravestate.cli.complete import COMPLETE
from ravestate.draw.build import build
from ravestate.draw.fold import fold
from ravestate.draw.svg import svg
from ravestate.loading.modules import load_module
from ravestate.policy.compile import compile_policy

Capture = pytest.CaptureFixture[str]


@pytest.fixture
def hello(folder: Path) -> str:
    write(folder / "hello.py", HELLO)
    return "./hello.py"


def test_svg_is_the_default(hello: str, capsys: Capture) -> None:
    code, out, _ = call(capsys, "graph", hello)
    assert code == 0
    assert ElementTree.fromstring(out).tag.endswith("svg") and "greet" in out
    assert call(capsys, "graph", hello, "--format", "svg")[1] == out


@pytest.mark.parametrize(("format", "begins"), [("dot", "digraph"), ("mermaid", "flowchart")])
def test_dot_and_mermaid_diagrams_are_printed(hello: str, capsys: Capture, format: str, begins: str) -> None:
    code, out, _ = call(capsys, "graph", hello, "--format", format)
    assert code == 0 and out.startswith(begins) and "greet" in out


@pytest.mark.parametrize(
    ("name", "begins"),
    [
        ("a.svg", "<"),
        ("a.dot", "digraph"),
        ("a.gv", "digraph"),
        ("a.mmd", "flowchart"),
        ("a.mermaid", "flowchart"),
    ],
)
def test_the_suffix_of_the_file_decides_the_format(
    hello: str, folder: Path, capsys: Capture, name: str, begins: str
) -> None:
    assert call(capsys, "graph", hello, "-o", name) == (0, f"wrote {name}\n", "")
    assert (folder / name).read_text(encoding="utf-8").startswith(begins)


def test_the_option_format_overrides_the_suffix_of_the_file(hello: str, folder: Path, capsys: Capture) -> None:
    assert call(capsys, "graph", hello, "-o", "a.txt", "--format", "dot")[0] == 0
    assert (folder / "a.txt").read_text(encoding="utf-8").startswith("digraph")


@pytest.mark.parametrize(
    ("arguments", "text"),
    [
        (
            ("-o", "a.png"),
            "cannot tell the format of a.png: end its name in .svg, .dot, .gv, .mmd, .mermaid, or write",
        ),
        (("-o", "a"), "cannot tell the format of a:"),
        (("-o", "no/such/a.svg"), "cannot write no/such/a.svg: No such file or directory"),
        (("--format", "png"), "invalid choice: 'png'"),
        (("--without", "nlp"), "--without works only on the complete agent: name no MODULE or file with it"),
        (("--unfold", "helo"), "--unfold helo: the agent has no such module; did you mean 'hello'?"),
        (("--unfold", "hello", "--no-fold"), "and --no-fold folds no module: use only one of them"),
    ],
)
def test_wrong_use_gives_exit_code_2_and_writes_nothing(
    hello: str, folder: Path, capsys: Capture, arguments: tuple[str, ...], text: str
) -> None:
    code, out, errors = call(capsys, "graph", hello, *arguments)
    assert (code, out) == (2, "") and text in errors
    assert {path.name for path in folder.iterdir()} <= {"hello.py", "__pycache__"}


@pytest.fixture(scope="module")
def complete_agent() -> str:
    """The SVG diagram of the complete agent, with each module folded."""
    policy = compile_policy(*(load_module(name) for name in ("conio", *COMPLETE)))
    return svg(fold(build(policy.rules.values())))


def test_without_modules_graph_draws_the_complete_agent_with_folded_modules(
    complete_agent: str, capsys: Capture
) -> None:
    code, out, errors = call(capsys, "graph")
    assert (code, out) == (0, f"{complete_agent}\n")
    assert re.fullmatch(
        r"ravestate graph: folded \d+ rules into their modules: --unfold MODULE draws the rules of one module, "
        r"and --no-fold draws all rules\n",
        errors,
    )
    assert all(f">module {name} (" in out for name in ("conio", *COMPLETE))


def test_the_folded_picture_of_the_complete_agent_fits_a_screen(complete_agent: str) -> None:
    root = ElementTree.fromstring(complete_agent.encode())
    assert float(root.attrib["width"]) <= 1400 and float(root.attrib["height"]) <= 700


def test_modules_can_be_left_out_of_the_complete_agent(capsys: Capture) -> None:
    out = call(capsys, "graph", "--without", "emotion", "--format", "dot")[1]
    assert "wildtalk" in out and "emotion" not in out


def test_some_or_all_modules_can_be_unfolded(capsys: Capture) -> None:
    code, out, errors = call(capsys, "graph", "--unfold", "hibye", "--format", "mermaid")
    assert (code, errors) == (0, "")
    assert '["hibye<br/>answer#95;hello' in out.replace("_", "#95;") and re.search(r"wildtalk<br/>\d+ rules", out)
    whole = call(capsys, "graph", "--no-fold", "--format", "mermaid")
    assert whole[2] == "" and "wildtalk<br/>chat" in whole[1] and not re.search(r"<br/>\d+ rules", whole[1])


def test_the_option_fold_folds_a_small_agent(hello: str, capsys: Capture) -> None:
    assert "1 rule)" in call(capsys, "graph", hello, "--fold")[1]


def test_graph_draws_an_agent_file(hello: str, folder: Path, capsys: Capture) -> None:
    write(folder / "agent.yaml", "modules: [./hello.py]")
    for arguments in (("agent.yaml",), ("-f", "agent.yaml")):
        assert call(capsys, "graph", *arguments)[1] == call(capsys, "graph", hello)[1]


def test_slots_that_no_rule_reads_or_writes_are_left_out(folder: Path, capsys: Capture) -> None:
    write(folder / "slots.py", HELLO + "\n    spare = hello.slot('spare')\n")
    out = call(capsys, "graph", "./slots.py", "rawio")[1]
    assert "hello:said" in out and "spare" not in out and "rawio" not in out


def test_faults_give_exit_code_1(folder: Path, capsys: Capture) -> None:
    write(
        folder / "faulty.py",
        "import ravestate as rs\nmodule = rs.Module('m')\nmodule.signal('a')\nmodule.signal('a')\n",
    )
    code, _, errors = call(capsys, "graph", "./faulty.py")
    assert code == 1 and "two signals are named 'm:a'" in errors


def test_on_a_terminal_graph_asks_for_a_file(capsys: Capture, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sys.stdout, "isatty", lambda: True)
    code, out, errors = call(capsys, "graph", "rawio")
    assert (code, out) == (2, "") and "-o agent.svg" in errors
