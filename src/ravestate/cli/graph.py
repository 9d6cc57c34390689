"""``ravestate graph``: the Signal-Rule-Slot diagram of an agent."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import Literal

from ravestate.cli import agent

__all__ = ["add_arguments", "run"]

FORMATS: dict[str, Literal["svg", "dot", "mermaid"]] = {
    ".svg": "svg",
    ".dot": "dot",
    ".gv": "dot",
    ".mmd": "mermaid",
    ".mermaid": "mermaid",
}


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """The command's options."""
    agent.add_arguments(parser, modules="*")
    parser.add_argument(
        "-o", "--output", metavar="FILE", help="where to write it; standard output by default"
    )
    parser.add_argument(
        "--format",
        choices=["svg", "dot", "mermaid"],
        help="by default what the output's name ends in, else svg",
    )


def run(options: argparse.Namespace) -> int:
    """Carry the command out."""
    from ravestate.policy.compile import compile_policy

    chosen = agent.load_agent(options)
    format: Literal["svg", "dot", "mermaid"] | None = options.format
    if format is None:
        format = FORMATS.get(Path(options.output).suffix) if options.output else "svg"
    if format is None:
        raise agent.UsageError(
            f"cannot tell the format of {options.output}: end its name in {', '.join(FORMATS)}, or write --format svg"
        )
    text = compile_policy(*chosen.modules).diagram(format)
    if options.output is None:
        print(text)
        return 0
    try:
        Path(options.output).write_text(text, encoding="utf-8")
    except OSError as error:
        raise agent.UsageError(f"cannot write {options.output}: {error.strerror}") from None
    print(f"wrote {options.output}")
    return 0
