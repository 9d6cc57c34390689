"""Slips of the pen."""

from __future__ import annotations

import pytest

from ravestate.modules.skill.agentqa.slips import Slips

KNOWN = Slips(["siblings", "friends", "hobbies", "learned", "favourite", "sister", "sifter", "name"])


@pytest.mark.parametrize(
    ("written", "meant"),
    [
        ("siblngs", "siblings"),
        ("frends", "friends"),
        ("frineds", "friends"),
        ("hobbbies", "hobbies"),
        ("lesrned", "learned"),
        ("my hobies", "my hobbies"),
    ],
)
def test_a_slip_is_mended(written: str, meant: str) -> None:
    assert KNOWN.mended(written) == meant


@pytest.mark.parametrize(
    "written", ["friends", "nme", "sixter", "iblings", "fiend", "hobby", "quite other", ""]
)
def test_what_is_known_short_ambiguous_or_something_else_stays(written: str) -> None:
    assert KNOWN.mended(written) == written
