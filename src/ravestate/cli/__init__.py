"""The command line: ``ravestate COMMAND ...``, one file for each command.

Exit codes: 0 for success, 1 if the agent has faults or the command fails, 2 for wrong use, 130 after Ctrl-C. A user's
mistake produces a message, never a traceback.
"""

from __future__ import annotations

import argparse
import logging
import sys
from collections.abc import Sequence
from importlib import import_module
from typing import Any

from ravestate.errors import RavestateError, UsageError, nearest

__all__ = ["UsageError", "main", "script"]

COMMANDS = {
    "chat": "talk with the complete agent on the console",
    "run": "run an agent from modules or an agent file",
    "board": "talk with an agent on a web page beside its debugger, or open a recorded trace",
    "check": "print an agent's faults, and findings such as ties, endless loops and undeclared writes",
    "graph": "draw the Signal-Rule-Slot diagram of the complete agent or of another agent",
    "nlp": "show what the agent sees in a text: words, names, triples, yes or no, signals",
    "memory": "list, show, export and forget what an agent knows",
    "model": "list, fetch and remove language models for small talk",
    "genqa": "read documents, and answer questions from them",
    "voice": "check the devices and models for speech, transcribe, speak, hold a conversation with a recording",
    "vision": "say whose faces are in pictures, learn a face, check the camera",
    "activity": "name the activity that a person performs in a video, teach an activity",
    "ros": "check an agent's topics and services, list the network's topics, show a topic's messages",
    "robot": "start a stand-in robot with a face on a web page, alone or controlled by an agent",
    "new": "write a small project to start from",
}


LAST_GRACE = 0.5
"""At its end, a command waits at most this many seconds for functions of rules that are still running."""


