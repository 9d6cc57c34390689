"""Chat models in the folders of the programs that run models on this machine."""

from __future__ import annotations

import os
import sys
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from pathlib import Path

from .gguf_header import read_header
from .model_store import folder

LEAST = 450_000_000
"""The minimum number of parameters. The names of models of this size say "0.5B"."""

FLUENT = 4_500_000_000
"""The maximum number of parameters of a model that answers fluently without a graphics card."""

SHARE = 0.6
"""The maximum size of a model's file, as a share of this machine's memory."""

MANY = 50_000
"""The maximum number of files and folders that a search looks at."""

NOT_CHAT = ("embed", "rerank", "mmproj", "draft", "-vocab", "-of-0")
"""Parts of file names that mark other kinds of models, and models that are split into several files."""


@dataclass(frozen=True, slots=True)
class FoundModel:
    """A chat model in a file."""

    path: Path
    parameters: int
    size: int
    """Bytes."""


def folders() -> list[Path]:
    """Return the paths of this user's model folders, Ravestate's own first. Some may not exist."""
    try:
        own, home = folder(), Path.home()
    except RuntimeError:  # the user has no home
        return []
    cache = _from("XDG_CACHE_HOME", home / ".cache")
    data, caches = _from("XDG_DATA_HOME", home / ".local" / "share"), cache
    if sys.platform == "darwin":
        data, caches = home / "Library" / "Application Support", home / "Library" / "Caches"
    return [
        own,
        home / ".lmstudio" / "models",
        home / ".cache" / "lm-studio" / "models",
        _from("HF_HUB_CACHE", _from("HF_HOME", cache / "huggingface") / "hub"),
        _from("LLAMA_CACHE", caches / "llama.cpp"),
        data / "nomic.ai" / "GPT4All",
        data / "Jan" / "data",
    ]


def find_models(places: Iterable[Path] | None = None) -> list[FoundModel]:
    """Return the chat models of at least half a billion parameters in some folders, by default the user's.

    Unreadable files are left out. A file with several links is listed once.
    """
    found: dict[Path, FoundModel] = {}
    for file in _files(folders() if places is None else places):
        try:
            real = file.resolve()
            header = read_header(real)
            if header.chats and header.parameters >= LEAST and real not in found:
                found[real] = FoundModel(file, header.parameters, real.stat().st_size)
        except (OSError, ValueError):
            continue
    return list(found.values())


def best_model(models: Iterable[FoundModel], memory: int | None = None) -> FoundModel | None:
    """Return the largest fluent model, or else the smallest model; None if no model fits.

    A model fits if its file is at most `SHARE` of `memory` (in bytes; by default, this machine's memory).
    """
    most = (memory or _memory()) * SHARE
    fitting = [model for model in models if model.size <= most]
    fluent = [model for model in fitting if model.parameters <= FLUENT]
    if fluent:
        return max(fluent, key=lambda model: model.parameters)
    return min(fitting, key=lambda model: model.parameters, default=None)


def _files(places: Iterable[Path]) -> Iterator[Path]:
    left = MANY
    for place in places:
        for at, inside, files in os.walk(place):
            inside.sort()
            left -= len(inside) + len(files)
            if left < 0:
                return
            for name in sorted(files):
                if name.lower().endswith(".gguf") and not any(part in name.lower() for part in NOT_CHAT):
                    yield Path(at, name)


def _memory() -> float:
    """Return this machine's memory in bytes; infinity if the system does not say."""
    try:
        return float(os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES"))
    except (AttributeError, OSError, ValueError):
        return float("inf")


def _from(variable: str, usual: Path) -> Path:
    given = Path(os.environ.get(variable, ""))
    return given if given.is_absolute() else usual
