"""``ravestate nlp``: the analysis of a text, as the agent sees it."""

from __future__ import annotations

import argparse
import dataclasses
import json
import sys
from collections.abc import Iterable, Iterator, Sequence
from typing import TYPE_CHECKING, Any

from ravestate.errors import UsageError

if TYPE_CHECKING:
    from ravestate.modules.meta.nlp.analysis import Analysis


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("text", nargs="*", metavar="TEXT", help="the text; by default, each line of standard input")
    parser.add_argument("--json", action="store_true", help="print one line of JSON for each text")
    parser.add_argument(
        "--pipeline",
        default="",
        metavar="NAME",
        help="a spaCy pipeline or its folder, as the setting nlp.pipeline",
    )
    parser.add_argument(
        "--agent-name",
        dest="agent_names",
        action="append",
        metavar="NAME",
        help="a name of the agent (may be repeated), as the setting nlp.agent_names",
    )


def run(options: argparse.Namespace) -> int:
    from ravestate.modules._text import printable
    from ravestate.modules.meta.nlp import Settings
    from ravestate.modules.meta.nlp.analysis import analyse
    from ravestate.modules.meta.nlp.pipeline import pipeline

    names: Sequence[str] = options.agent_names or Settings().agent_names
    texts: Iterable[str] = [" ".join(options.text)] if options.text else _lines()
    for number, text in enumerate(map(printable, texts)):  # without control codes for the terminal
        seen = analyse(text, pipeline(options.pipeline), names)
        if options.json:
            print(json.dumps(_plain(text, seen), ensure_ascii=False), flush=True)
        else:
            print(("\n" if number else "") + _table(seen), flush=True)
    return 0


def _lines() -> Iterator[str]:
    if sys.stdin.isatty():
        print("Type a text; Ctrl-D ends.", file=sys.stderr)
    try:
        for line in sys.stdin:
            if line.strip():
                yield line.rstrip("\n")
    except UnicodeDecodeError as error:
        raise UsageError(f"standard input is not UTF-8 text: {error}") from None


def _table(seen: Analysis) -> str:
    """Return the analysis as a text for people: the words in columns, then everything else."""
    rows = [("TOKEN", "LEMMA", "POS", "TAG", "DEP", "HEAD")]
    rows += [(w.text, w.lemma, w.pos, w.tag, w.dep, seen.tree.head(w).text) for w in seen.tree.words]
    widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
    table = ["  ".join(cell.ljust(width) for cell, width in zip(row, widths, strict=True)).rstrip() for row in rows]
    facts = [
        ("entities", ", ".join(f"{entity.text} ({entity.label})" for entity in seen.entities)),
        ("triples", " ".join(str(triple) for triple in seen.triples)),
        ("yes/no", _answer(seen)),
        ("question", seen.question.name if seen.question else ""),
        ("signals", ", ".join(_signals(seen))),
    ]
    return "\n".join([*table, "", *(f"{name:<9} {value or '-'}" for name, value in facts)])


def _answer(seen: Analysis) -> str:
    answer = seen.yesno
    if answer.unsure:
        return "unsure"
    if answer.yes or answer.no:
        return ("yes" if answer.yes else "no") + (", surely" if 2 in (answer.yes, answer.no) else ", weakly")
    return ""


def _signals(seen: Analysis) -> list[str]:
    flags = ("about_agent", "intent_play", "intent_hi", "intent_bye")
    raised = [flag for flag in flags if getattr(seen, flag)]
    return raised if seen.question is None else ["is_question", *raised]


def _plain(text: str, seen: Analysis) -> dict[str, Any]:
    """Return the analysis as data for programs."""

    def part(value: Any) -> Any:
        return value if isinstance(value, str) else {"asks_for": value.name}

    return {
        "text": text,
        "tokens": [
            {field: getattr(word, field) for field in ("text", "lemma", "pos", "tag", "dep", "head", "start")}
            for word in seen.tree.words
        ],
        "entities": [dataclasses.asdict(entity) for entity in seen.entities],
        "triples": [[part(t.subject), t.predicate, part(t.object)] for t in seen.triples],
        "yesno": dataclasses.asdict(seen.yesno),
        "question": seen.question.name if seen.question else None,
        "signals": _signals(seen),
    }
