"""``ravestate new``: the new project runs and its tests pass; wrong names are refused."""

import os
import shlex
import subprocess
import sys
from pathlib import Path

import pytest

from cli.examples import call, complaints
from ravestate.yaml_text import load_yaml

Capture = pytest.CaptureFixture[str]


def files(folder: Path) -> set[str]:
    return {str(path.relative_to(folder)) for path in folder.rglob("*") if path.is_file()}


@pytest.fixture(autouse=True)
def activated(monkeypatch: pytest.MonkeyPatch) -> None:
    """Put the commands of this environment on ``PATH``."""
    monkeypatch.setenv("PATH", f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}")


def test_a_new_project_runs_and_its_tests_pass(folder: Path, capsys: Capture) -> None:
    code, out, errors = call(capsys, "new", "my-agent")
    assert (code, errors) == (0, "")
    made = folder / "my-agent"
    assert files(made) == {
        "README.md",
        "agent.yaml",
        "pyproject.toml",
        "my_agent.py",
        "tests/test_my_agent.py",
    }
    assert all(f"wrote {Path('my-agent') / name}" in out for name in files(made))
    assert out.endswith(
        "\nNow:\n  cd my-agent\n  ravestate run agent.yaml\n  python -m pip install pytest\n  python -m pytest\n"
    )
    for name in files(made):
        text = (made / name).read_text(encoding="utf-8")
        assert "__name__" not in text and "__package__" not in text

    environment = {k: v for k, v in os.environ.items() if not k.startswith("PYTEST")}
    tests = subprocess.run(
        [sys.executable, "-m", "pytest", "-q", "-p", "no:cacheprovider"],
        cwd=made, capture_output=True, text=True, timeout=120, check=False, env=environment,
    )  # fmt: skip
    assert tests.returncode == 0, tests.stdout + tests.stderr
    assert "4 passed" in tests.stdout

    run = subprocess.run(
        [Path(sys.executable).parent / "ravestate", "run", "agent.yaml"],
        cwd=made, input="My name is Grace.\n", capture_output=True, text=True, timeout=60, check=False,
    )  # fmt: skip
    assert (run.returncode, complaints(run.stderr)) == (0, "")
    assert "Nice to meet you, Grace! I am Ada." in run.stdout

    assert call(capsys, "check", "my-agent/agent.yaml")[0] == 0


def test_the_printed_next_steps_name_the_commands_of_this_environment(
    folder: Path, capsys: Capture, monkeypatch: pytest.MonkeyPatch
) -> None:
    assert "\n  cd '1 bad/my-agent'\n" in call(capsys, "new", "1 bad/my-agent")[1]
    monkeypatch.setenv("PATH", str(folder))
    for name in ("nobodys", "others"):
        for line in call(capsys, "new", name)[1].splitlines()[-3:]:
            command = Path(shlex.split(line)[0])
            assert command.parent == Path(sys.executable).parent and command.exists()
        for command in ("python", "ravestate"):  # commands of another installation
            (folder / command).touch(mode=0o755)


def test_a_new_nested_folder_and_an_existing_empty_folder_are_accepted(folder: Path, capsys: Capture) -> None:
    (folder / "empty").mkdir()
    assert call(capsys, "new", "empty")[0] == 0
    assert call(capsys, "new", "some/where/Robot7")[0] == 0
    assert (folder / "some" / "where" / "Robot7" / "robot7.py").is_file()


@pytest.mark.parametrize("name", ["", ".", "..", "two words", "1st", "-x-y", "ä", "a/b c", "a.b", "a-", "a_"])
def test_an_invalid_name_is_refused(name: str, folder: Path, capsys: Capture) -> None:
    code, out, errors = call(capsys, "new", "--", name)
    assert (code, out) == (2, "")
    assert "is not a name for a project: use letters, digits, '-' and '_', e.g. my-agent" in errors
    assert list(folder.iterdir()) == []


@pytest.mark.parametrize("name", ["json", "test", "tests", "ravestate", "core", "idle", "rawio", "Asyncio", "yaml"])
def test_names_of_other_modules_are_refused(name: str, folder: Path, capsys: Capture) -> None:
    code, out, errors = call(capsys, "new", name)
    assert (code, out) == (2, "")
    assert f"a module named {name.lower()!r} exists already: choose another name, e.g. my-{name}" in errors
    assert list(folder.iterdir()) == []


def test_existing_files_are_not_overwritten(folder: Path, capsys: Capture) -> None:
    (folder / "taken").mkdir()
    (folder / "taken" / "precious.txt").write_text("mine", encoding="utf-8")
    (folder / "file").write_text("mine", encoding="utf-8")
    for name in ("taken", "file"):
        code, out, errors = call(capsys, "new", name)
        assert (code, out, errors) == (2, "", f"ravestate new: {name} exists already, and is not empty\n")
    assert files(folder) == {"taken/precious.txt", "file"}


def test_a_folder_that_cannot_be_written_gives_a_message(folder: Path, capsys: Capture) -> None:
    (folder / "file").write_text("", encoding="utf-8")
    code, _, errors = call(capsys, "new", "file/agent")
    assert code == 2 and errors.startswith("ravestate new: cannot write file/agent/README.md: ")
    code, _, errors = call(capsys, "new", "x" * 300)
    assert code == 2 and errors.startswith("ravestate new: cannot write xxx") and errors.endswith("too long\n")


@pytest.mark.parametrize("name", ["class", "import"])
def test_a_python_keyword_is_refused_as_a_name(name: str, folder: Path, capsys: Capture) -> None:
    code, _, errors = call(capsys, "new", name)
    assert code == 2 and f"{name!r} is a Python keyword" in errors
    assert list(folder.iterdir()) == []


def test_a_name_that_yaml_reads_as_a_boolean_is_accepted(folder: Path, capsys: Capture) -> None:
    assert call(capsys, "new", "yes")[0] == 0
    text = (folder / "yes" / "agent.yaml").read_text(encoding="utf-8")
    assert "yes" in load_yaml(text, "agent.yaml")["settings"]
