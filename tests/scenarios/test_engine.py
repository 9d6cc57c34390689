"""The ten behaviours on the bare engine."""

import pytest

from scenarios.behaviours import BEHAVIOURS, Play
from scenarios.driver import Driver


@pytest.mark.parametrize("behaviour", BEHAVIOURS, ids=lambda behaviour: behaviour.__name__)
def test_the_behaviour_on_the_bare_engine(behaviour: Play) -> None:
    behaviour(Driver)
