"""The browser that all browser tests share."""

from collections.abc import Iterator

import pytest

from end_to_end.stage import Stage


@pytest.fixture(scope="session")
def stage() -> Iterator[Stage]:
    """One browser for all tests. Each test opens its own windows."""
    stage = Stage()
    yield stage
    stage.close()
