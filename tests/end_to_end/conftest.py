"""The browser of the browser tests."""

from collections.abc import Iterator

import pytest

from end_to_end.stage import Stage


@pytest.fixture(scope="session")
def stage() -> Iterator[Stage]:
    """One browser for all tests; each opens windows of its own."""
    stage = Stage()
    yield stage
    stage.close()
