"""``ravestate genqa``: the documents that answer questions about the world."""

from __future__ import annotations

import argparse
import sys
from collections import Counter
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ravestate.cli import UsageError
from ravestate.errors import PlatformError

if TYPE_CHECKING:
    from ravestate.modules.skill.genqa import Settings
    from ravestate.modules.skill.genqa.collecting import Found, Outcome
    from ravestate.modules.skill.genqa.index import Index


def add_arguments(parser: argparse.ArgumentParser) -> None:
    _add_index(parser)
    actions = parser.add_subparsers(dest="action", metavar="ACTION", required=True)
    indexing = actions.add_parser(
        "index",
        help="read files and folders",
        description="Read files and folders: text, Markdown, HTML, PDF, JSON lines, ZIM. Run it again to read "
        "new and changed files, and to forget deleted ones; it also resumes after an interruption. Exit code 1: a "
        "file could not be read.",
    )
    listing = actions.add_parser("list", help="list what has been read")
    forgetting = actions.add_parser("forget", help="forget files and folders")
    for action in (indexing, forgetting):
        action.add_argument("paths", nargs="+", metavar="PATH", help="a file, or a folder with all that is in it")
    asking = actions.add_parser("ask", help="ask a question, and see what is found")
    asking.add_argument("question", nargs="+", metavar="QUESTION")
    for action in (indexing, listing, forgetting, asking):
        _add_index(action, later=True)


def _add_index(parser: argparse.ArgumentParser, *, later: bool = False) -> None:
    """Add the option ``--index``. With `later`, the option follows an action, and does not reset an earlier value."""
    parser.add_argument(
        "--index",
        metavar="FILE",
        default=argparse.SUPPRESS if later else None,
        help="the index file; by default RAVESTATE_GENQA_INDEX of the environment, or else a file in your data folder",
    )


def run(options: argparse.Namespace) -> int:
    try:
        return _run(options)
    except PlatformError as error:  # the message is for an agent's user; this command names the index by another option
        said = str(error).removeprefix("genqa: ").replace("--set genqa.index=", "--index ")
        raise PlatformError(said) from error


def _run(options: argparse.Namespace) -> int:
    settings = _settings(options.index)
    if options.action == "ask":
        return _ask(settings, " ".join(options.question))
    from ravestate.modules.skill.genqa.index import Index
    from ravestate.modules.skill.genqa.places import path_of

    path = path_of(settings)
    if options.action != "index" and not path.exists():
        print(f"nothing has been read yet: ravestate genqa index PATH (into {path})")
        return 0 if options.action == "list" else 1
    with Index(path) as index:
        if options.action == "index":
            return _index(index, options.paths)
        if options.action == "forget":
            return _forget(index, options.paths)
        return _list(index)


def _settings(index: str | None) -> Settings:
    """Return the settings of the module genqa, as for an agent without an agent file."""
    from ravestate.modules.skill import genqa
    from ravestate.settings import load_settings

    given: dict[str, Any] = {} if index is None else {"index": index}
    return load_settings([genqa.module], {"genqa": given})["genqa"]


def _index(index: Index, paths: Iterable[str]) -> int:
    from ravestate.modules.skill.genqa.collecting import find

    found = find((Path(path) for path in paths), index)
    counts: Counter[str] = Counter()
    passages = 0
    try:
        for outcome in _collected(found, index):
            counts[outcome.kind] += 1
            if outcome.kind in ("added", "replaced"):
                passages += outcome.passages
            if outcome.kind == "unreadable":
                _warn(f"{outcome.path}: {outcome.why}")
    except KeyboardInterrupt:
        _warn("interrupted; what was read so far is kept, and the same command continues")
        return 130
    told = ", ".join(f"{count} {kind}" for kind, count in counts.items()) or "nothing to read"
    print(f"{told}; {passages} new passages in {index.path}")
    return 1 if counts["unreadable"] else 0


def _collected(found: Found, index: Index) -> Iterator[Outcome]:
    """Yield the outcome of reading each file, with a progress bar in bytes on a terminal."""
    from ravestate.modules.skill.genqa.collecting import collect

    try:
        from tqdm import tqdm
    except ImportError as error:
        raise PlatformError("genqa needs tqdm to index: pip install 'ravestate[genqa]'") from error
    sizes: dict[Path, int] = {}
    for path, _ in found.files:
        try:
            sizes[path] = path.stat().st_size
        except OSError:
            sizes[path] = 0  # `collect` reports the error
    with tqdm(
        total=sum(sizes.values()), unit="B", unit_scale=True, disable=not sys.stderr.isatty(), leave=False
    ) as bar:

        def reading(path: Path, number: int) -> None:
            bar.set_postfix_str(f"{path.name[-40:]}, part {number + 1}", refresh=False)
            bar.update(0)  # this redraws the bar now and then

        for outcome in collect(found, index, reading):
            bar.update(sizes.get(outcome.path, 0))
            yield outcome


def _warn(text: str) -> None:
    from ravestate.modules._text import printable

    line = f"ravestate genqa: {printable(text)}"
    if sys.stderr.isatty():
        from tqdm import tqdm

        tqdm.write(line, file=sys.stderr)  # above the progress bar
    else:
        print(line, file=sys.stderr)


def _list(index: Index) -> int:
    from ravestate.modules._text import printable
    from ravestate.modules.skill.genqa.shipped import SHIPPED

    for file in index.files():
        name = "(the collection that comes with Ravestate)" if file.path == SHIPPED else file.path
        print(f"{file.passages:9,} passages  {printable(name)}")
    print(f"{index.size():9,} passages  in {index.path}")
    return 0


def _forget(index: Index, paths: Iterable[str]) -> int:
    import os

    from ravestate.modules.skill.genqa.collecting import within

    code = 0
    for path in paths:
        root = Path(os.path.abspath(Path(path).expanduser()))
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
    how = (
        "sure" if answer.confidence >= settings.sure else "unsure" if answer.confidence >= settings.unsure else "silent"
    )
    print(f"{printable(answer.text)}\n  source      {printable(answer.source)}")
    print(f"  confidence  {answer.confidence:.2f} ({how}: sure from {settings.sure}, unsure from {settings.unsure})")
    print("  read        score  covers")
    for candidate in answer.candidates:
        text = printable(candidate.text)
        print(
            f"            {candidate.score:7.1f}  {candidate.covered:5.0%}  {text[:100]}{'…' if len(text) > 100 else ''}"
        )
    return 0
