"""Measure the kinds of reply that the listening skill finds for an utterance.

The authors of `responses_rows.tsv` wrote whole conversations with a companion, and chose the kinds of reply that suit
each utterance. A ``!`` marks a kind that only seems to suit. The network is not trained on these utterances.
"""

from __future__ import annotations

from quality import measure
from quality.measure import Result
from ravestate.language.normal import normalise
from ravestate.modules.skill.wildtalk.listening.responses import LEAST, network

NAME = "responses_rows"


def rows() -> list[tuple[str, str, list[str]]]:
    """Return the utterances, each after the user's previous utterance, and with its kinds of reply."""
    found: list[tuple[str, str, list[str]]] = []
    before = ""
    for line in (measure.HERE / f"{NAME}.tsv").read_text(encoding="utf-8").splitlines():
        if line.startswith("#"):  # another conversation begins
            before = ""
            continue
        text, kinds = line.split("\t")
        found.append((before, text, kinds.split(", ")))
        before = text
    return found


def results() -> list[Result]:
    """Measure the set. `measure.py` prints the result."""
    return [measured()]


def measured() -> Result:
    """Return the shares of the utterances whose likeliest kind is likely enough; and of these, the shares that suit
    and that are marked as wrong."""
    network().load()
    found = [
        (text, kinds, *network().ranked(normalise(text).unguessed, normalise(before).unguessed)[0])
        for before, text, kinds in rows()
    ]
    said = [(text, kinds, name) for text, kinds, name, chance in found if chance >= LEAST]
    suits = sum(name in kinds for _, kinds, name in said)
    wrong = [f"{text} -> {name}" for text, kinds, name in said if f"!{name}" in kinds]
    shares = {"likely": len(said) / len(found), "suits": suits / len(said), "wrong": len(wrong) / len(said)}
    return Result(NAME, len(found), shares, wrong)
