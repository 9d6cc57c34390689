"""The complete text agent: all modules of a chat except the platform."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import Literal

from ravestate.errors import UsageError, nearest

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
    """Add the option ``--without``."""
    parser.add_argument(
        "--without",
        action="append",
        default=[],
        metavar="MODULE",
        help="leave a module out of the complete agent (may be repeated)",
    )


def explain_memory(parser: argparse.ArgumentParser) -> None:
    """Say in the help text where the agent keeps its memory."""
    parser.formatter_class = argparse.RawDescriptionHelpFormatter
    parser.epilog = (
        "The complete agent keeps its memory of you on this machine:\n"
        f"  {shown('data', 'default', 'memory.lbug')} (--set ontology.path=FILE names another)\n"
        "To look at it: ravestate memory list, ravestate memory show NAME. To delete it: ravestate memory forget NAME,\n"
        'say "forget me", or delete the file.\n'
    )


def names(options: argparse.Namespace) -> list[str]:
    """Return the names of the modules, without those that the options leave out.

    Raises:
        UsageError: The complete agent has no such module.
    """
    for name in options.without:
        if name not in COMPLETE:
            raise UsageError(f"--without {name}: the agent has no such module{nearest(name, COMPLETE)}")
    return [name for name in COMPLETE if name not in options.without]


def shown(kind: Literal["data", "state"], *parts: str) -> str:
    """Return the path of a file of the user, with ``~`` for their home."""
    from ravestate.modules._folders import user_folder

    try:
        path, home = user_folder(kind).joinpath(*parts), Path.home()
    except RuntimeError:  # the user has no home
        return "/".join(parts)
    return f"~/{path.relative_to(home).as_posix()}" if path.is_relative_to(home) else str(path)
