"""Agent files: which folder a path refers to, and which source of a setting wins."""

import sys
from pathlib import Path

import pytest

from cli.examples import call, write
from ravestate.errors import UsageError
from ravestate.loading import spec
from ravestate.settings import load_settings

Capture = pytest.CaptureFixture[str]

PATHS = """
    from pathlib import Path
    from typing import Annotated
    import pydantic, ravestate as rs
    from ravestate.settings import NameOrPath

    class Part(pydantic.BaseModel):
        sound: Path

    class Settings(rs.Settings):
        file: Path | None = pydantic.Field(None, alias="datei")
        files: tuple[Path, ...] = ()
        named: dict[str, Annotated[Path, pydantic.Field()]] = {}
        parts: list[Part] = []
        device: NameOrPath = "default"
        other: NameOrPath | None = None
        text: str = ""

    module = rs.Module("paths", settings=Settings)
"""


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """An empty folder, which is the working folder."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(sys, "path", list(sys.path))
    return tmp_path


def test_a_relative_path_in_an_agent_file_is_relative_to_the_file(
    folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    write(folder / "paths.py", PATHS)
    write(folder / "sub" / "in.wav", "")
    agent = """
        modules: [../paths.py]
        settings:
          paths:
            file: a.yaml
            files: [b.yaml, /c.yaml, ~/d.yaml]
            named: {b.yaml: b.yaml}
            parts: [{sound: e.wav}]
            device: in.wav
            other: ./out.wav
            text: in.wav
    """
    monkeypatch.setenv("HOME", "/home/user")
    read = spec.AgentSpec.from_file(write(folder / "sub" / "agent.yaml", agent))
    at = folder / "sub"
    assert load_settings(read.modules, read.settings)["paths"].model_dump() == {
        "file": at / "a.yaml",
        "files": (at / "b.yaml", Path("/c.yaml"), Path("/home/user/d.yaml")),
        "named": {"b.yaml": at / "b.yaml"},
        "parts": [{"sound": at / "e.wav"}],
        "device": str(at / "in.wav"),
        "other": f"{at}/./out.wav",
        "text": "in.wav",
    }


def test_a_name_in_an_agent_file_stays_a_name(folder: Path) -> None:
    write(folder / "paths.py", PATHS)
    (folder / "sub" / "default").mkdir(parents=True)
    agent = "modules: [../paths.py]\nsettings: {paths: {device: default, other: hw/0.wav}}"
    read = spec.AgentSpec.from_file(write(folder / "sub" / "agent.yaml", agent))
    assert read.settings == {"paths": {"device": "default", "other": "hw/0.wav"}}


def test_a_path_from_the_command_line_or_the_environment_is_relative_to_the_working_folder(
    folder: Path, capsys: Capture, monkeypatch: pytest.MonkeyPatch
) -> None:
    write(folder / "life.yaml", "facts: {name: Ada}")
    write(folder / "sub" / "robin.yaml", "facts: {name: Robin}")
    write(folder / "sub" / "agent.yaml", "modules: [agentqa]\nsettings: {agentqa: {life: robin.yaml}}")

    def check(*more: str) -> tuple[int, str]:
        code, out, errors = call(capsys, "check", "sub/agent.yaml", *more)
        return code, out + errors

    assert check()[0] == 0
    assert check("--set", "agentqa.life=life.yaml")[0] == 0
    code, out = check("--set", "agentqa.life=robin.yaml")
    assert code == 2 and "file 'robin.yaml' does not exist" in out
    monkeypatch.setenv("RAVESTATE_AGENTQA_LIFE", "life.yaml")
    assert check()[0] == 0


def test_an_empty_text_in_an_agent_file_stays_empty(folder: Path) -> None:
    write(folder / "paths.py", PATHS)
    agent = "modules: [../paths.py]\nsettings: {paths: {file: '', files: [''], device: ''}}"
    read = spec.AgentSpec.from_file(write(folder / "sub" / "agent.yaml", agent))
    assert read.settings == {"paths": {"file": "", "files": [""], "device": ""}}


def test_a_field_that_a_file_gives_by_its_name_and_its_alias_is_reported(folder: Path) -> None:
    write(folder / "paths.py", PATHS)
    agent = "modules: [./paths.py]\nsettings: {paths: {datei: a.yaml, file: b.yaml}}"
    file = write(folder / "agent.yaml", agent)
    with pytest.raises(UsageError) as caught:
        spec.AgentSpec.from_file(file)
    assert str(caught.value) == f"{file}: setting paths.file is given twice, as 'datei' and as 'file': write it once"


def test_a_later_file_may_give_a_field_by_another_name(folder: Path) -> None:
    write(folder / "paths.py", PATHS)
    read = spec.AgentSpec()
    names = read.read(write(folder / "a.yaml", "modules: [./paths.py]\nsettings: {paths: {datei: a.txt}}"))
    read.load(names + read.read(write(folder / "b.yaml", "settings: {paths: {file: b.txt}}")))
    read.check()
    assert read.settings == {"paths": {"file": str(folder / "b.txt")}}


@pytest.mark.parametrize("key", ["file", "datei"])
def test_an_alias_in_an_agent_file_has_no_precedence_over_other_sources(
    key: str, folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    write(folder / "paths.py", PATHS)
    write(folder / "agent.yaml", "modules: [./paths.py]\nsettings: {paths: {datei: a.yaml}}")
    read = spec.AgentSpec.from_file(folder / "agent.yaml")
    read.set(f"paths.{key}=b.yaml")
    assert read.settings == {"paths": {"file": "b.yaml"}}
    monkeypatch.setenv("RAVESTATE_PATHS_FILE", "c.yaml")
    assert spec.AgentSpec.from_file(folder / "agent.yaml").settings == {"paths": {}}
