"""The complete text agent: the modules that take part in any chat, on whichever platform."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import Literal

from ravestate.cli import UsageError
from ravestate.errors import nearest

__all__ = ["COMPLETE", "add_arguments", "complete", "shown"]

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
    """The option that leaves something out; and in the help, where what the agent learns is kept."""
    parser.formatter_class = argparse.RawDescriptionHelpFormatter
    parser.epilog = (
        "What the complete agent learns of you stays on this machine:\n"
        f"  {shown('data', 'default', 'memory.lbug')} (--set ontology.path=FILE names another)\n"
        "To look at it: ravestate memory list, ravestate memory show NAME. To delete it: ravestate memory forget NAME,\n"
        'say "forget me", or delete the file.\n'
    )
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


def shown(kind: Literal["data", "state"], *parts: str) -> str:
    """A file among the user's own, as people write its path."""
    from ravestate.modules._folders import user_folder

    try:
        path, home = user_folder(kind).joinpath(*parts), Path.home()
    except RuntimeError:  # a user without a home
        return "/".join(parts)
    return f"~/{path.relative_to(home).as_posix()}" if path.is_relative_to(home) else str(path)
