"""One pipeline for all tests, loaded when a test first needs it."""

import pytest

from ravestate.language.network import network
from ravestate.modules.meta.nlp.pipeline import Pipeline, pipeline


@pytest.fixture(scope="session", autouse=True)
def _networks() -> None:
    network().load()


@pytest.fixture(scope="session")
def reader() -> Pipeline:
    """The default pipeline of the module."""
    shared = pipeline("")
    shared.load()
    return shared
