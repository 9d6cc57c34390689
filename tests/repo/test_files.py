"""Every tracked file is free of registry addresses and local paths. Every source file has a docstring."""

import ast
import re
import subprocess
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
SOURCE = ROOT / "src" / "ravestate"


def kept_files() -> list[Path]:
    """Return the files that git tracks, and new files that it does not ignore."""
    run = subprocess.run(
        ["git", "ls-files", "-z", "--cached", "--others", "--exclude-standard"],
        cwd=ROOT, capture_output=True, text=True, check=False,
    )  # fmt: skip
    if run.returncode != 0:
        pytest.skip("not a git checkout")
    return [file for name in sorted(set(run.stdout.split("\0")) - {""}) if (file := ROOT / name).is_file()]


def lines_matching(pattern: re.Pattern[str], files: list[Path]) -> list[str]:
    found: list[str] = []
    for file in files:
        try:
            text = file.read_text(encoding="utf-8")
        except UnicodeDecodeError:
            continue  # a binary file: a picture, a sound or a model
        found += [
            f"{file.relative_to(ROOT)}:{number}: {hit[0]}"
            for number, line in enumerate(text.splitlines(), start=1)
            if (hit := pattern.search(line))
        ]
    return found


# Written in pieces; otherwise, the test would find this file itself.
REGISTRIES = [
    "pypi" r"\.org",
    "python" r"hosted\.org",
    "npm" r"js\.(org|com)",
    "yarn" r"pkg\.com",
    "deb\\.deb" r"ian\.org",
]


def test_no_file_contains_the_name_of_a_package_registry() -> None:
    """The constraints have names and versions of packages. The machine that installs them chooses the registry."""
    found = lines_matching(re.compile("|".join(REGISTRIES), re.IGNORECASE), kept_files())
    assert not found, "\n".join(found)


def test_no_file_contains_the_path_of_a_folder_of_this_machine() -> None:
    """No file contains the path of this checkout or of a user's home folder."""
    folders = [re.escape(str(place)) for place in (ROOT, Path.home()) if len(place.parts) > 2]
    folders += [r"/(?:home|Users)/(?!user\b|me\b|you\b|runner\b)\w+", r"(?<![\w.])/(?:ro" r"ot|wo" r"rk)/\w"]
    found = lines_matching(re.compile("|".join(folders)), kept_files())
    assert not found, "\n".join(found)


def test_the_constraints_file_has_only_names_and_versions() -> None:
    pin = re.compile(r"#.*|[A-Za-z0-9][A-Za-z0-9._-]*==[A-Za-z0-9.!+]+|")
    lines = (ROOT / "constraints.txt").read_text(encoding="utf-8").splitlines()
    assert [line for line in lines if not pin.fullmatch(line)] == []


def test_every_source_file_has_a_docstring() -> None:
    silent: list[str] = []
    for file in sorted(SOURCE.rglob("*.py")):
        said = ast.get_docstring(ast.parse(file.read_text(encoding="utf-8"))) or ""
        if len(said.strip(" .\n")) < 10:
            silent.append(str(file.relative_to(ROOT)))
    assert not silent, "\n".join(silent)


def test_only_one_function_shortens_texts() -> None:
    """`wording.cut` shortens the texts of messages, so that each shortened text ends in the same way."""
    found = [
        f"{file.relative_to(ROOT)}:{node.lineno}"
        for file in sorted(SOURCE.rglob("*.py"))
        if file != SOURCE / "declare" / "wording.py"
        for node in ast.walk(ast.parse(file.read_text(encoding="utf-8")))
        if isinstance(node, ast.BinOp) and isinstance(node.op, ast.Add)
        if isinstance(node.left, ast.Subscript) and isinstance(node.left.slice, ast.Slice)
        if isinstance(node.right, ast.Constant) and node.right.value in ("…", "...")
    ]
    assert not found, "\n".join(found)


def test_no_test_sleeps_in_real_time() -> None:
    """Tests run in virtual time. A real sleep makes a test slow, and sometimes wrong."""
    tests = [file for file in kept_files() if file.is_relative_to(ROOT / "tests") and file.suffix == ".py"]
    found = lines_matching(re.compile(r"\b(?:time|asyncio)\.sleep\((?!0\))"), tests)
    assert not found, "\n".join(found)


def test_no_file_has_the_marks_of_an_unfinished_merge() -> None:
    marks = re.compile("^(?:<{7}|>{7}) ")
    assert lines_matching(marks, kept_files()) == []
