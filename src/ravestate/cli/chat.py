"""``ravestate chat``: the complete agent on the console."""

from __future__ import annotations

import argparse

from ravestate.cli import agent, complete


def add_arguments(parser: argparse.ArgumentParser) -> None:
    agent.add_arguments(parser)
    complete.add_arguments(parser)
    complete.explain_memory(parser)
    parser.epilog = (
        f"{parser.epilog}The console saves your lines to {complete.shown('state', 'history')}\n"
        "(to save none: --set conio.history=false).\n"
    )


def run(options: argparse.Namespace) -> int:
    from ravestate.runtime.run import run as run_modules

    chosen = agent.load_agent(options, ["conio", *complete.names(options)])
    agent.check_voice(chosen)
    agent.announce_platforms(chosen, options.command)
    complete.leave_out_absent(chosen, options.command)
    complete.choose_small_talk(chosen, options.command)
    run_modules(*chosen.modules, **chosen.options())
    return 0
