"""Fixtures: an empty memory for each test, loaded language models, and the end of the shared vision worker."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest

from modules.modality.visionio.photographs import eye
from ravestate.language.matcher import bundled_matcher
from ravestate.language.network import network
from ravestate.modules.meta.nlp.analysis import MATCHERS
from ravestate.modules.meta.nlp.pipeline import pipeline
from ravestate.modules.skill.persqa import kinds


@pytest.fixture(scope="session", autouse=True)
def worker() -> Iterator[None]:
    """End the shared vision worker after all tests."""
    yield
    if eye.cache_info().currsize:
        eye().close()


@pytest.fixture(scope="session")
def reader() -> None:
    """Load the language models once for all tests."""
    pipeline("").load()
    kinds.load()
    network().load()
    for name in MATCHERS:
        bundled_matcher(name).load()


@pytest.fixture
def memory(tmp_path: Path) -> Path:
    """The path for a new, empty memory."""
    return tmp_path / "memory.lbug"
