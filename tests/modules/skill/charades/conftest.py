"""The pipeline and the examples, loaded once for all tests of charades."""

from __future__ import annotations

import pytest

from ravestate.language.matcher import bundled_matcher
from ravestate.language.network import network
from ravestate.modules.meta.nlp.analysis import MATCHERS
from ravestate.modules.meta.nlp.pipeline import pipeline
from ravestate.modules.skill.charades import understanding


@pytest.fixture(scope="session")
def reader() -> None:
    """Load the pipeline and the examples."""
    pipeline("").load()
    understanding.load()
    network().load()
    for name in MATCHERS:
        bundled_matcher(name).load()
