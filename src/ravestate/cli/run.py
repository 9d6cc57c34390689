"""``ravestate run``: run an agent until it ends, or Ctrl-C."""

from __future__ import annotations

import argparse

from ravestate.cli import agent

__all__ = ["add_arguments", "run"]


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """The command's options."""
    agent.add_arguments(parser, modules="*")


def run(options: argparse.Namespace) -> int:
    """Carry the command out."""
    from ravestate.runtime.run import run as run_modules

    chosen = agent.load_agent(options)
    run_modules(*chosen.modules, **chosen.options())
    return 0
