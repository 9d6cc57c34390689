"""``ravestate graph``: the Signal-Rule-Slot diagram of an agent."""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

from ravestate.cli import agent, complete, use_utf8
from ravestate.errors import UsageError, nearest

SUFFIXES = {".svg": "svg", ".dot": "dot", ".gv": "dot", ".mmd": "mermaid", ".mermaid": "mermaid"}
"""The ending of an output file's name → the format of the diagram."""

LARGE = 40
"""If an agent has more rules than this, by default each module becomes one box: else the text would be too small for a
screen."""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    agent.add_arguments(parser)
    complete.add_arguments(parser)
    parser.description = (
        "Draw the Signal-Rule-Slot diagram of an agent; without a MODULE, draw the complete agent that `ravestate "
        "chat` runs. The diagram has the slots and signals that some rule uses. A folded module is one box, and one "
        "arrow shows the strongest relation between two modules (from strong to weak: writes, emits, condition, reads)."
    )
    parser.add_argument("-o", "--output", metavar="FILE", help="the file to write; standard output by default")
    parser.add_argument(
        "--format",
        choices=["svg", "dot", "mermaid"],
        help="the format; by default, the ending of the file's name decides, and without a file it is svg",
    )
    parser.add_argument(
        "--fold",
        action=argparse.BooleanOptionalAction,
        default=None,
        help=f"draw each module as one box; the default for agents with more than {LARGE} rules",
    )
    parser.add_argument(
        "--unfold",
        action="append",
        default=[],
        metavar="MODULE",
        help="draw the rules of this module, and fold all other modules (may be repeated)",
    )


def run(options: argparse.Namespace) -> int:
    from ravestate.draw import FORMATS
    from ravestate.draw.build import build
    from ravestate.draw.fold import fold
    from ravestate.policy.compile import compile_policy

    named = bool(options.modules or options.file)
    if options.output is None and not options.format and sys.stdout.isatty():
        raise UsageError("a terminal cannot show the diagram: name an output file, e.g. -o agent.svg")
    if named and options.without:
        raise UsageError("--without works only on the complete agent: name no MODULE or file with it")
    if options.unfold and options.fold is False:
        raise UsageError("--unfold folds all other modules, and --no-fold folds no module: use only one of them")
    format = options.format or (SUFFIXES.get(Path(options.output).suffix) if options.output else "svg")
    if format is None:
        raise UsageError(
            f"cannot tell the format of {options.output}: end its name in {', '.join(SUFFIXES)}, or write --format svg"
        )
    first = [] if named else ["conio", *complete.names(options)]
    policy = compile_policy(*agent.load_agent(options, first, announce=True).modules)
    known = [module.name for module in policy.modules]
    for name in options.unfold:
        if name not in known:
            raise UsageError(f"--unfold {name}: the agent has no such module{nearest(name, known)}")
    diagram = build(policy.rules.values())
    if options.fold or options.unfold or (options.fold is None and len(policy.rules) > LARGE):
        diagram = fold(diagram, options.unfold)
        if not (options.fold or options.unfold):
            print(
                f"ravestate graph: folded {len(policy.rules)} rules into their modules: --unfold MODULE draws the "
                "rules of one module, and --no-fold draws all rules",
                file=sys.stderr,
            )
    text = FORMATS[format](diagram)
    if options.output is None:
        use_utf8()
        print(text)
        return 0
    try:
        Path(options.output).write_text(text, encoding="utf-8")
    except OSError as error:
        raise UsageError(f"cannot write {options.output}: {error.strerror}") from None
    print(f"wrote {options.output}")
    return 0
