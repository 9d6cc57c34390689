"""``ravestate check``: the faults of an agent, and its findings, which are probable mistakes."""

from __future__ import annotations

import argparse
import inspect
import shutil
import sys
import textwrap
from typing import TYPE_CHECKING

from ravestate.cli import agent

if TYPE_CHECKING:
    from ravestate.policy.findings import Finding
    from ravestate.policy.policy import Policy


def add_arguments(parser: argparse.ArgumentParser) -> None:
    agent.add_arguments(parser)
    parser.epilog = "Exit code 1: the agent has faults, or a rule fails or does not do what its source says (findings: undeclared, unknown, await, assignment)."
    parser.add_argument("--utilities", action="store_true", help="also list every rule with its utility in nats")


def run(options: argparse.Namespace) -> int:
    """Run the command; return 1 if there are faults, or findings of the kinds in `BREAKING`, else 0."""
    from ravestate.errors import DeclarationError, DeclarationErrors
    from ravestate.modules import BUILT_IN
    from ravestate.policy.compile import compile_policy
    from ravestate.policy.findings import BREAKING
    from ravestate.settings import load_settings

    try:
        chosen = agent.load_agent(options, announce=True)
        policy = compile_policy(*chosen.modules)
        policy = policy.with_settings(load_settings(policy.modules, chosen.settings))
    except (DeclarationErrors, DeclarationError) as error:
        for fault in error.exceptions if isinstance(error, DeclarationErrors) else [error]:
            _print(f"fault: {fault}", error=True)
        return 1
    # It is not a mistake if a built-in module has signals and cooldowns that this agent does not use.
    findings = [
        f
        for f in policy.findings(inspect.getsource)
        if f.kind not in ("unheard", "unraised", "cooldown")
        or not {name.split(":")[0] for name in (f.subject, *f.rules)} <= set(BUILT_IN)
    ]
    findings += _doubtful_examples(policy)
    for finding in findings:
        _print(str(finding))
    if options.utilities:
        width = max((len(name) for name in policy.rules), default=0)
        for name in policy.rules:
            print(f"{name:{width}}  {policy.utility(name):9.6f} nats")
    sizes = {"rule": len(policy.rules), "signal": len(policy.signals), "slot": len(policy.slots)}
    counts = ", ".join(_count(number, noun) for noun, number in sizes.items())
    breaking = sum(finding.kind in BREAKING for finding in findings)
    means = "means" if breaking == 1 else "mean"
    note = f" ({breaking} {means} that a rule fails, or does not do what its source says)" if breaking else ""
    print(f"{counts}: no faults, {_count(len(findings), 'finding')}{note}")
    return 1 if breaking else 0


def _doubtful_examples(policy: Policy) -> list[Finding]:
    """Return a finding for each example that fits another intent (kind of utterance) as well as its own intent."""
    if "nlp" not in (module.name for module in policy.modules):
        return []
    from ravestate.modules.meta.nlp.intent import doubtful_examples, intents_of
    from ravestate.policy.findings import Finding

    mend = "give it to only one intent, or write examples that differ more"
    return [
        Finding("example", own, f"the example {text!r} of intent {own} fits intent {other} as well: {mend}")
        for text, own, other in doubtful_examples(intents_of(policy))
    ]


def _print(text: str, *, error: bool = False) -> None:
    """Print a message: wrapped with a hanging indent on a terminal, on one line elsewhere."""
    stream = sys.stderr if error else sys.stdout
    if stream.isatty():
        text = textwrap.fill(
            text,
            shutil.get_terminal_size().columns,
            subsequent_indent="    ",
            break_long_words=False,
            break_on_hyphens=False,
        )
    print(text, file=stream)


def _count(number: int, noun: str) -> str:
    return f"{number or 'no'} {noun}{'' if number == 1 else 's'}"
