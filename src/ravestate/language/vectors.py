"""Ready-made vectors of the built-in examples, so that the first start is fast. ``tools/vectors.py`` makes the file."""

from __future__ import annotations

import hashlib
from collections.abc import Sequence
from functools import cache
from importlib.resources import files
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

FILE = "vectors.npz"


def key_of(text: str) -> int:
    """Return the key of a text in the file."""
    return int.from_bytes(hashlib.blake2b(text.encode("utf-8", "replace"), digest_size=8).digest(), "big")


def built_in(texts: Sequence[str], size: int) -> dict[str, NDArray[np.float32]]:
    """Return the known vectors of texts, each of length 1.

    Args:
        texts: Sentences in plain form.
        size: The size of the model's file in bytes. For another model, no vectors are returned.
    """
    import numpy as np

    table = _table()
    if not texts or int(table["size"]) != size:
        return {}
    keys = np.array([key_of(text) for text in texts], dtype=np.uint64)
    places = np.minimum(np.searchsorted(table["keys"], keys), len(table["keys"]) - 1)
    known = np.flatnonzero(table["keys"][places] == keys)
    rows = table["rows"][places[known]].astype(np.float32)
    rows /= np.linalg.norm(rows, axis=1, keepdims=True)
    return {texts[int(number)]: row for number, row in zip(known, rows, strict=True)}


@cache
def _table() -> dict[str, NDArray[Any]]:
    """Return ``keys`` of shape (n,) in ascending order, ``rows`` of shape (n, d) as small integers, and ``size``.

    The file has ``columns`` of shape (d, n) instead of ``rows``: that is easier to compress.
    """
    import numpy as np

    try:
        with (files("ravestate.language") / FILE).open("rb") as file, np.load(file, allow_pickle=False) as found:
            rows = np.ascontiguousarray(found["columns"].T)
            return {"keys": found["keys"], "rows": rows, "size": found["size"]}
    except FileNotFoundError:  # ``tools/vectors.py`` has not made the file yet
        return {"keys": np.zeros(0, np.uint64), "rows": np.zeros((0, 1), np.int8), "size": np.array(0)}
