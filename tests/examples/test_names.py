"""The reference lists every public name and every command."""

import re
from pathlib import Path

import ravestate as rs
from ravestate.cli import COMMANDS

PAGE = Path(__file__).parents[2] / "docs" / "reference" / "index.md"


def test_the_reference_lists_every_public_name_and_command() -> None:
    text = PAGE.read_text(encoding="utf-8")
    assert set(re.findall(r"`rs\.(\w+)`", text)) == set(rs.__all__)
    assert set(re.findall(r"`ravestate (\w+)", text)) == set(COMMANDS)
