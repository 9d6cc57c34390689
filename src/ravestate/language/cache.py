"""Keep computed arrays in files of the user's cache folder, for later starts of the program."""

from __future__ import annotations

import contextlib
import hashlib
import json
import os
import tempfile
import zlib
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import IO, TYPE_CHECKING, Any

from ravestate.folders import user_folder

if TYPE_CHECKING:
    from numpy.typing import NDArray

BYTES = 80_000_000
"""The maximum size of the cache in bytes. If the cache is larger, the least recently used files are removed."""


def cached(key: object, compute: Callable[[], Mapping[str, NDArray[Any]]]) -> Mapping[str, NDArray[Any]]:
    """Return the arrays of `compute`; read them from a file if an earlier call with the same key wrote it.

    If the file is missing, broken, or could not be written, `compute` runs again.

    Args:
        key: All inputs that the arrays depend on, as a value that JSON can write.
        compute: The function that returns the arrays, each with a name.
    """
    import numpy as np

    file = _file_of(key, ".npz")
    try:
        with np.load(file, allow_pickle=False) as found:
            arrays = {name: found[name] for name in found.files}
        os.utime(file)
        return arrays
    except Exception:  # a damaged file may raise any exception
        arrays = dict(compute())
    _write(file, lambda out: np.savez(out, allow_pickle=False, **arrays))
    return arrays


_unwritten: dict[Path, NDArray[Any]] = {}
"""The arrays of `mapped` that could not be written."""


def mapped(key: object, compute: Callable[[], NDArray[Any]]) -> NDArray[Any]:
    """Return the array of `compute` as a read-only map of a file, so that it takes no memory of its own. See `cached`.

    If the file cannot be written, the array stays in memory.
    """
    import numpy as np

    file = _file_of(key, ".npy")
    if file in _unwritten:
        return _unwritten[file]
    check = file.with_suffix(".crc")
    try:
        if check.read_bytes() == _sum(file):
            array = np.load(file, mmap_mode="r", allow_pickle=False)
            os.utime(file)
            os.utime(check)
            return array
    except (OSError, ValueError):
        pass
    array = compute()
    if not (
        _write(file, lambda out: np.save(out, array, allow_pickle=False))
        and _write(check, lambda out: out.write(_sum(file)))
    ):
        _unwritten[file] = array
    return array


def _sum(file: Path) -> bytes:
    """Return the checksum of a file, and read only 1 MB of it at a time. A file of 20 MB takes 20 ms."""
    found = 0
    with file.open("rb") as parts:
        while part := parts.read(1 << 20):
            found = zlib.crc32(part, found)
    return found.to_bytes(4, "big")


def _file_of(key: object, ending: str) -> Path:
    digest = hashlib.sha256(json.dumps(key).encode("utf-8", "replace")).hexdigest()[:32]
    return user_folder("cache") / "vectors" / f"{digest}{ending}"


def _write(file: Path, write: Callable[[IO[bytes]], object]) -> bool:
    """Write a file of the cache as a whole, or not at all; return whether it was written."""
    name = ""
    try:
        file.parent.mkdir(parents=True, exist_ok=True)
        handle, name = tempfile.mkstemp(dir=file.parent)
        with os.fdopen(handle, "wb") as out:
            write(out)
        os.replace(name, file)
    except OSError:
        with contextlib.suppress(OSError):
            os.unlink(name)
        return False  # without a file, the next start computes the arrays again
    with contextlib.suppress(OSError):  # another process may have removed the folder
        _limit(file.parent)
    return True


def _limit(folder: Path) -> None:
    """Remove the least recently used files of the cache until it has at most `BYTES`."""
    found: list[tuple[int, int, str]] = []
    for entry in os.scandir(folder):
        with contextlib.suppress(FileNotFoundError):  # another process has renamed or removed this file
            about = entry.stat()
            found.append((about.st_mtime_ns, about.st_size, entry.path))
    size = sum(one for _, one, _ in found)
    for _, one, path in sorted(found):
        if size <= BYTES:
            return
        size -= one
        Path(path).unlink(missing_ok=True)
