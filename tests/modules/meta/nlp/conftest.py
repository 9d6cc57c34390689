"""One pipeline for all tests, loaded when the first of them needs it."""

import pytest

from ravestate.modules.meta.nlp.pipeline import Pipeline, pipeline


@pytest.fixture(scope="session")
def reader() -> Pipeline:
    """The pipeline that the module takes by default."""
    shared = pipeline("")
    shared.load()
    return shared
