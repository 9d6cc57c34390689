"""Keep the vectors of many texts in little memory, and compute their products with a few other vectors."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

BLOCK = 2048
"""The number of rows that are unpacked at a time: 3 MB for 384 dimensions. Small blocks would be slower while other
threads run Python, because each block has to wait for the interpreter again."""


class Rows:
    """The vectors of n texts, each of length 1. As small integers, they take a quarter of the memory of floats.

    Example:
        ::

            rows = Encoder().encode_lasting(["What is your name?", "How are you?"])
            rows.products(Encoder().encode(["What are you called?"]))      # the cosines, of shape (1, 2)
    """

    def __init__(self, packed: NDArray[Any]) -> None:
        """Take vectors as integers or floats of shape (n, d). They may have any length; they are scaled later."""
        import numpy as np

        self._packed = packed
        self._scale = np.empty(len(packed), dtype=np.float32)  # 1 / the length of each packed row
        for at in range(0, len(packed), BLOCK):
            block = packed[at : at + BLOCK].astype(np.float32)
            self._scale[at : at + BLOCK] = 1 / np.maximum(np.linalg.norm(block, axis=1), np.float32(1e-12))

    def __len__(self) -> int:
        return len(self._packed)

    def some(self, places: Sequence[int]) -> Rows:
        """Return the rows at `places`."""
        return Rows(self._packed[list(places)])

    def unpacked(self) -> NDArray[np.float32]:
        """Return the vectors: shape (n, d), each of length 1."""
        import numpy as np

        rows = self._packed.astype(np.float32)
        rows *= self._scale[:, None]
        return rows

    def products(self, vectors: NDArray[np.float32]) -> NDArray[np.float32]:
        """Return the products with `vectors`, of shape (k, d), as an array of shape (k, n).

        For vectors of length 1, these are cosines.
        """
        import numpy as np

        found = np.empty((len(vectors), len(self)), dtype=np.float32)
        buffer = np.empty((BLOCK, self._packed.shape[1]), dtype=np.float32)
        for at in range(0, len(self), BLOCK):
            packed = self._packed[at : at + BLOCK]
            block = buffer[: len(packed)]
            np.copyto(block, packed)
            found[:, at : at + BLOCK] = products(vectors, block)
        found *= self._scale
        return found


def products(vectors: NDArray[np.float32], rows: NDArray[np.float32]) -> NDArray[np.float32]:
    """Return the products of vectors of shape (k, d) and rows of shape (n, d), as an array of shape (k, n).

    Only the calling thread computes. The operator ``@`` would share the work with threads of numpy's library, which
    keep the cores busy while they wait for each other. When other threads work too, ``@`` takes 20 times as long.
    """
    import numpy as np

    return np.einsum("kd,nd->kn", vectors, rows)
