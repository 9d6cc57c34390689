"""The settings of voiceio refuse values with which no conversation can work."""

import pydantic
import pytest

from ravestate.modules.platform.voiceio import Settings


@pytest.mark.parametrize(
    "name",
    ["recogniser_timeout", "captions", "pause", "doubtful_pause", "longest_pause", "back_channel", "filler_after"],
)
def test_a_time_must_be_finite(name: str) -> None:
    with pytest.raises(pydantic.ValidationError, match=name):
        Settings(**{name: float("inf")})
