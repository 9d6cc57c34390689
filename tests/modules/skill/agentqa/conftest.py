"""One router for all tests of agentqa."""

from __future__ import annotations

import pytest

from ravestate.modules.skill.agentqa import Router, read_life
from ravestate.modules.skill.agentqa.router import router_of


@pytest.fixture(scope="session")
def router() -> Router:
    """Return the router of the built-in life, which all contexts share."""
    return router_of(read_life())
