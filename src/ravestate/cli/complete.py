"""The complete text agent: the modules that take part in any chat, on whichever platform."""

from __future__ import annotations

import argparse

from ravestate.cli import UsageError
from ravestate.errors import nearest

__all__ = ["COMPLETE", "add_arguments", "complete"]

COMPLETE = (
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
"""The modules of the complete text agent, without a platform."""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """The option that leaves something out."""
    parser.add_argument(
        "--without",
        action="append",
        default=[],
        metavar="MODULE",
        help="leave a module out of the complete agent (may be repeated)",
    )


def complete(options: argparse.Namespace) -> list[str]:
    """The names of its modules, without those that the options leave out.

    Raises:
        UsageError: It has no such module.
    """
    for name in options.without:
        if name not in COMPLETE:
            raise UsageError(f"--without {name}: the agent has no such module{nearest(name, COMPLETE)}")
    return [name for name in COMPLETE if name not in options.without]
