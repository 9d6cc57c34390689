"""What the laws' tests share: each story is told to the bare engine and to the runtime."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest

from ravestate.testing import simulate
from scenarios.driver import Driver


@pytest.fixture(params=[Driver, simulate], ids=["engine", "runtime"])
def play(request: pytest.FixtureRequest) -> Callable[..., Any]:
    """Begins a story: ``with play(module, ..., patience=1.0) as sim``."""
    return request.param
