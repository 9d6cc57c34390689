"""``ravestate run``: run an agent until it ends, or until the user presses Ctrl-C."""

from __future__ import annotations

import argparse

from ravestate.cli import agent
from ravestate.cli.agent import listing
from ravestate.declare.module import Module
from ravestate.loading.spec import AgentSpec, with_required


def add_arguments(parser: argparse.ArgumentParser) -> None:
    agent.add_arguments(parser)
    parser.formatter_class = argparse.RawDescriptionHelpFormatter
    parser.epilog = listing()


def run(options: argparse.Namespace) -> int:
    from ravestate.runtime.run import run as run_modules

    chosen = agent.load_agent(options)
    agent.announce_platforms(chosen, options.command)
    run_modules(*chosen.modules, *_transcript(chosen), **chosen.options())
    return 0


def _transcript(chosen: AgentSpec) -> list[Module]:
    """Return a list with a module that prints a spoken conversation.

    The list is empty if the agent does not use `voiceio`, or if another platform shows the conversation.
    """
    modules = with_required(chosen.modules)
    names = {module.name for module in modules}
    if "voiceio" not in names or "conio" in names or any(module.serve is not None for module in modules):
        return []
    from ravestate.cli.voice import show
    from ravestate.testing.talking import transcript

    return [transcript(show)]
