"""The tables of short forms, slips and contractions, from ``slips.yaml``."""

from __future__ import annotations

from importlib.resources import files
from typing import Any

from ravestate.yaml_text import load_yaml


def word_set(text: str) -> frozenset[str]:
    """Return the words of a text as a set."""
    return frozenset(text.split())


def _contractions(table: Any) -> dict[str, str]:
    verbs = {
        f"{subject}'{short}": f"{subject} {verb}"
        for subject in table["subjects"].split()
        for short, verb in table["verbs"].items()
    }
    return verbs | {f"{verb}n't": f"{verb} not" for verb in table["negated"].split()} | table["others"]


def _written(table: Any) -> dict[str, str]:
    written = {short: meant for shorts, meant in table["words"].items() for short in shorts.split(", ")}
    for firsts, seconds, meant in table["pairs"]:
        pairs = [(first, second) for first in firsts.split() for second in seconds.split()]
        written |= {f"{first} {second}": meant.format(first, second) for first, second in pairs}
    return written | {contraction.replace("'", " "): contraction for contraction in CONTRACTIONS if "'" in contraction}


_TABLE: Any = load_yaml((files("ravestate.language") / "slips.yaml").read_text(encoding="utf-8"), "slips.yaml")

CONTRACTIONS = _contractions(_TABLE["contractions"])
"""Contractions of written English, in lower case → the words that they stand for."""

WRITTEN = _written(_TABLE)
"""Short forms and common slips, of one to three words in lower case → their form in written English."""
