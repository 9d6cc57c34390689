"""The arguments by which a user names an agent: modules, an agent file, settings."""

from __future__ import annotations

import argparse
import ast
import shutil
import sys
import textwrap
from collections.abc import Iterable
from importlib.resources import files
from pathlib import Path

from ravestate.errors import UsageError
from ravestate.loading.spec import AgentSpec
from ravestate.modules import BUILT_IN


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments for an agent to a command's parser."""
    parser.add_argument(
        "modules",
        nargs="*",
        metavar="MODULE",
        help="a built-in name (hibye), an installed entry point, a dotted path (pkg.mod or pkg.mod:module), a file "
        "(./hello.py), or an agent file (agent.yaml); ravestate --help lists the built-in modules",
    )
    parser.add_argument("-f", "--file", metavar="FILE", help="an agent file: modules, settings, seed, patience")
    parser.add_argument(
        "--set",
        dest="sets",
        action="append",
        default=[],
        metavar="MODULE.KEY=VALUE",
        help="a setting, which overrides the file and the environment (may be repeated)",
    )
    parser.add_argument("--seed", type=int, help="the seed of all random choices; the same seed gives the same choices")


def load_agent(options: argparse.Namespace, first: Iterable[str] = (), *, announce: bool = False) -> AgentSpec:
    """Return the agent that the parsed arguments describe. The modules `first` come before the agent's modules.

    With `announce`, print which Python code the agent files run. Commands that only inspect an agent need this.

    Raises:
        UsageError: A module, file or setting is wrong. The message lists all mistakes of agent files and of ``--set``.
    """
    agent = AgentSpec()
    names = [(name, Path()) for name in first]
    files = [name for name in options.modules if name.endswith((".yaml", ".yml"))]
    for file in [*files, options.file] if options.file else files:
        found = agent.read(Path(file))
        code = [str(at / name) if name.endswith(".py") else name for name, at in found if name not in BUILT_IN]
        if announce and code:
            print(f"ravestate {options.command}: {file} runs Python code: {', '.join(code)}", file=sys.stderr)
        names += found
    names += [(name, Path()) for name in options.modules if name not in files]
    if not names and not agent.faults:
        raise UsageError("name a module, or an agent file that names modules")
    agent.load(names)
    for text in options.sets:
        agent.set(text)
    agent.check()
    if options.seed is not None:
        agent.seed = options.seed
    return agent


def listing() -> str:
    """Return a list of the built-in modules, each with the first line of its docstring, without importing any."""
    width = min(shutil.get_terminal_size().columns, 120) - 2
    lines = ["built-in modules:"]
    for name, folder in sorted(BUILT_IN.items()):
        source = (files("ravestate.modules") / folder / name / "__init__.py").read_text(encoding="utf-8")
        summary = (ast.get_docstring(ast.parse(source)) or "").partition("\n")[0]
        lines.append(textwrap.fill(summary, width, initial_indent=f"  {name:<13}", subsequent_indent=" " * 15))
    return "\n".join(lines)
