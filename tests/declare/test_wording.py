"""Messages write names as code, name the line of the mistake, and shorten long values."""

import pytest

import ravestate as rs
from ravestate.declare.wording import cut, place_of_call, said, short, spelt


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
def test_names_are_spelt_as_code(name: str, home: str, typed: str) -> None:
    assert spelt(name, home) == typed


def test_the_place_of_a_call_is_outside_the_package_ravestate() -> None:
    go = rs.Module("m").signal("go")
    assert place_of_call().startswith(f"{__file__}:")
    with pytest.raises(rs.DeclarationError, match=f"{__file__}:"):
        bool(go & go)


class Shy:
    """A value whose `repr` fails."""

    def __repr__(self) -> str:
        raise RuntimeError


def test_a_long_value_is_shortened() -> None:
    assert short("x" * 100) == "'" + "x" * 56 + "..."
    assert cut("x" * 60) == "x" * 60
    assert short(Shy()) == "<Shy without a repr>"


def test_a_slot_refuses_a_value_without_a_repr() -> None:
    """The exception from the `repr` must not replace the message."""
    with pytest.raises(rs.RuleError, match="the rule wrote <Shy without a repr> to m:mood, which takes str"):
        rs.Module("m").slot("mood", "", type=str).check(Shy(), "the rule")


def test_an_exception_without_a_message_is_shown_by_its_type() -> None:
    assert said(ValueError("no such day")) == "no such day"
    assert said(AssertionError()) == "AssertionError()"
