"""A recogniser that the tests share. A test that teaches a movement makes its own."""

from __future__ import annotations

import pytest

from ravestate.modules.modality.activity import Recogniser


@pytest.fixture(scope="session")
def recogniser() -> Recogniser:
    return Recogniser()
