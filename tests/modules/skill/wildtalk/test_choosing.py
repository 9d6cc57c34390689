"""The choice of a backend, on machines with and without models."""

import os
from pathlib import Path
from typing import Any

import pytest

from ravestate.errors import PlatformError
from ravestate.modules.skill.wildtalk import choosing, model_store
from ravestate.modules.skill.wildtalk.choosing import Choice, choose
from ravestate.modules.skill.wildtalk.found_models import FoundModel
from ravestate.modules.skill.wildtalk.local_servers import LocalServer
from ravestate.modules.skill.wildtalk.names import OLLAMA, Settings

HERE = "http://127.0.0.1:1234/v1"


class Machine:
    """The servers, files and packages that the choice finds."""

    def __init__(self, patch: pytest.MonkeyPatch, folder: Path) -> None:
        self.servers: list[LocalServer] = []
        self.models: list[FoundModel] = []
        self.packages = {"xllamacpp", "httpx2"}
        self.asked: list[str] = []
        self.listed: tuple[str, ...] = ()
        patch.setattr(choosing, "_servers", self._servers)
        patch.setattr(choosing, "find_models", self._models)
        patch.setattr(choosing, "chat_models", self._listed)
        patch.setattr(choosing, "find_spec", lambda name: name in self.packages or None)
        patch.setattr(model_store, "folder", lambda: folder)

    def _servers(self) -> list[LocalServer]:
        self.asked.append("ports")
        return self.servers

    def _models(self) -> list[FoundModel]:
        self.asked.append("folders")
        return self.models

    async def _listed(self, base_url: str, key: str, patience: float) -> tuple[str, ...]:
        self.asked.append(f"{base_url} {key}")
        return self.listed


