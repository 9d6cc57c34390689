"""``ravestate chat``: the complete agent on the console."""

from __future__ import annotations

import argparse

from ravestate.cli import agent

__all__ = ["COMPLETE", "add_arguments", "run"]

COMPLETE = (
    "conio",
    "idle",
    "verbaliser",
    "interloc",
    "nlp",
    "ontology",
    "emotion",
    "hibye",
    "fillers",
    "agenda",
    "persqa",
    "agentqa",
    "genqa",
    "wildtalk",
)
"""The modules that take part in any chat."""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """The command's options."""
    agent.add_arguments(parser, modules="*")
    parser.add_argument(
        "--without",
        action="append",
        default=[],
        metavar="MODULE",
        help="leave a module out (may be repeated)",
    )


def run(options: argparse.Namespace) -> int:
    """Carry the command out."""
    from ravestate.errors import nearest
    from ravestate.runtime.run import run as run_modules

    for name in options.without:
        if name not in COMPLETE:
            raise agent.UsageError(f"--without {name}: the chat has no such module{nearest(name, COMPLETE)}")
    chosen = agent.load_agent(options, [name for name in COMPLETE if name not in options.without])
    run_modules(*chosen.modules, **chosen.options())
    return 0
