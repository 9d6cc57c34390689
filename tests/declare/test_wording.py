"""Messages name things as they are typed, and the line where the mistake is."""

import pytest

import ravestate as rs
from ravestate.declare.wording import place_of_call, spelt


@pytest.mark.parametrize(
    ("name", "home", "typed"),
    [
        ("rawio:input:changed", "guide", "rawio.input.changed"),
        ("guide:face", "guide", "face"),
        ("guide:face:true", "guide", "face.true"),
        ("my-lamp:light", "guide", "my_lamp.light"),
        ("face", "guide", "face"),
    ],
)
def test_names_are_spelt_as_they_are_typed(name: str, home: str, typed: str) -> None:
    assert spelt(name, home) == typed


def test_the_place_is_the_designers_line() -> None:
    go = rs.Module("m").signal("go")
    assert place_of_call().startswith(f"{__file__}:")
    with pytest.raises(rs.DeclarationError, match=f"{__file__}:"):
        bool(go & go)
