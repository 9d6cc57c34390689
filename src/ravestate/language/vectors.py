"""Ready-made vectors of the built-in examples, so that the first start is fast. ``tools/vectors.py`` makes the file."""

from __future__ import annotations

import hashlib
from collections.abc import Sequence
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING

from .cache import mapped

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

FILE = "vectors.npz"


def key_of(text: str) -> int:
    """Return the key of a text in the file."""
    return int.from_bytes(hashlib.blake2b(text.encode("utf-8", "replace"), digest_size=8).digest(), "big")


def built_in(texts: Sequence[str], size: int) -> tuple[NDArray[np.bool_], NDArray[np.int8]]:
    """Return which of the texts have a ready-made vector, and the vectors of those n texts: shape (n, d), not normalised.

    Args:
        texts: Sentences in their plain form (`normal.plain`).
        size: The size of the model's file in bytes. If the vectors were made for a model file of another size,
            no text has a vector.
    """
    import numpy as np

    keys, made_for = _keys()
    if not texts or made_for != size:
        return np.zeros(len(texts), dtype=np.bool_), np.zeros((0, 1), dtype=np.int8)
    wanted = np.array([key_of(text) for text in texts], dtype=np.uint64)
    places = np.minimum(np.searchsorted(keys, wanted), len(keys) - 1)
    known: NDArray[np.bool_] = keys[places] == wanted
    return known, _rows()[places[known]]


@cache
def _keys() -> tuple[NDArray[np.uint64], int]:
    """Return the keys in ascending order, and the size of the model's file."""
    import numpy as np

    try:
        with _file().open("rb") as file, np.load(file, allow_pickle=False) as found:
            return found["keys"], int(found["size"])
    except FileNotFoundError:  # ``tools/vectors.py`` has not made the file yet
        return np.zeros(0, np.uint64), 0


def _rows() -> NDArray[np.int8]:
    """Return the vectors in the order of the keys: shape (n, d).

    The package holds the vectors compressed, as columns. The first call unpacks them into a file of the user's cache.
    The array is a map of this file, so the vectors need no memory.
    """
    file = _file()
    about = file.stat()
    return mapped(["built-in vectors", about.st_size, about.st_mtime_ns], _unpacked)


def _unpacked() -> NDArray[np.int8]:
    import numpy as np

    with _file().open("rb") as file, np.load(file, allow_pickle=False) as found:
        return np.ascontiguousarray(found["columns"].T)


def _file() -> Path:
    return Path(__file__).with_name(FILE)
