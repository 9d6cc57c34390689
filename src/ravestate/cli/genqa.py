"""``ravestate genqa``: the documents that answer questions about the world."""

from __future__ import annotations

import argparse
import os
import sys
from collections import Counter
from pathlib import Path
from typing import TYPE_CHECKING

from ravestate.cli import UsageError
from ravestate.errors import PlatformError

if TYPE_CHECKING:
    from ravestate.modules.skill.genqa import Settings
    from ravestate.modules.skill.genqa.index import Index


def add_arguments(parser: argparse.ArgumentParser) -> None:
    _add_index(parser, default=None)
    actions = parser.add_subparsers(dest="action", metavar="ACTION", required=True)
    indexing = actions.add_parser(
        "index",
        help="read files and folders",
        description="Read files and folders: text, Markdown, HTML, PDF, JSON lines, ZIM. Run the command again to read "
        "new and changed files, to forget deleted files, or to resume after an interruption. Exit code 1: a file could "
        "not be read.",
    )
    listing = actions.add_parser("list", help="list the files that have been read")
    forgetting = actions.add_parser("forget", help="forget files and folders")
    for action in (indexing, forgetting):
        action.add_argument(
            "paths", nargs="+", type=Path, metavar="PATH", help="a file, or a folder with everything in it"
        )
    asking = actions.add_parser("ask", help="ask a question, and see the passages found")
    asking.add_argument("question", nargs="+", metavar="QUESTION")
    for action in (indexing, listing, forgetting, asking):
        _add_index(action, default=argparse.SUPPRESS)  # a default here would replace an option given before the action


def _add_index(parser: argparse.ArgumentParser, default: str | None) -> None:
    parser.add_argument(
        "--index",
        metavar="FILE",
        default=default,
        help="the index file; by default the one in the variable RAVESTATE_GENQA_INDEX, or else one in your data folder",
    )


def run(options: argparse.Namespace) -> int:
    try:
        return _run(options)
    except PlatformError as error:  # name this command's option instead of that of `ravestate run`
        said = str(error).removeprefix("genqa: ").replace("--set genqa.index=", "--index ")
        raise PlatformError(said) from error


def _run(options: argparse.Namespace) -> int:
    from ravestate.modules.skill import genqa
    from ravestate.modules.skill.genqa.index import Index
    from ravestate.modules.skill.genqa.places import path_of
    from ravestate.settings import load_settings

    settings = load_settings([genqa.module], {"genqa": {"index": options.index} if options.index else {}})["genqa"]
    if options.action == "ask":
        return _ask(settings, " ".join(options.question))
    path = path_of(settings)
    if options.action != "index" and not path.exists():
        print(f"nothing has been read yet: to read files into {path}, run ravestate genqa index PATH")
        return 0 if options.action == "list" else 1
    with Index(path) as index:
        if options.action == "index":
            return _index(index, options.paths)
        return _forget(index, options.paths) if options.action == "forget" else _list(index)


def _index(index: Index, paths: list[Path]) -> int:
    from ravestate.modules.skill.genqa.collecting import collect, find

    try:
        from tqdm import tqdm
    except ImportError as error:
        raise PlatformError("genqa needs tqdm to index: pip install 'ravestate[genqa]'") from error
    counts: Counter[str] = Counter()
    passages = 0
    with tqdm(unit=" documents", disable=not sys.stderr.isatty(), leave=False) as bar:

        def reading(path: Path, number: int) -> None:
            bar.set_postfix_str(f"{path.name[-40:]}, part {number + 1}", refresh=False)
            bar.update()

        try:
            for outcome in collect(find(paths, index), index, reading):
                counts[outcome.kind] += 1
                passages += outcome.passages if outcome.kind in ("added", "replaced") else 0
                if outcome.kind == "unreadable":
                    bar.clear()
                    _warn(f"{outcome.path}: {outcome.why}")
        except KeyboardInterrupt:
            _warn("interrupted: to continue, run the same command again")
            return 130
    told = ", ".join(f"{count} {kind}" for kind, count in counts.items()) or "nothing to read"
    print(f"{told}; {passages} new passages in {index.path}")
    return 1 if counts["unreadable"] else 0


def _warn(text: str) -> None:
    from ravestate.modules._text import printable

    print(f"ravestate genqa: {printable(text)}", file=sys.stderr)


def _list(index: Index) -> int:
    from ravestate.modules._text import printable
    from ravestate.modules.skill.genqa.shipped import SHIPPED

    for file in index.files():
        name = "(the collection that comes with Ravestate)" if file.path == SHIPPED else file.path
        print(f"{file.passages:9,} passages  {printable(name)}")
    print(f"{index.size():9,} passages  in {index.path}")
    return 0


def _forget(index: Index, paths: list[Path]) -> int:
    from ravestate.modules.skill.genqa.collecting import within

    code = 0
    for path in paths:
        root = Path(os.path.abspath(path.expanduser()))
        known = [file.path for file in index.files() if within(file.path, root)]
        for name in known:
            index.forget(name)
        if known:
            print(f"forgot {path}: {len(known)} file{'' if len(known) == 1 else 's'}")
        else:
            _warn(f"nothing was read from {path}; see: ravestate genqa list")
            code = 1
    return code


def _ask(settings: Settings, question: str) -> int:
    from ravestate.modules._text import printable
    from ravestate.modules.skill.genqa.places import answerer_of

    if not question.strip():
        raise UsageError('ask something: ravestate genqa ask "What is the capital of Peru?"')
    answer = answerer_of(settings).answer(question)
    if not answer.text:
        print(f"no answer: {answer.reason}")
        return 0
    sure, unsure = settings.sure, settings.unsure
    how = "sure" if answer.confidence >= sure else "unsure" if answer.confidence >= unsure else "silent"
    print(f"{printable(answer.text)}\n  source      {printable(answer.source)}")
    print(f"  confidence  {answer.confidence:.2f} ({how}; the agent is sure from {sure}, unsure from {unsure})")
    print("  read        score  covers")
    for candidate in answer.candidates:
        text = printable(candidate.text)
        print(f"            {candidate.score:7.1f}  {candidate.covered:5.0%}  {text[:100]}{'…' * (len(text) > 100)}")
    return 0