@pytest.fixture
def machine(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> Machine:
    return Machine(monkeypatch, tmp_path)


def chosen(**settings: Any) -> Choice:
    return choose(Settings(**{"search": True, **settings}))


def install(name: str = "qwen2.5-0.5b") -> Path:
    model = model_store.named(name)
    model.path.touch()
    os.truncate(model.path, model.size)
    return model.path


def test_without_a_model_the_listening_skill_is_chosen_and_the_text_says_how_to_get_a_model(machine: Machine) -> None:
    choice = chosen()
    assert choice.settings.backend == "listen"
    assert choice.text.endswith("authored replies. To talk with a language model: ravestate model get")
    machine.packages.remove("xllamacpp")
    assert chosen().text.endswith("pip install 'ravestate[wildtalk]' , then ravestate model get")


def test_a_server_in_the_settings_comes_first(machine: Machine) -> None:
    machine.servers = [LocalServer("Ollama", HERE, ("llama3.2",))]
    choice = chosen(base_url="https://api.example.com/v1", model="big", api_key="k")
    assert (choice.settings.backend, choice.settings.model) == ("openai", "big")
    assert choice.settings.api_key is not None
    assert machine.asked == []
    assert "big (https://api.example.com/v1)" in choice.text


def test_if_the_settings_name_a_server_but_no_model_the_server_lists_its_models(machine: Machine) -> None:
    machine.listed = ("small", "other")
    assert chosen(base_url="http://ada:pw@here/v1", api_key="k").settings.model == "small"
    assert machine.asked == ["http://ada:pw@here/v1 k"]
    assert "pw" not in chosen(base_url="http://ada:pw@here/v1").text
    machine.listed = ()
    assert chosen(base_url="http://here/v1").settings.model == "llama3.2"


def test_the_users_default_model_comes_before_a_server_on_this_machine(machine: Machine) -> None:
    machine.servers = [LocalServer("Ollama", HERE, ("llama3.2",))]
    path = install()
    assert chosen().settings.base_url == HERE  # installed, but not the default
    model_store.set_default("qwen2.5-0.5b")
    choice = chosen()
    assert (choice.settings.backend, choice.settings.model_path) == ("gguf", path)
    assert "0.5 billion" in choice.text
    assert chosen(model="llama3.2").settings.base_url == HERE
    machine.packages.remove("xllamacpp")
    assert chosen().settings.base_url == HERE


def test_a_server_on_this_machine_comes_before_a_model_file_and_gets_no_key(machine: Machine) -> None:
    machine.servers = [LocalServer("LM Studio", HERE, ("qwen", "llama3.2:latest"))]
    machine.models = [FoundModel(Path("/m/a.gguf"), 10**9, 1)]
    choice = chosen(api_key="k")
    assert (choice.settings.backend, choice.settings.base_url, choice.settings.model) == ("openai", HERE, "qwen")
    assert choice.settings.api_key is None
    assert choice.text.startswith(f"small talk by qwen (LM Studio at {HERE})")
    assert chosen(model="llama3.2").settings.model == "llama3.2:latest"
    assert "folders" not in machine.asked


def test_a_model_file_on_this_machine_comes_last(machine: Machine) -> None:
    machine.models = [FoundModel(Path("/m/a.gguf"), 1_540_000_000, 1)]
    choice = chosen()
    assert (choice.settings.backend, choice.settings.model_path) == ("gguf", Path("/m/a.gguf"))
    assert choice.text == "small talk by a.gguf (1.5 billion parameters). Others: ravestate model list"
    machine.packages.remove("xllamacpp")
    assert chosen().settings.backend == "listen"


def test_with_search_off_no_server_and_no_file_is_searched_for(machine: Machine) -> None:
    machine.servers = [LocalServer("Ollama", HERE, ("llama3.2",))]
    machine.models = [FoundModel(Path("/m/a.gguf"), 10**9, 1)]
    assert chosen(search=False).settings.backend == "listen"
    assert chosen(search=False, backend="openai").settings.base_url == OLLAMA
    assert chosen(search=False, base_url="http://here/v1").settings.model == "llama3.2"
    with pytest.raises(PlatformError, match="no chat model in GGUF format on this machine: ravestate model get"):
        chosen(search=False, backend="gguf")
    assert machine.asked == []


def test_a_file_is_chosen_by_its_name_or_its_path(machine: Machine) -> None:
    path = install()
    assert chosen(model="Qwen2.5-0.5B").settings.model_path == path
    assert chosen(backend="gguf", model="qwen2.5-0.5b").settings.model_path == path
    assert chosen(backend="gguf", model="~/a.gguf").settings.model_path == Path.home() / "a.gguf"
    assert chosen(model_path="/b.gguf").settings.backend == "gguf"
    assert chosen(backend="gguf", model_path="/b.gguf").settings.model_path == Path("/b.gguf")
    machine.models = [FoundModel(Path("/m/a.gguf"), 10**9, 1)]
    assert chosen(backend="gguf").settings.model_path == Path("/m/a.gguf")
    model_store.set_default("qwen2.5-0.5b")
    assert chosen(backend="gguf").settings.model_path == path


@pytest.mark.model
def test_the_135m_model_is_used_only_by_its_name(machine: Machine) -> None:
    from ravestate.modules.skill.wildtalk.llama import bundled_model

    for settings in ({"backend": "gguf"}, {}):
        assert chosen(model="SmolLM2-135M", **settings).settings.model_path == bundled_model()


@pytest.mark.parametrize("backend", ["auto", "gguf"])
def test_the_error_about_a_missing_model_names_the_command_that_helps(machine: Machine, backend: str) -> None:
    with pytest.raises(PlatformError, match=r"'qwen3-4b'.* installed: ravestate model get qwen3-4b"):
        chosen(backend=backend, model="qwen3-4b")
    with pytest.raises(PlatformError, match=r"'llama9'.* installed: see: ravestate model list"):
        chosen(backend=backend, model="llama9")


def test_the_other_backends_need_no_search(machine: Machine) -> None:
    assert chosen(backend="listen").settings.backend == "listen"
    assert chosen(backend="transformers", model="gpt2").settings.model == "gpt2"
    assert machine.asked == []
