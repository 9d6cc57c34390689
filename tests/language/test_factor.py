"""`factor` returns F with FᵀF equal to the inverse of a kernel, even if the kernel is divided into many blocks."""

import numpy as np
import pytest

from ravestate.language.factor import BLOCK, factor


@pytest.mark.parametrize("size", [1, BLOCK, BLOCK + 1, 5 * BLOCK + 3])
def test_the_transposed_factor_times_the_factor_is_the_inverse_of_the_kernel(size: int) -> None:
    points = np.random.default_rng(0).standard_normal((size, 8)).astype(np.float32)
    # As in the kernel of a matcher, all similarities are positive, and many examples are almost equal.
    kernel = np.exp(-np.square(points[:, None] - points).sum(axis=2) / 50) + np.float32(0.1)
    kernel[np.diag_indices(size)] += np.float32(0.1)
    found = factor(kernel)
    assert np.allclose(np.triu(found, 1), 0)
    assert np.abs(found.T @ found @ kernel - np.eye(size)).max() < 2e-3
