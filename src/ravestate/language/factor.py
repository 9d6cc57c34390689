"""Factor a large kernel matrix. The factor gives the inverse of the matrix."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from numpy.typing import NDArray

BLOCK = 256
"""The maximum size of a matrix that is factored as a whole; larger matrices are halved."""


def factor(matrix: NDArray[Any]) -> NDArray[Any]:
    """Return the inverse of the Cholesky factor of a symmetric, positive definite matrix of shape (n, n).

    If the result is R, the inverse of the matrix is ``R.T @ R``. The function factors the upper left quarter and its
    Schur complement, and joins both results. So nearly all the work is products of large matrices, which a processor
    computes fastest.
    """
    import numpy as np

    if len(matrix) <= BLOCK:
        return np.linalg.inv(np.linalg.cholesky(matrix))
    half = len(matrix) // 2
    found = np.zeros_like(matrix)
    upper = found[:half, :half] = factor(matrix[:half, :half])
    across = upper @ matrix[:half, half:]
    lower = found[half:, half:] = factor(matrix[half:, half:] - across.T @ across)
    found[half:, :half] = -(lower @ across.T) @ upper
    return found
