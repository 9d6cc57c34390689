"""The ten behaviours on the runtime."""

import pytest

from ravestate.testing import simulate
from scenarios.behaviours import BEHAVIOURS, Play


@pytest.mark.parametrize("behaviour", BEHAVIOURS, ids=lambda behaviour: behaviour.__name__)
def test_the_behaviour_on_the_runtime(behaviour: Play) -> None:
    behaviour(simulate)
