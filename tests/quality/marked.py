"""Measure the marked sentences: the tagger's author never saw them, and it is not trained on them."""

from __future__ import annotations

import importlib.util
import re
import sys
from collections.abc import Iterable
from pathlib import Path
from typing import Any

from quality import skills
from quality.measure import Result
from ravestate.modules.skill.persqa.topics import NATIONS, TOPICS
from ravestate.modules.skill.persqa.values import number_in

HERE = Path(__file__).parent
TOOL = HERE.parents[1] / "tools" / "networks" / "marks.py"

Told = tuple[str, bool, str]
"""A topic, whether the value is denied, and the value."""

_NEAR = ({"hobby", "liking"}, {"partner", "wife", "husband"}, {"child", "son", "daughter"})
"""Topics that a sentence may leave open: *I love climbing*."""


def _marks() -> Any:
    spec = importlib.util.spec_from_file_location("marks", TOOL)
    assert spec is not None and spec.loader is not None
    found = sys.modules["marks"] = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(found)
    return found


def told(text: str, context: str, wanted: set[Told]) -> set[Told]:
    """Return the facts that the user tells in a text.

    A description of work (*I drive a bus*) may also be a free statement. It counts as the wanted occupation.
    """
    meaning = skills.meaning_of(f"[asked {context}] {text}" if context else text)
    if meaning.kind not in ("told", "corrected"):
        return set()
    free = " ".join(one.text for one in meaning.free)
    described = {one for one in wanted if one[0] == "occupation" and " " in one[2] and _words(one[2]) <= _words(free)}
    return described | {
        ("favourite" if fact.topic.startswith("favourite ") else fact.topic, fact.gone, value)
        for fact in meaning.facts
        for value in fact.values or ("",)
    }


def fits(wanted: set[Told], found: set[Told]) -> bool:
    """Return whether all wanted facts were found, and no others. Values may differ in articles and endings."""
    return all(any(_same(one, other) for other in found) for one in wanted) and all(
        any(_same(one, other) for one in wanted) for other in found
    )


def _same(wanted: Told, found: Told) -> bool:
    near = wanted[0] == found[0] or any({wanted[0], found[0]} <= topics for topics in _NEAR)
    if not near or wanted[1] != found[1]:
        return False
    one, other = _words(wanted[2]), _words(found[2])
    return one <= other or other <= one or (wanted[1] and not other)


def _words(value: str) -> set[str]:
    value = NATIONS.get(value.lower(), value)
    value = number_in(value.lower()) or value
    words = re.findall(r"[\w'-]+", value.lower())
    return {re.sub(r"(?<=..)(?:ing|s|e)$", "", word) for word in words} - {"the", "a", "an", "my", "our"}


def results() -> Iterable[Result]:
    """Measure the set: sentences that tell facts, answers to a question, and sentences without a fact."""
    rows = list(_marks().read([HERE / "marked_rows.txt"]))
    assert {value.label for row in rows for value in row.values} <= {*TOPICS, "favourite"}
    skills.prepare(row.text for row in rows)
    groups: dict[str, list[tuple[str, set[Told], set[Told]]]] = {"told": [], "answers": [], "no fact": []}
    for row in rows:
        wanted = {(value.label, value.negated, row.text[value.start : value.end]) for value in row.values}
        group = "no fact" if not wanted else "answers" if row.context else "told"
        groups[group].append((row.text, wanted, told(row.text, row.context, wanted)))
    for group, cases in groups.items():
        misses = [
            f"{text!r}: {sorted(found)} instead of {sorted(wanted)}"
            for text, wanted, found in cases
            if not fits(wanted, found)
        ]
        yield Result(f"marked facts, {group}", len(cases), {"right": 1 - len(misses) / len(cases)}, misses)
