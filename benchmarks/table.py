"""Figures as one table, and as JSON."""

from __future__ import annotations

import json
from collections.abc import Iterable, Sequence
from dataclasses import asdict
from pathlib import Path

from benchmarks.figures import Figure, Spread

__all__ = ["as_table", "value_text", "write_json", "write_page"]

HEAD = ("question", "measured", "ours", "against", "theirs", "ratio", "target", "reached")


def as_table(figures: Iterable[Figure]) -> str:
    """Return the figures as a Markdown table with aligned columns."""
    rows = [_row(figure) for figure in figures]
    widths = [max(map(len, column)) for column in zip(HEAD, *rows, strict=True)]
    lines = [_line(HEAD, widths), "|" + "|".join("-" * (width + 2) for width in widths) + "|"]
    return "\n".join(lines + [_line(row, widths) for row in rows])


def write_json(path: Path, machine: str, figures: Iterable[Figure]) -> None:
    """Write all figures as JSON, unrounded: seconds, bytes, shares, counts."""
    document = {"machine": machine, "figures": [asdict(figure) for figure in figures]}
    path.write_text(json.dumps(document, indent=1) + "\n", encoding="utf-8")


def write_page(path: Path, machine: str, figures: Sequence[Figure]) -> None:
    """Put the table of each question into a Markdown page, after the comment ``<!-- figures of QUESTION -->``.

    The table replaces everything up to the comment ``<!-- end of the figures -->``. If the page lacks the comments of a
    question, leave that question out.

    Raises:
        ValueError: The page has such comments for none of the questions.
    """
    page = path.read_text(encoding="utf-8")
    found = False
    for question in dict.fromkeys(figure.question for figure in figures):
        before, begin, rest = page.partition(f"<!-- figures of {question} -->\n")
        _, end, after = rest.partition("<!-- end of the figures -->\n")
        if end:
            table = as_table(figure for figure in figures if figure.question == question)
            page, found = f"{before}{begin}\n{table}\n\n{machine}.\n\n{end}{after}", True
    if not found:
        raise ValueError(f"{path} has no comment <!-- figures of QUESTION --> for these questions")
    path.write_text(page, encoding="utf-8")


def _row(figure: Figure) -> tuple[str, ...]:
    if figure.failed:
        return (figure.question, figure.what, "failed: " + figure.failed, "", "", "", figure.target, "NO")
    verdict = {True: "yes", False: "NO", None: ""}[figure.reached]
    return (
        figure.question,
        figure.what,
        value_text(figure.ours, figure.unit),
        figure.against,
        value_text(figure.theirs, figure.unit),
        _ratio(figure.ratio),
        figure.target,
        verdict,
    )


def _line(cells: Sequence[str], widths: Sequence[int]) -> str:
    return "| " + " | ".join(cell.ljust(width) for cell, width in zip(cells, widths, strict=True)) + " |"


def value_text(spread: Spread | None, unit: str) -> str:
    """Return a median with its unit; an empty text without a spread."""
    if spread is None:
        return ""
    value = spread.median
    if unit == "core":
        return f"{value:.3%}"
    if unit == "B":
        return f"{value / 1000:.3g} kB"
    if unit == "s":
        for scale, name in ((1, "s"), (1e-3, "ms"), (1e-6, "µs"), (1e-9, "ns")):
            if value >= scale:
                return f"{_digits(value / scale)} {name}"
    return _digits(value)


def _ratio(spread: Spread | None) -> str:
    if spread is None:
        return ""
    return f"{_digits(spread.median)} ({_digits(spread.low)}-{_digits(spread.high)})"


def _digits(value: float) -> str:
    if value >= 100:
        return f"{value:.0f}"
    if value >= 10:
        return f"{value:.1f}"
    return f"{value:.2f}" if value >= 0.1 else f"{value:.2g}"
