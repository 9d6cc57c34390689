"""Measure how well the agent understands text, on the sets of this folder.

    python tests/quality/measure.py MODULE... [--misses]

`MODULE` is a dotted name. Its function `results` returns the results of its sets.
"""

import argparse
import importlib
import re
import sys
from collections.abc import Callable, Iterable
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from ravestate.yaml_text import load_yaml

HERE = Path(__file__).parent
NONE = "-"  # the label of a sentence to which the module of the set must not react

Triples = frozenset[tuple[str, str, str]]


@dataclass(frozen=True)
class Reply:
    """An answer of genqa, and whether the agent gave it as certain."""

    text: str
    sure: bool


@dataclass(frozen=True)
class Fact:
    """A question, with the content that its reply must have. If it has no answers and no number, silence is right."""

    question: str
    answers: tuple[str, ...] = ()
    number: float | None = None
    tolerance: float = 0.0

    @property
    def silent(self) -> bool:
        return not self.answers and self.number is None

    def answered_by(self, reply: str) -> bool:
        """Return whether the reply has one of the answers, or a figure close enough to the number."""
        if any(re.search(_pattern(answer), reply, re.IGNORECASE) for answer in self.answers):
            return True
        if self.number is None:
            return False
        allowed = self.tolerance * abs(self.number)
        return any(abs(figure - self.number) <= allowed for figure in _figures(reply))


@dataclass
class Result:
    """The results of one set: its shares, in the order in which the tool prints them, and the sentences with wrong results.

    `shares` are fractions from 0 to 1; the README defines them.
    """

    name: str
    cases: int
    shares: dict[str, float]
    misses: list[str] = field(default_factory=list[str])


# ------------------------------------------------------------------------------------------------ the sets


def read_yaml(file: Path) -> Any:
    """Return the value of a YAML file, read by the fast loader."""
    return load_yaml(file.read_text(encoding="utf-8"), str(file))


def labelled(name: str) -> list[tuple[str, str]]:
    """Return the sentences of a set, with one label each."""
    lines = (HERE / f"{name}.tsv").read_text(encoding="utf-8").splitlines()
    pairs = (line.split("\t") for line in lines if line and not line.startswith("#"))
    return [(text, label) for text, label in pairs]


def facts() -> list[Fact]:
    """Return the questions to genqa."""
    cases = read_yaml(HERE / "genqa.yaml")
    return [
        Fact(case["question"], tuple(case.get("answers", ())), case.get("number"), case.get("tolerance", 0.0))
        for case in cases
    ]


# ------------------------------------------------------------------------------------------- the measurements


def measure_triples(see: Callable[[str], Iterable[Iterable[str]]], cases: list[tuple[str, Triples]]) -> Result:
    """Measure triples. A sentence counts as exact if it has exactly the triples of the set."""
    right = shared = given = wanted = 0
    misses: list[str] = []
    for text, expected in cases:
        seen = frozenset((subject, predicate, thing) for subject, predicate, thing in see(text))
        given, wanted, shared = given + len(seen), wanted + len(expected), shared + len(seen & expected)
        if seen == expected:
            right += 1
        else:
            misses.append(f"{text!r}: {sorted(seen)} instead of {sorted(expected)}")
    shares = {"exact": _share(right, len(cases)), "F1 of single triples": _f1(shared, given, wanted)}
    return Result("triples", len(cases), shares, misses)


def measure_labels(name: str, see: Callable[[str], str], cases: list[tuple[str, str]]) -> Result:
    """Measure the share of right labels, and the F1 score of all labels except `-`.

    For the F1 score, a wrong label is a miss and a false alarm.
    """
    right = hits = given = 0
    misses: list[str] = []
    for text, expected in cases:
        seen = see(text)
        right += seen == expected
        hits += seen == expected != NONE
        given += seen != NONE
        if seen != expected:
            misses.append(f"{text!r}: {seen} instead of {expected}")
    wanted = sum(expected != NONE for _, expected in cases)
    shares = {"right": _share(right, len(cases)), "F1": _f1(hits, given, wanted)}
    return Result(name, len(cases), shares, misses)


def measure_facts(ask: Callable[[str], Reply | None], cases: list[Fact]) -> Result:
    """Measure answers and silences. The last share is of the certain answers only; the others are of all questions."""
    counts = dict.fromkeys(("answered right", "rightly silent", "wrongly silent", "wrong, unsure", "wrong, sure"), 0)
    sure = 0
    misses: list[str] = []
    for fact in cases:
        reply = ask(fact.question)
        sure += reply is not None and reply.sure
        if reply is None:
            outcome = "rightly silent" if fact.silent else "wrongly silent"
        elif not fact.silent and fact.answered_by(reply.text):
            outcome = "answered right"
        else:
            outcome = "wrong, sure" if reply.sure else "wrong, unsure"
        counts[outcome] += 1
        if outcome not in ("answered right", "rightly silent"):
            misses.append(f"{fact.question!r}: {outcome}" + (f": {reply.text!r}" if reply else ""))
    shares = {outcome: _share(count, len(cases)) for outcome, count in counts.items()}
    shares["wrong of the sure"] = _share(counts["wrong, sure"], sure)
    return Result("genqa", len(cases), shares, misses)


def table(results: Iterable[Result]) -> str:
    """Return the results as a table with one share per line."""
    lines = [f"{'set':<16} {'cases':>5}  {'':<22} {'share':>7}"]
    for result in results:
        for row, (what, share) in enumerate(result.shares.items()):
            head = f"{result.name:<16} {result.cases:>5}" if row == 0 else " " * 22
            lines.append(f"{head}  {what:<22} {share:>7.1%}")
    return "\n".join(lines)


def main(argv: list[str] | None = None) -> int:
    """Measure the sets of the modules on the command line."""
    parser = argparse.ArgumentParser(description="Measure how well text is understood.")
    parser.add_argument(
        "modules", nargs="+", metavar="MODULE", help="dotted name of a module with a function `results`"
    )
    parser.add_argument("--misses", action="store_true", help="also print each sentence with a wrong result")
    arguments = parser.parse_args(argv)
    results: list[Result] = [
        result for module in arguments.modules for result in importlib.import_module(module).results()
    ]
    print(table(results))
    if arguments.misses:
        for result in results:
            print(f"\n{result.name}: {len(result.misses)} wrong", *result.misses, sep="\n  ")
    return 0


# ------------------------------------------------------------------------------------------------- details


def _pattern(answer: str) -> str:
    """Return a pattern that matches whole words. A star at the end allows any ending of the word."""
    return rf"\b{re.escape(answer[:-1])}" if answer.endswith("*") else rf"\b{re.escape(answer)}\b"


_FIGURE = re.compile(r"(?<![\w.,])(\d{1,3}(?:,\d{3})+(?:\.\d+)?|\d+(?:\.\d+)?)(?:\s*(thousand|million|billion))?(?!\d)")
_SCALE = {"": 1.0, "thousand": 1e3, "million": 1e6, "billion": 1e9}


def _figures(text: str) -> list[float]:
    """Return the figures in a text: `1,448`, `244 million`, `0.5`."""
    return [float(digits.replace(",", "")) * _SCALE[scale] for digits, scale in _FIGURE.findall(text)]


def _share(part: int, whole: int) -> float:
    return part / whole if whole else 0.0


def _f1(hits: int, given: int, wanted: int) -> float:
    return _share(2 * hits, given + wanted)


if __name__ == "__main__":
    sys.exit(main())
