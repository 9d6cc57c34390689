"""Short silences for the tests of the agenda. The times in the scenarios refer to them."""

from collections.abc import Iterator

import pytest

from ravestate.modules import idle


@pytest.fixture(autouse=True)
def short_silences() -> Iterator[None]:
    """Set the defaults `idle.bored_after` to 5 and `idle.answer_time` to 12 seconds."""
    fields = idle.Settings.model_fields
    before = fields["bored_after"].default, fields["answer_time"].default
    for values in ((5.0, 12.0), before):
        fields["bored_after"].default, fields["answer_time"].default = values
        idle.Settings.model_rebuild(force=True)
        if values != before:
            yield
