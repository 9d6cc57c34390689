"""The processes of the speech models. Their programs are the files in the folder ``children``."""

from __future__ import annotations

import sys
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from ravestate.modules._children import process
from ravestate.modules._children.process import Backend, ModelProcess, drop

__all__ = ["CHILDREN", "ModelProcess", "drop", "take"]

CHILDREN = Path(__file__).with_name("children")


def take(kind: str, config: Mapping[str, Any], python: str = sys.executable, *, shared: bool = True) -> ModelProcess:
    """Return the process of the backend `kind`: a file of this name in `CHILDREN`. Pair each call with `drop`.

    For the other arguments, see `ravestate.modules._children.process.take`.
    """

    def mend(reason: str) -> str:
        if kind == "espeak":
            return ": apt-get install espeak-ng (or brew install espeak-ng)" if "not installed" in reason else ""
        if kind == "piper":
            return ". Set it up with `make voice`, or take another voice: --set voiceio.voice=espeak"
        if "language" in reason:
            return ". Set voiceio.language, or take another model: ravestate voice get base"
        return ". See what is missing: ravestate voice check"

    return process.take(Backend(CHILDREN / f"{kind}.py", "voiceio", kind, mend), config, python, shared=shared)
