"""Grave remarks: death, violence, and words of people who may harm themselves. The listening skill does not answer them
lightly.

The explicit answers to distress come from another module (`agentqa`).
"""

from __future__ import annotations

import re
from functools import cache
from importlib.resources import files
from typing import Any

from ravestate.language.normal import plain
from ravestate.yaml_text import load_yaml

FILE = "grave.yaml"


def is_grave(text: str) -> bool:
    """Return whether a text has a grave word or phrase.

    Example:
        >>> is_grave("My dog died."), is_grave("My dog barked.")
        (True, False)
    """
    return _patterns()[0].search(_LIVELY.sub("", plain(text))) is not None


def is_medical(text: str) -> bool:
    """Return whether a text has words of illness or injury, about which only a doctor may advise.

    Example:
        >>> is_medical("He has a fever of 39."), is_medical("He has a new bicycle.")
        (True, False)
    """
    return _patterns()[2].search(plain(text)) is not None


def is_emergency(text: str) -> bool:
    """Return whether a text has words of danger to life.

    Example:
        >>> is_emergency("She is choking!"), is_emergency("My dog died.")
        (True, False)
    """
    return _patterns()[3].search(plain(text)) is not None


def is_crisis(text: str) -> bool:
    """Return whether a text has words of a person who may be in danger, or of danger to life.

    Example:
        >>> is_crisis("I have nothing to live for"), is_crisis("My dog died.")
        (True, False)
    """
    return _patterns()[1].search(plain(text)) is not None or is_emergency(text)


_LIVELY = re.compile(
    r"\bit (?:is|was) so dead\b|\b(?:place|town|party|phone|battery|street|bar|shop|line) (?:is|was) (?:\w+ )?dead\b"
    r"|\bdead (?:end|line|battery|phone|easy|tired|slow|quiet)\b|\bi am (?:half |so )?dead\b"
    r"|\bnobody (?:has )?died\b(?! but| except| apart)|\bkill(?:ing)? (?:some |the )?time\b"
)
"""Phrases in which a grave word is harmless: *it's so dead here*."""


@cache
def _patterns() -> tuple[re.Pattern[str], ...]:
    table: Any = load_yaml((files(__package__ or "") / FILE).read_text(encoding="utf-8"), FILE)
    grave = [*table["words"].split(), *table["phrases"], *table["crisis"]]
    return _any_of(grave), _any_of(table["crisis"]), _any_of(table["medical"]), _any_of(table["emergency"])


def _any_of(expressions: list[str]) -> re.Pattern[str]:
    return re.compile(rf"\b(?:{'|'.join(expressions)})\b")
