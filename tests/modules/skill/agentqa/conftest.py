"""What the tests of agentqa share: the model is loaded once, and the topics learnt once."""

from __future__ import annotations

import pytest

from ravestate.modules.skill.agentqa import Router, read_life
from ravestate.modules.skill.agentqa.router import router_of


@pytest.fixture(scope="session")
def router() -> Router:
    """The router of the life that comes with the module, which contexts share."""
    return router_of(read_life())
