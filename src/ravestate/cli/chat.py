"""``ravestate chat``: the complete agent on the console."""

from __future__ import annotations

import argparse

from ravestate.cli import agent
from ravestate.cli import complete as whole

__all__ = ["add_arguments", "run"]


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """The command's options."""
    agent.add_arguments(parser, modules="*")
    whole.add_arguments(parser)
    parser.epilog = (
        f"{parser.epilog}Lines that you type on a terminal are kept in {whole.shown('state', 'history')}\n"
        "(--set conio.history=false keeps none).\n"
    )


def run(options: argparse.Namespace) -> int:
    """Carry the command out."""
    from ravestate.runtime.run import run as run_modules

    chosen = agent.load_agent(options, ["conio", *whole.complete(options)])
    run_modules(*chosen.modules, **chosen.options())
    return 0
