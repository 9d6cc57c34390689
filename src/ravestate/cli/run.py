"""``ravestate run``: run an agent until it ends, or until the user presses Ctrl-C."""

from __future__ import annotations

import argparse

from ravestate.cli import agent
from ravestate.cli.agent import listing


def add_arguments(parser: argparse.ArgumentParser) -> None:
    agent.add_arguments(parser)
    parser.formatter_class = argparse.RawDescriptionHelpFormatter
    parser.epilog = listing()


def run(options: argparse.Namespace) -> int:
    from ravestate.runtime.run import run as run_modules

    chosen = agent.load_agent(options)
    agent.announce_platforms(chosen, options.command)
    run_modules(*chosen.modules, **chosen.options())
    return 0
