"""``python -m benchmarks [QUESTION ...] [--quick] [--json FILE]``: measure, and print one table."""

from __future__ import annotations

import argparse
import importlib
import sys
import time
from pathlib import Path

from benchmarks.bench import Bench
from benchmarks.figures import Figure
from benchmarks.machine import describe
from benchmarks.plot import plot
from benchmarks.questions import QUESTIONS
from benchmarks.table import as_table, write_json, write_page


def main() -> int:
    """Measure, and print the table. Return exit code 0 if every target is reached, or else 1; wrong use exits with 2."""
    options = _arguments()
    begin = time.monotonic()
    machine = describe()
    figures: list[Figure] = []
    for name in options.question or QUESTIONS:
        figures += _ask(name, options.quick)
    if sys.stderr.isatty():
        print("\r\033[K", end="", file=sys.stderr, flush=True)
    if options.json:
        write_json(options.json, machine, figures)
    if options.page:
        write_page(options.page, machine, figures)
        picture = options.page.with_suffix(".svg")
        if f"({picture.name})" in options.page.read_text(encoding="utf-8"):
            picture.write_text(plot(figures), encoding="utf-8")
    print(as_table(figures))
    print(f"\n{machine}. {time.monotonic() - begin:.0f} s{' (--quick)' if options.quick else ''}.")
    print("Medians over repetitions in which all contestants take turns; ratio = ours / theirs (quartiles).")
    missed = sum(figure.reached is False or bool(figure.failed) for figure in figures)
    promised = sum(figure.reached is not None or bool(figure.failed) for figure in figures)
    print(f"{promised - missed} of {promised} targets reached.")
    return 1 if missed else 0


def _ask(name: str, quick: bool) -> list[Figure]:
    question = importlib.import_module(f"benchmarks.questions.{name}")
    try:
        with Bench(name, quick) as bench:
            bench.progress(QUESTIONS[name])
            return list(question.ask(bench))
    except Exception as error:  # if one question fails, the others still get their figures
        print(f"\n{name} failed:\n{error}", file=sys.stderr)
        last = str(error).strip().splitlines()
        return [Figure(name, QUESTIONS[name], failed=(last[-1] if last else repr(error))[:60])]


def _arguments() -> argparse.Namespace:
    listed = "\n".join(f"  {name:12} {about}" for name, about in QUESTIONS.items())
    parser = argparse.ArgumentParser(
        prog="python -m benchmarks",
        description="Measure Ravestate and its peers (comparable programs) in one run. Some questions also have a floor:\n"
        "the time that bare code without rules takes for the same work.",
        epilog=f"questions:\n{listed}",
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument("question", nargs="*", help="the questions to measure; all by default")
    parser.add_argument("--quick", action="store_true", help="fewer repetitions: a first look in about a minute")
    parser.add_argument("--json", type=Path, metavar="FILE", help="write the figures to a file as well")
    parser.add_argument(
        "--page",
        type=Path,
        metavar="FILE",
        help="put the table of each question into this Markdown page, after the comment <!-- figures of QUESTION -->; "
        "if the page shows a picture with its own name (page.md: page.svg), draw this bar chart of the times as well",
    )
    options = parser.parse_args()
    for name in options.question:
        if name not in QUESTIONS:
            parser.error(f"no question {name!r}; there are: {', '.join(QUESTIONS)}")
    return options


if __name__ == "__main__":
    sys.exit(main())