def main(argv: Sequence[str] | None = None) -> int:
    """Run the command line (by default with the arguments of the process), and return the exit code.

    After the help, the version or a wrong argument, argparse raises SystemExit instead.
    """
    from ravestate import __version__, compiled

    parser = argparse.ArgumentParser(
        prog="ravestate",
        description="Design, run and inspect interactive agents.",
        allow_abbrev=False,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument("--version", action="version", version=f"ravestate {__version__} ({compiled.build()})")
    parser.add_argument("-v", "--verbose", action="count", default=0, help="log more; repeat it to log everything")
    commands = parser.add_subparsers(dest="command", metavar="COMMAND", required=True, parser_class=CommandParser)
    arguments = sys.argv[1:] if argv is None else list(argv)
    if "--ros-args" in arguments or any(":=" in argument for argument in arguments):
        from ravestate.cli.ros_args import translate

        try:
            arguments = translate(arguments)
        except RavestateError as error:
            parser.error(str(error))
    if not {"-h", "--help"}.isdisjoint(arguments):
        from ravestate.cli.agent import listing

        parser.epilog = listing()
    for name, summary in COMMANDS.items():
        command = commands.add_parser(name, help=summary, description=summary.capitalize() + ".")
        if name in arguments:  # the help lists the other commands without their options
            import_module(f"ravestate.cli.{name}").add_arguments(command)
    first = next((word for word in arguments if not word.startswith("-")), "chat")
    if first not in COMMANDS and (hint := nearest(first, COMMANDS)):
        parser.error(f"there is no command {first!r}{hint}")
    options = parser.parse_args(arguments)
    verbosity: int = options.verbose
    level = [logging.WARNING, logging.INFO, logging.DEBUG][min(verbosity, 2)]
    logging.basicConfig(level=level, format="%(levelname)s %(name)s: %(message)s")
    try:
        code: int = import_module(f"ravestate.cli.{options.command}").run(options)
        sys.stdout.flush()  # if this fails, the user gets a message
        return code
    except UsageError as error:
        print(f"ravestate {options.command}: {error}", file=sys.stderr)
        return 2
    except RavestateError as error:
        print(f"ravestate {options.command}: {error}", file=sys.stderr)
        return 1
    except KeyboardInterrupt:
        return 130
    except BrokenPipeError:
        return 0
    except OSError as error:
        from ravestate.modules.platform.conio.console import FULL

        if error.errno not in FULL:
            raise
        print(f"ravestate {options.command}: the output cannot be written: {error.strerror}", file=sys.stderr)
        return 1


def script() -> int:
    """Run the command ``ravestate``, and end the process.

    At its end, the interpreter stops the remaining threads in the middle of their work. If a thread is inside a C++
    library, for instance to load a model, stopping it aborts the process. So if a daemon thread is left, this
    function ends the process itself, after everything else has been cleaned up. It waits for threads no longer than
    `LAST_GRACE`, which is enough for functions that save something.
    """
    import atexit
    import os
    import threading

    from ravestate.runtime import workers

    _open_streams()
    try:
        code = main()
    except SystemExit as ended:  # argparse raises it, for instance after the help
        code = int(ended.code or 0)
    workers.LAST_GRACE = LAST_GRACE
    atexit._run_exitfuncs()  # pyright: ignore[reportPrivateUsage]  # this runs the handlers that wait for threads
    for name in ("stdout", "stderr"):
        try:
            getattr(sys, name).flush()
        except (OSError, ValueError):
            setattr(sys, name, None)  # or else the interpreter reports the failure at its end
    if any(thread.daemon for thread in threading.enumerate()):
        os._exit(code)
    return code


def _open_streams() -> None:
    """Open closed standard streams on the null device. Show ``?`` for a character that stdout cannot encode."""
    import os

    for name, mode in (("stdin", "r"), ("stdout", "w"), ("stderr", "w")):
        if getattr(sys, name) is None:
            setattr(sys, name, open(os.devnull, mode, encoding="utf-8"))  # noqa: SIM115  # open until the process ends
    _reconfigure(sys.stdout, errors="replace")


def use_utf8() -> None:
    """Read and write the standard streams as UTF-8, whatever the locale, because programs exchange data with them."""
    _reconfigure(sys.stdin, encoding="utf-8", errors="strict")
    _reconfigure(sys.stdout, encoding="utf-8", errors="replace")


def _reconfigure(stream: Any, **options: str) -> None:
    if hasattr(stream, "reconfigure"):  # a stream in memory has no encoding
        stream.reconfigure(**options)


class CommandParser(argparse.ArgumentParser):
    """A parser for one command, or for one action of a command. Its errors show the usage of this command or action."""

    def __init__(self, *, allow_abbrev: bool = False, **options: Any) -> None:
        super().__init__(allow_abbrev=allow_abbrev, **options)

    def parse_known_args(self, args: Any = None, namespace: Any = None) -> Any:  # type: ignore[override]  # argparse has overloads
        """Parse the arguments. Refuse unknown ones here, because the main parser would show its own usage for them."""
        options, unknown = super().parse_known_args(args, namespace)
        many = [action.dest for action in self._get_positional_actions() if action.nargs in ("+", "*")]
        # Words after an option belong to the argument that takes several words.
        if many and unknown and all(not word.startswith("-") for word in unknown):
            setattr(options, many[0], [*getattr(options, many[0]), *unknown])
            return options, []
        if unknown:
            name = unknown[0].partition("=")[0]
            alike = [o for o in self._option_string_actions if nearest(name.strip("-"), [o.strip("-")])]
            hint = nearest(name, alike)
            if name in ("--port", "--host") and self.prog.endswith((" board", " run")):
                after = [*(args or sys.argv[1:])]
                after = after[after.index(name) + 1 :] if name in after else []
                value = unknown[0].partition("=")[2] or next(
                    (word for word in after[:1] if word[0] != "-"), name[2:].upper()
                )
                hint = f"; write --set webio.{name[2:]}={value}"
            self.error(f"unrecognized arguments: {' '.join(unknown)}{hint}")
        return options, unknown
