"""Find the speech models on this machine, and download missing ones."""

from __future__ import annotations

import os
import shutil
import sys
import warnings
from collections.abc import Callable, Iterator
from importlib.util import find_spec
from pathlib import Path

from ravestate.errors import PlatformError
from ravestate.folders import user_folder

PREFERRED = ("base", "base.en", "small.en", "small", "tiny.en", "tiny")
"""The order of preference for models of speech recognition, if the settings name no model."""

SMART_TURN = "smart-turn-*.onnx"

UNFINISHED = ".part"
"""The suffix of a folder into which a model is downloaded."""


def folders() -> tuple[Path, ...]:
    """Return the folders that may contain models: the user's folder, and the folder of this Python environment."""
    return user_folder("data") / "voice", Path(sys.prefix) / "share" / "ravestate" / "voice"


def whisper_model(name: str) -> Path:
    """Return the folder of a model for faster-whisper.

    Args:
        name: A folder's path, or the name of a folder inside one of `folders()`, or a repository of Hugging Face;
            empty for the best model there.

    Raises:
        PlatformError: There is no such model; the message says how to get one.
    """
    if name and (Path(name).expanduser() / "model.bin").is_file():
        return Path(name).expanduser().absolute()
    found = dict(whisper_models())
    if not name:
        for preferred in (*PREFERRED, *found):
            if preferred in found:
                return found[preferred]
        raise PlatformError("voiceio has no model for speech recognition: `make voice` or `ravestate voice get base`")
    if _saved(name) not in found:
        known = f"; there are: {', '.join(found)}" if found else ""
        raise PlatformError(f"voiceio has no model {name!r}{known}. To fetch it: ravestate voice get {name}")
    return found[_saved(name)]


def _saved(name: str) -> str:
    """Return the name of the folder of the model `name`."""
    return name.replace("/", "--")


def whisper_models() -> Iterator[tuple[str, Path]]:
    """Yield the name and the folder of each model for faster-whisper. Leave out unfinished downloads."""
    for folder in folders():
        for file in sorted(folder.glob("*/model.bin")):
            if file.parent.suffix != UNFINISHED:
                yield file.parent.name, file.parent


def fetch_whisper(name: str, progress: Callable[[str], None]) -> Path:
    """Download the faster-whisper model `name` into the user's folder.

    The name is ``base``, ``small.en`` or the like, or a repository of Hugging Face.

    Before the download, the function calls `progress` with a sentence about it.

    Raises:
        PlatformError: The package is missing, the name is unknown, or the download fails.
    """
    if find_spec("faster_whisper") is None:
        raise PlatformError("voiceio needs faster-whisper: pip install 'ravestate[voice]'")
    from faster_whisper import download_model  # pyright: ignore[reportMissingTypeStubs,reportUnknownVariableType]

    folder = folders()[0] / _saved(name)
    progress(f"fetching {name} into {folder}")
    partial = folder.with_name(folder.name + UNFINISHED)
    try:
        partial.mkdir(parents=True, exist_ok=True)
        with warnings.catch_warnings(action="ignore"):  # faster-whisper passes on an outdated option
            download_model(name, output_dir=str(partial))
        os.replace(partial, folder)
    except Exception as error:
        if not any(
            file.is_file() and file.stat().st_size > 1000 for file in partial.rglob("*")
        ):  # otherwise keep the files, so that the next attempt continues
            shutil.rmtree(partial, ignore_errors=True)
        raise PlatformError(f"voiceio: cannot fetch {name!r}: {error}") from error
    return folder


def piper_voice(name: str) -> Path | None:
    """Return the file of a voice for Piper, by its path or its name in one of `folders()`; None if there is none.

    An empty name fits any voice in these folders.
    """
    if name and Path(name).expanduser().suffix == ".onnx" and Path(name).expanduser().is_file():
        return Path(name).expanduser().absolute()
    for folder in folders():
        for file in sorted(folder.glob("*.onnx")):
            if file.with_suffix(".onnx.json").is_file() and (not name or file.stem == name):
                return file
    return None


def piper_python(setting: Path | None) -> str | None:
    """Return a Python interpreter for Piper; None if there is none.

    Return the interpreter in the setting (unchecked), else this interpreter if it has Piper. Else look in
    ``.venvs/piper`` beside this environment, then in ``piper`` in the user's data folder.
    """
    if setting is not None:
        return str(setting.expanduser())
    if find_spec("piper") is not None:
        return sys.executable
    for place in (Path(sys.prefix).parent / ".venvs" / "piper", user_folder("data") / "piper"):
        if (python := place / "bin" / "python").is_file():
            return str(python)
    return None


def smart_turn() -> Path | None:
    """Return the file of the model that detects the end of a turn; None if this machine has no such file."""
    return next((file for folder in folders() for file in sorted(folder.glob(SMART_TURN), reverse=True)), None)
