"""Packed vectors have the same dot products as unpacked vectors."""

from __future__ import annotations

import numpy as np
import pytest

from ravestate.language.rows import BLOCK, Rows, products


@pytest.fixture
def packed() -> np.ndarray:
    return np.random.default_rng(1).integers(-63, 64, (2 * BLOCK + 7, 48)).astype(np.int8)


def test_the_products_of_packed_rows_are_those_of_vectors_of_length_1(packed: np.ndarray) -> None:
    vectors = np.random.default_rng(2).normal(size=(3, 48)).astype(np.float32)
    long = packed.astype(np.float32)
    expected = vectors @ (long / np.linalg.norm(long, axis=1, keepdims=True)).T
    rows = Rows(packed)
    assert rows.products(vectors) == pytest.approx(expected, abs=1e-5)
    assert products(vectors, rows.unpacked()) == pytest.approx(expected, abs=1e-5)


def test_the_method_some_returns_the_rows_at_given_places(packed: np.ndarray) -> None:
    rows, places = Rows(packed), [BLOCK + 3, 0, BLOCK + 3]
    assert (rows.some(places).unpacked() == rows.unpacked()[places]).all()
    assert len(rows.some([])) == 0


def test_without_vectors_or_rows_there_are_no_products(packed: np.ndarray) -> None:
    assert Rows(packed).products(np.zeros((0, 48), np.float32)).shape == (0, len(packed))
    assert Rows(packed[:0]).products(np.zeros((2, 48), np.float32)).shape == (2, 0)
