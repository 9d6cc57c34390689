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
    """The complete settings of the chosen backend, and a sentence about the choice."""

    settings: Settings
    text: str


def choose(settings: Settings) -> Choice:
    """Return the backend to use. The call may block for a few seconds while it asks servers. It loads no model.

    ``auto`` takes the first of these: a server or model in the settings; the default of ``ravestate model get``; a
    server on this machine; a model file in the user's folders; the listening skill (authored phrases).

    Raises:
        PlatformError: The settings name a model that does not exist, or ask for a model file, and there is none.
    """
    backend, name = settings.backend, settings.model
    if backend in ("listen", "transformers"):
        return Choice(settings, f"small talk by {backend}")
    if settings.base_url is not None and backend != "gguf":
        return _by_server(settings, settings.base_url, name or _listed(settings))
    path = settings.model_path or (_path_of(name) if name is not None else None)
    runs_files = find_spec("xllamacpp") is not None
    if backend != "openai":
        if path is not None:
            return _by_file(settings, path)
        if name is None and (runs_files or backend == "gguf") and (default := model_store.default()) is not None:
            return _by_file(settings, default.path, default.parameters)
    if backend != "gguf":
        if (server := _pick(_servers() if settings.search else [], name)) is not None:
            return _by_server(settings, *server)
        if backend == "openai":
            return _by_server(settings, OLLAMA, name or "llama3.2")
    if name is not None:
        servers = "" if backend == "gguf" else f"no server on this machine has the model {name!r}, and "
        get = f"{FETCH} {name.lower()}" if name.lower() in model_store.catalogue() else "see: ravestate model list"
        raise PlatformError(f"wildtalk: {servers}no file of the model {name!r} is installed: {get}")
    if settings.search and (runs_files or backend == "gguf") and (found := best_model(find_models())) is not None:
        return _by_file(settings, found.path, found.parameters)
    if backend == "gguf":
        raise PlatformError(f"wildtalk: there is no chat model in GGUF format on this machine: {FETCH}")
    install = "" if runs_files else "pip install 'ravestate[wildtalk]' , then "
    return Choice(
        settings.model_copy(update={"backend": "listen"}),
        f"small talk with authored replies. To talk with a language model: {install}{FETCH}",
    )


def _listed(settings: Settings) -> str:
    """Return the first chat model of the server that the settings name; ``llama3.2`` if it lists none."""
    assert settings.base_url is not None
    listed: tuple[str, ...] = ()
    if settings.search and find_spec("httpx2") is not None:
        key = settings.api_key.get_secret_value() if settings.api_key is not None else ""
        listed = asyncio.run(chat_models(settings.base_url, key, settings.connect_timeout))
    return listed[0] if listed else "llama3.2"


def _path_of(model: str) -> Path | None:
    """Return the file of the model with this name or path; None if there is none."""
    if model.lower() == BUNDLED:
        return bundled_model()
    if (known := model_store.catalogue().get(model.lower())) is not None:
        return known.path if known.installed else None
    return Path(model).expanduser() if model.lower().endswith(".gguf") else None


def _servers() -> list[LocalServer]:
    return asyncio.run(find_servers())


def _pick(servers: list[LocalServer], model: str | None) -> tuple[str, str, str] | None:
    """Return the address, model and name of the first server that has `model`; None stands for any model."""
    for server in servers:
        for name in server.models:
            if model is None or name in (model, f"{model}:latest"):
                return server.base_url, name, server.name
    return None


def _by_server(settings: Settings, base_url: str, model: str, name: str = "") -> Choice:
    changes: dict[str, Any] = {"backend": "openai", "base_url": base_url, "model": model}
    if settings.base_url is None:
        changes["api_key"] = None  # the key belongs to the server that the user has named
    place = f"{name} at {base_url}" if name else base_url.rpartition("@")[2]
    text = f"small talk by {model} ({place}). Another model: --set wildtalk.model=NAME"
    return Choice(settings.model_copy(update=changes), text)


def _by_file(settings: Settings, path: Path, parameters: int = 0) -> Choice:
    size = f" ({parameters / 1e9:.1f} billion parameters)" if parameters else ""
    text = f"small talk by {path.name}{size}. Others: ravestate model list"
    return Choice(settings.model_copy(update={"backend": "gguf", "model_path": path}), text)
