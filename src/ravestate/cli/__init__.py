"""The command line: ``ravestate COMMAND ...``, one file a command.

Exit codes: 0 all well, 1 the agent has faults or failed, 2 the command was used wrongly. A user's mistake gives a
message, never a traceback.
"""

from __future__ import annotations

import argparse
import contextlib
import sys
from collections.abc import Sequence
from importlib import import_module
from typing import Any

from ravestate.errors import PlatformError, RavestateError, nearest

__all__ = ["main", "script"]

COMMANDS = {
    "chat": "talk with the complete agent on the console",
    "run": "run an agent from modules or an agent file",
    "board": "talk with an agent on a page and look inside it, or into a recorded trace",
    "check": "print an agent's faults, ties, rules that can never win, and signals nobody hears",
    "graph": "draw an agent's Signal-Rule-Slot diagram",
    "nlp": "show what the agent sees in a text: words, names, triples, yes or no, signals",
    "memory": "list, show, export and forget what an agent knows",
    "genqa": "read documents, and answer questions from them",
    "new": "write a small project to begin with",
}


def main(argv: Sequence[str] | None = None) -> int:
    """Run the command line.

    Args:
        argv: The arguments; the process's own by default.

    Returns:
        The exit code.
    """
    from ravestate import __version__

    parser = argparse.ArgumentParser(
        prog="ravestate", description="Design, run and inspect interactive agents.", allow_abbrev=False
    )
    parser.add_argument("--version", action="version", version=f"ravestate {__version__}")
    parser.add_argument("-v", "--verbose", action="count", default=0, help="say more; twice for everything")
    commands = parser.add_subparsers(
        dest="command", metavar="COMMAND", required=True, parser_class=CommandParser
    )
    arguments = sys.argv[1:] if argv is None else list(argv)
    for name, summary in COMMANDS.items():
        command = commands.add_parser(name, help=summary, description=summary.capitalize() + ".")
        if name in arguments:  # the others' options are not needed to list them
            import_module(f"ravestate.cli.{name}").add_arguments(command)
    options = parser.parse_args(arguments)
    _log(options.verbose)
    try:
        return import_module(f"ravestate.cli.{options.command}").run(options)
    except UsageError as error:
        print(f"ravestate {options.command}: {error}", file=sys.stderr)
        return 2
    except (RavestateError, PlatformError) as error:
        print(f"ravestate {options.command}: {error}", file=sys.stderr)
        return 1
    except KeyboardInterrupt:
        return 130
    except BrokenPipeError:
        return 0


def script() -> int:
    """The command ``ravestate``: `main`, and the end of the process.

    The interpreter ends threads that are left in the midst of what they do. Where that is a C++ library (a model that takes
    long to load on a busy machine), the process would be aborted; so it ends here, with all else in order.
    """
    import atexit
    import os
    import threading

    code = main()
    atexit._run_exitfuncs()  # pyright: ignore[reportPrivateUsage]  # they wait for what can be waited for
    if any(thread.daemon for thread in threading.enumerate()):
        for stream in (sys.stdout, sys.stderr):
            with contextlib.suppress(OSError, ValueError):
                stream.flush()
        os._exit(code)
    return code


class CommandParser(argparse.ArgumentParser):
    """Reads the arguments of one command, or of one of its actions, and tells the usage of that one if they are wrong."""

    def __init__(self, *, allow_abbrev: bool = False, **options: Any) -> None:
        super().__init__(allow_abbrev=allow_abbrev, **options)

    def parse_known_args(self, args: Any = None, namespace: Any = None) -> Any:  # type: ignore[override]  # which has overloads
        """Refuse here what is not known: else it would be left to the parser above, and that one's usage told."""
        options, unknown = super().parse_known_args(args, namespace)
        many = [action.dest for action in self._get_positional_actions() if action.nargs in ("+", "*")]
        if (
            many and unknown and all(not word.startswith("-") for word in unknown)
        ):  # some stood behind an option
            setattr(options, many[0], [*getattr(options, many[0]), *unknown])
            return options, []
        if unknown:
            name = unknown[0].partition("=")[0]
            alike = [o for o in self._option_string_actions if nearest(name.strip("-"), [o.strip("-")])]
            self.error(f"unrecognized arguments: {' '.join(unknown)}{nearest(name, alike)}")
        return options, unknown


class UsageError(RavestateError):
    """The command was used wrongly: exit code 2."""


def _log(verbosity: int) -> None:
    import logging

    logging.basicConfig(
        level=[logging.WARNING, logging.INFO, logging.DEBUG][min(verbosity, 2)],
        format="%(levelname)s %(name)s: %(message)s",
    )
