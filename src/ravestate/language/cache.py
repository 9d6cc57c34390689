"""Keep computed arrays in files of the user's cache folder, for later starts of the program."""

from __future__ import annotations

import hashlib
import json
import os
import tempfile
from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Any
from zipfile import BadZipFile

from ravestate.folders import user_folder

if TYPE_CHECKING:
    from numpy.typing import NDArray

FILES = 100
"""The maximum number of files in the cache. Beyond it, the oldest files are removed."""


def cached(key: object, compute: Callable[[], Mapping[str, NDArray[Any]]]) -> Mapping[str, NDArray[Any]]:
    """Return the arrays of `compute`; read them from a file if an earlier call with the same key wrote it.

    If a file is missing or broken, or the folder cannot be written, the arrays are only computed again.

    Args:
        key: Everything that the arrays depend on; a value that JSON can write.
        compute: The function that returns the arrays, each with a name.
    """
    import numpy as np

    digest = hashlib.sha256(json.dumps(key).encode("utf-8", "replace")).hexdigest()[:32]
    file = user_folder("cache") / "vectors" / f"{digest}.npz"
    try:
        with np.load(file, allow_pickle=False) as found:
            arrays = {name: found[name] for name in found.files}
        os.utime(file)
        return arrays
    except (OSError, ValueError, EOFError, KeyError, BadZipFile):
        arrays = dict(compute())
    try:
        file.parent.mkdir(parents=True, exist_ok=True)
        handle, name = tempfile.mkstemp(dir=file.parent)
        with os.fdopen(handle, "wb") as out:
            np.savez(out, allow_pickle=False, **arrays)
        os.replace(name, file)
        for old in sorted(file.parent.glob("*.np[yz]"), key=lambda old: old.stat().st_mtime, reverse=True)[FILES:]:
            old.unlink(missing_ok=True)
    except OSError:
        pass  # without a file, the next start computes the arrays again
    return arrays
