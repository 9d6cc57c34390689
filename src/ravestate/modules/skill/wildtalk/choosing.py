"""The choice of a language model: by the settings, or by what this machine has."""

from __future__ import annotations

import asyncio
from dataclasses import dataclass
from importlib.util import find_spec
from pathlib import Path
from typing import Any

from ravestate.errors import PlatformError

from . import model_store
from .found_models import best_model, find_models
from .llama import BUNDLED, bundled_model
from .local_servers import LocalServer, chat_models, find_servers
from .names import OLLAMA, Settings

FETCH = "ravestate model get"


@dataclass(frozen=True, slots=True)
class Choice:
    """A backend, as settings that name it completely, and the choice in words."""

    settings: Settings
    text: str


def choose(settings: Settings) -> Choice:
    """Return the backend to use. The call blocks for up to a second, and loads no model.

    For ``auto`` the first of these is taken: a server, or a model, that the settings name; the default of
    ``ravestate model get``; a server on this machine; a model file in the user's folders; the listening skill.

    Raises:
        PlatformError: The settings name a model that is not there.
    """
    if settings.backend == "gguf":
        return _file_for(settings)
    if settings.backend == "openai":
        return _server_for(settings)
    if settings.backend != "auto":
        return Choice(settings, f"small talk by {settings.backend}")
    if settings.base_url is not None:
        return _server_for(settings)
    if settings.model_path is not None or (settings.model is not None and _path_of(settings.model) is not None):
        return _file_for(settings)
    runs_files = find_spec("xllamacpp") is not None
    default = model_store.default() if runs_files and settings.model is None else None
    if default is not None:
        return _by_file(settings, default.path, default.parameters)
    servers = _servers() if settings.search else []
    if (server := _pick(servers, settings.model)) is not None:
        return _by_server(settings, *server)
    if settings.model is not None:
        raise PlatformError(
            f"wildtalk: no server on this machine has the model {settings.model!r}, and no such file is installed: "
            f"{_how_to_get(settings.model)}"
        )
    if settings.search and runs_files and (found := best_model(find_models())) is not None:
        return _by_file(settings, found.path, found.parameters)
    install = "" if runs_files else "pip install 'ravestate[wildtalk]' , then "
    return Choice(
        settings.model_copy(update={"backend": "listen"}),
        f"small talk without a language model: the agent listens. To talk with a model: {install}{FETCH}",
    )


def _server_for(settings: Settings) -> Choice:
    """Return the server of the settings, or the one on this machine, with its model."""
    if settings.base_url is None:
        found = _pick(_servers() if settings.search else [], settings.model)
        if found is None:
            return _by_server(settings, OLLAMA, settings.model or "llama3.2", "")
        return _by_server(settings, *found)
    model = settings.model
    if model is None and settings.search and find_spec("httpx") is not None:
        key = settings.api_key.get_secret_value() if settings.api_key is not None else ""
        model = next(iter(asyncio.run(chat_models(settings.base_url, key, settings.connect_timeout))), None)
    return _by_server(settings, settings.base_url, model or "llama3.2", "")


def _file_for(settings: Settings) -> Choice:
    """Return the model file that the settings name, or the best on this machine."""
    if settings.model_path is not None:
        return _by_file(settings, settings.model_path)
    if settings.model is not None:
        if (path := _path_of(settings.model)) is None:
            raise PlatformError(f"wildtalk: no model {settings.model!r} is installed: {_how_to_get(settings.model)}")
        return _by_file(settings, path)
    default = model_store.default()
    if default is not None:
        return _by_file(settings, default.path, default.parameters)
    found = best_model(find_models()) if settings.search else None
    if found is None:
        raise PlatformError(f"wildtalk: there is no chat model in GGUF format on this machine: {FETCH}")
    return _by_file(settings, found.path, found.parameters)


def _path_of(model: str) -> Path | None:
    """Return the file of a model's name or path; None if it is neither."""
    if model.lower() == BUNDLED:
        return bundled_model()
    if (known := model_store.catalogue().get(model.lower())) is not None:
        return known.path if known.installed else None
    return Path(model).expanduser() if model.lower().endswith(".gguf") else None


def _how_to_get(model: str) -> str:
    return f"{FETCH} {model.lower()}" if model.lower() in model_store.catalogue() else "see: ravestate model list"


def _servers() -> list[LocalServer]:
    return asyncio.run(find_servers())


def _pick(servers: list[LocalServer], model: str | None) -> tuple[str, str, str] | None:
    """Return address, model and name of the first server, or of the first that has `model`."""
    for server in servers:
        for name in server.models:
            if model is None or name in (model, f"{model}:latest"):
                return server.base_url, name, server.name
    return None


def _by_server(settings: Settings, base_url: str, model: str, name: str) -> Choice:
    changes: dict[str, Any] = {"backend": "openai", "base_url": base_url, "model": model}
    if settings.base_url is None:
        changes["api_key"] = None  # the key belongs to the server that the user has named
    place = f"{name} at {base_url}" if name else base_url.rpartition("@")[2]
    return Choice(
        settings.model_copy(update=changes),
        f"small talk by {model} ({place}). Another model: --set wildtalk.model=NAME",
    )


def _by_file(settings: Settings, path: Path, parameters: int = 0) -> Choice:
    size = f" ({parameters / 1e9:.1f} billion parameters)" if parameters else ""
    return Choice(
        settings.model_copy(update={"backend": "gguf", "model_path": path}),
        f"small talk by {path.name}{size}. Others: ravestate model list",
    )
