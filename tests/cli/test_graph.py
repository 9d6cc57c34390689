"""``ravestate graph``: the diagram as SVG, DOT or Mermaid, on standard output or in a file."""

import xml.etree.ElementTree as ElementTree
from pathlib import Path

import pytest

from cli.examples import HELLO, call, write

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
def test_text_formats(hello: str, capsys: Capture, format: str, begins: str) -> None:
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
def test_a_file_s_name_tells_its_format(
    hello: str, folder: Path, capsys: Capture, name: str, begins: str
) -> None:
    assert call(capsys, "graph", hello, "-o", name) == (0, f"wrote {name}\n", "")
    assert (folder / name).read_text(encoding="utf-8").startswith(begins)


def test_a_format_goes_before_a_name(hello: str, folder: Path, capsys: Capture) -> None:
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
    ],
)
def test_wrong_use_is_2_and_writes_nothing(
    hello: str, folder: Path, capsys: Capture, arguments: tuple[str, ...], text: str
) -> None:
    code, out, errors = call(capsys, "graph", hello, *arguments)
    assert (code, out) == (2, "") and text in errors
    assert {path.name for path in folder.iterdir()} <= {"hello.py", "__pycache__"}


def test_faults_are_1(folder: Path, capsys: Capture) -> None:
    write(
        folder / "faulty.py",
        "import ravestate as rs\nmodule = rs.Module('m')\nmodule.signal('a')\nmodule.signal('a')\n",
    )
    code, _, errors = call(capsys, "graph", "./faulty.py")
    assert code == 1 and "two signals are named 'm:a'" in errors
