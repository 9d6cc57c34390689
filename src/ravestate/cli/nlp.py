"""``ravestate nlp``: the analysis of a text, as the agent sees it."""

from __future__ import annotations

import argparse
import asyncio
import dataclasses
import json
import sys
from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Any

from ravestate.cli import use_utf8
from ravestate.errors import UsageError
from ravestate.language.bundled import ModelMissing

if TYPE_CHECKING:
    from ravestate.language.matcher import Match, Matcher
    from ravestate.modules.meta.nlp.analysis import Analysis

SHOWN = 5
"""The maximum number of intents (kinds of utterance) in the output."""
PATIENCE = 60.0
"""Wait this many seconds for a language model. The limit is high, because no user waits for an answer."""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("text", nargs="*", metavar="TEXT", help="the text; each line of standard input by default")
    parser.add_argument("--json", action="store_true", help="print one line of JSON for each text")
    parser.add_argument(
        "--pipeline",
        default="",
        metavar="NAME",
        help="a spaCy pipeline or its folder, as in the setting nlp.pipeline",
    )
    parser.add_argument(
        "--agent-name",
        dest="agent_names",
        action="append",
        metavar="NAME",
        help="a name of the agent (may be repeated), as in the setting nlp.agent_names",
    )
    parser.add_argument("--model", default="", metavar="NAME", help="a language model, as in the setting nlp.model")
    parser.add_argument(
        "--base-url", default="", metavar="URL", help="the model's server, as in the setting nlp.base_url"
    )
    parser.add_argument("-f", "--file", metavar="FILE", help="an agent file: show the scores of its intents")
    parser.add_argument(
        "-m",
        "--module",
        dest="modules",
        action="append",
        default=[],
        metavar="MODULE",
        help="a module with intents, to show their scores (may be repeated)",
    )


def run(options: argparse.Namespace) -> int:
    from ravestate.modules._text import printable
    from ravestate.modules.meta.nlp import Settings
    from ravestate.modules.meta.nlp.analysis import analyse, load_models
    from ravestate.modules.meta.nlp.pipeline import pipeline
    from ravestate.modules.meta.nlp.reading import model_reader

    if options.json:
        use_utf8()
    designed = _designed(options)
    try:
        load_models()
        if designed:
            designed.load()
    except ModelMissing as error:
        print(f"ravestate nlp: texts match only examples that they equal: {error}", file=sys.stderr)
    names: Sequence[str] = options.agent_names or Settings().agent_names
    texts: Iterable[str] = [" ".join(options.text)] if options.text else _lines()
    reader = (
        model_reader(options.model, options.base_url or Settings().base_url, None, PATIENCE) if options.model else None
    )
    with asyncio.Runner() as loop:
        for number, text in enumerate(map(printable, texts)):  # without control codes for the terminal
            reading = None if reader is None else loop.run(reader.read(text))
            seen = analyse(text, pipeline(options.pipeline), names, designed=designed, reading=reading)
            scores = _scores(designed, seen)
            if options.json:
                print(json.dumps(_plain(text, seen, scores), ensure_ascii=False), flush=True)
            else:
                print(("\n" if number else "") + _table(seen, scores), flush=True)
        if reader is not None:
            loop.run(reader.close())
    return 0


def _designed(options: argparse.Namespace) -> Matcher | None:
    """Return the matcher for the agent's intents; None if the arguments name no agent."""
    if not options.file and not options.modules:
        return None
    from ravestate.cli.agent import load_agent
    from ravestate.modules.meta.nlp.intent import intent_matcher, intents_of
    from ravestate.policy.compile import compile_policy

    options.sets, options.seed = [], None
    return intent_matcher([intents_of(compile_policy(*load_agent(options, announce=True).modules))])


def _scores(designed: Matcher | None, seen: Analysis) -> dict[str, float]:
    """Return the best scores of the agent's own intents (named ``module:intent``), highest first."""
    ranked = (
        [match for one in designed.ranked_all(seen.sentences) for match in one if ":" in match.name] if designed else []
    )
    best = {match.name: match.score for match in sorted(ranked, key=lambda match: match.score)}
    return dict(sorted(best.items(), key=lambda pair: -pair[1])[:SHOWN])


def _lines() -> Iterator[str]:
    if sys.stdin.isatty():
        print("Type a text; Ctrl-D ends.", file=sys.stderr)
    try:
        for line in sys.stdin:
            if line.strip():
                yield line.rstrip("\n")
    except UnicodeDecodeError as error:
        raise UsageError(f"standard input is not UTF-8 text: {error}") from None


def _table(seen: Analysis, scores: Mapping[str, float]) -> str:
    """Return the analysis as a text for people: the words in columns, then everything else."""
    rows = [("TOKEN", "LEMMA", "POS", "TAG", "DEP", "HEAD")]
    rows += [(w.text, w.lemma, w.pos, w.tag, w.dep, seen.tree.head(w).text) for w in seen.tree.words]
    widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
    table = ["  ".join(cell.ljust(width) for cell, width in zip(row, widths, strict=True)).rstrip() for row in rows]
    facts = [
        ("normal", seen.normal.text),
        ("entities", ", ".join(f"{entity.text} ({entity.label})" for entity in seen.entities)),
        ("triples", " ".join(str(triple) for triple in seen.triples)),
        ("yes/no", _answer(seen)),
        ("question", seen.question.name if seen.question else ""),
        ("acts", _matches(seen.acts)),
        ("feelings", _matches(seen.feelings)),
        ("signals", ", ".join(_signals(seen))),
        *([("intents", ", ".join(f"{name} {score:.2f}" for name, score in scores.items()))] if scores else []),
    ]
    return "\n".join([*table, "", *(f"{name:<9} {value or '-'}" for name, value in facts)])


def _answer(seen: Analysis) -> str:
    answer = seen.yesno
    if answer.unsure:
        return "unsure"
    if answer.yes or answer.no:
        return ("yes" if answer.yes else "no") + (", surely" if 2 in (answer.yes, answer.no) else ", weakly")
    return ""


def _matches(found: Mapping[str, Match]) -> str:
    return ", ".join(f"{name} {match.score:.2f}" for name, match in found.items())


def _signals(seen: Analysis) -> list[str]:
    flags = {"is_question": seen.question is not None, "about_agent": seen.about_agent}
    return [*(name for name, raised in flags.items() if raised), *seen.acted, *seen.intents]


def _plain(text: str, seen: Analysis, scores: Mapping[str, float]) -> dict[str, Any]:
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
        "normal": seen.normal.text,
        "acts": {name: match.score for name, match in seen.acts.items()},
        "feelings": {name: match.score for name, match in seen.feelings.items()},
        "intents": dict(scores),
        "signals": _signals(seen),
    }
