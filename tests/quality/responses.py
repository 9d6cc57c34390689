"""Measure the replies that the listening skill chooses for an utterance.

The authors of `responses_rows.tsv` wrote whole conversations with a companion, and chose the kinds of reply that suit
each utterance. A ``!`` marks a kind that only seems to suit. A reader graded about eleven replies to each utterance in
`responses_grades.tsv`: 0 does not suit, 1 does no harm, 2 is good. The network is not trained on these utterances.
"""

from __future__ import annotations

from quality import measure
from quality.measure import Result
from ravestate.language.normal import normalise
from ravestate.language.replies import replies
from ravestate.modules.skill.wildtalk.listening.material import material
from ravestate.modules.skill.wildtalk.listening.responses import responses_to

NAME, GRADED = "responses_rows", "responses_grades"


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


def graded() -> dict[str, dict[str, int]]:
    """Return the grades of replies: utterance → reply → grade."""
    found: dict[str, dict[str, int]] = {}
    for line in (measure.HERE / f"{GRADED}.tsv").read_text(encoding="utf-8").splitlines():
        text, *grades = line.split("\t")
        found[text] = {grade[2:]: int(grade[0]) for grade in grades}
    return found


def results() -> list[Result]:
    """Measure both sets. `measure.py` prints the results."""
    return [measured(), measured_grades()]


def measured() -> Result:
    """Return the shares of the chosen replies whose kinds suit, and whose kinds are marked as wrong."""
    replies().load()
    said: list[tuple[str, list[str], str]] = []
    for before, text, kinds in rows():
        found = responses_to(material(), normalise(text).unguessed, normalise(before).unguessed)
        said += [(text, kinds, one.kind.name) for one in found[:1]]
    suits = sum(name in kinds for _, kinds, name in said)
    wrong = [f"{text} -> {name}" for text, kinds, name in said if f"!{name}" in kinds]
    shares = {"suits": suits / len(said), "wrong": len(wrong) / len(said)}
    return Result(NAME, len(rows()), shares, wrong)


def measured_grades() -> Result:
    """Return how the readers graded the replies that the listener would choose among the graded ones."""
    replies().load()
    befores = {text: before for before, text, _ in rows()}
    chosen: list[tuple[str, str, int]] = []
    for text, grades in graded().items():
        before = normalise(befores[text]).unguessed
        found = responses_to(material(), normalise(text).unguessed, before)
        best = [one.line.text for one in found if one.line.text in grades]
        chosen += [(text, reply, grades[reply]) for reply in best[:1]]
    shares = {
        name: sum(one[2] == grade for one in chosen) / len(chosen) for grade, name in enumerate(("bad", "fair", "good"))
    }
    bad = [f"{text} -> {reply}" for text, reply, grade in chosen if grade == 0]
    return Result(GRADED, len(chosen), shares, bad)
