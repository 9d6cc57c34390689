"""``ravestate check``: what is wrong with an agent, and what is probably not meant."""

from __future__ import annotations

import argparse
import inspect
import sys

from ravestate.cli import agent

__all__ = ["add_arguments", "run"]


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """The command's options."""
    agent.add_arguments(parser, modules="*")
    parser.add_argument(
        "--utilities", action="store_true", help="list every rule with its utility in nats as well"
    )


def run(options: argparse.Namespace) -> int:
    """Carry the command out; 1 if there are faults."""
    from ravestate.errors import DeclarationError, DeclarationErrors
    from ravestate.modules import BUILT_IN
    from ravestate.policy.compile import compile_policy
    from ravestate.settings import load_settings

    try:
        chosen = agent.load_agent(options)
        policy = compile_policy(*chosen.modules)
        policy = policy.with_settings(load_settings(policy.modules, chosen.settings))
    except DeclarationErrors as faults:
        for fault in faults.exceptions:
            print(f"fault: {fault}", file=sys.stderr)
        return 1
    except DeclarationError as fault:
        print(f"fault: {fault}", file=sys.stderr)
        return 1
    # What a built-in module offers and this agent has no use or no rival for is no finding of its designer's.
    findings = [
        f
        for f in policy.findings(inspect.getsource)
        if f.kind not in ("unheard", "unraised", "cooldown")
        or not {name.split(":")[0] for name in (f.subject, *f.rules)} <= set(BUILT_IN)
    ]
    for finding in findings:
        print(finding)
    if options.utilities:
        width = max((len(name) for name in policy.rules), default=0)
        for name in policy.rules:
            print(f"{name:{width}}  {policy.utility(name):9.6f} nats")
    counts = f"{len(policy.rules)} rules, {len(policy.signals)} signals, {len(policy.slots)} slots"
    print(f"{counts}: no faults, {len(findings) or 'no'} finding{'' if len(findings) == 1 else 's'}")
    return 0
