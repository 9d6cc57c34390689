"""The fixture for the tests of the laws. Each test runs on the bare engine and on the runtime."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest

from ravestate.testing import simulate
from scenarios.driver import Driver


@pytest.fixture(params=[Driver, simulate], ids=["engine", "runtime"])
def play(request: pytest.FixtureRequest) -> Callable[..., Any]:
    """Return the function that begins a simulation: ``with play(module, ..., patience=1.0) as sim``."""
    return request.param
