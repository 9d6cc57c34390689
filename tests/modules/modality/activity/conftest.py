"""One recogniser for all tests that teach it nothing."""

from __future__ import annotations

import pytest

from ravestate.modules.modality.activity import Recogniser


@pytest.fixture(scope="session")
def recogniser() -> Recogniser:
    return Recogniser()
