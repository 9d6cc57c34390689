"""The settings decide where memory is stored, and which types it has."""

import sys
from pathlib import Path

import pydantic
import pytest

import ravestate as rs
from ravestate.modules import ontology
from ravestate.modules.meta.ontology.opening import default_path, open_memory, types_of


def test_the_default_path_is_in_the_data_folder_of_the_operating_system(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    monkeypatch.setenv("HOME", str(tmp_path))
    monkeypatch.setattr(sys, "platform", "linux")
    monkeypatch.setenv("XDG_DATA_HOME", str(tmp_path / "data"))
    assert default_path("rosie") == tmp_path / "data" / "ravestate" / "rosie" / "memory.lbug"
    for unset in ("", "relative"):
        monkeypatch.setenv("XDG_DATA_HOME", unset)
        assert default_path("rosie") == tmp_path / ".local/share/ravestate/rosie/memory.lbug"
    monkeypatch.setattr(sys, "platform", "darwin")
    assert default_path("a") == tmp_path / "Library/Application Support/ravestate/a/memory.lbug"
    monkeypatch.setattr(sys, "platform", "win32")
    monkeypatch.setenv("LOCALAPPDATA", str(tmp_path / "local"))
    assert default_path("a") == tmp_path / "local/ravestate/a/memory.lbug"


def test_each_agent_has_its_own_memory(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setattr(sys, "platform", "linux")
    monkeypatch.setenv("XDG_DATA_HOME", str(tmp_path))
    for agent in ("rosie", "marvin"):
        memory = open_memory(ontology.Settings(agent=agent))
        memory.create("Robot", name=agent).result(60)
        assert memory.place == str(tmp_path.resolve() / "ravestate" / agent / "memory.lbug")
        assert [node["name"] for node in memory.find("Robot").result()] == [agent]
        memory.close().result(60)


@pytest.mark.parametrize("agent", ["", "../other", "a/b", ".", "..", "-"])
def test_an_agents_name_that_is_a_path_is_refused(agent: str) -> None:
    with pytest.raises(pydantic.ValidationError):
        ontology.Settings(agent=agent)


def test_a_tilde_in_the_path_means_the_users_home_folder(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setenv("HOME", str(tmp_path))
    memory = open_memory(ontology.Settings(path=Path("~/m.lbug")))
    memory.opened().result(60)
    memory.close().result(60)
    assert (tmp_path / "m.lbug").is_file()


def test_type_files_are_read_once_and_again_after_a_change(tmp_path: Path) -> None:
    own = tmp_path / "mine.yaml"
    own.write_text("Boat: {is: Thing}")
    settings = ontology.Settings(types=(own,))
    first = types_of(settings)
    assert types_of(ontology.Settings(types=(own,))) is first
    own.write_text("Boat: {is: Thing}\nPort: {is: Place}")
    assert "Port" in types_of(settings)
    assert "Port" not in first


@pytest.mark.parametrize(
    ("text", "why"), [("Person: {has: {x: nmber}}", "did you mean 'number'"), (None, "does not exist")]
)
def test_an_error_in_a_type_file_is_raised_before_anything_runs(tmp_path: Path, text: str | None, why: str) -> None:
    file = tmp_path / "types.yaml"
    if text is not None:
        file.write_text(text)
    with pytest.raises(rs.DeclarationErrors) as caught:
        rs.Context(ontology, settings={"ontology": {"types": [file]}})
    assert why in str(caught.value)
