"""``ravestate chat``: the complete agent on the console."""

from __future__ import annotations

import argparse

from ravestate.cli import agent, complete


def add_arguments(parser: argparse.ArgumentParser) -> None:
    agent.add_arguments(parser)
    complete.add_arguments(parser)
    complete.explain_memory(parser)
    parser.epilog = (
        f"{parser.epilog}The terminal keeps the lines that you type in {complete.shown('state', 'history')}\n"
        "(--set conio.history=false keeps none).\n"
    )


def run(options: argparse.Namespace) -> int:
    from ravestate.runtime.run import run as run_modules

    chosen = agent.load_agent(options, ["conio", *complete.names(options)])
    complete.leave_out_absent(chosen, options.command)
    complete.choose_small_talk(chosen, options.command)
    run_modules(*chosen.modules, **chosen.options())
    return 0
