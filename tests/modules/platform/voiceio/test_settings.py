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


@pytest.mark.parametrize("language", ["klingon", "German", "en_GB", "de-", " de"])
def test_a_language_must_be_a_code(language: str) -> None:
    with pytest.raises(pydantic.ValidationError, match="such as de or de-AT"):
        Settings(language=language)


@pytest.mark.parametrize("language", ["", "de", "de-AT", "zh-Hant-TW", "haw"])
def test_a_language_may_have_a_region_or_be_empty(language: str) -> None:
    assert Settings(language=language).language == language
