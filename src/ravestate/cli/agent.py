"""The arguments with which a user names an agent: modules, an agent file, settings."""

from __future__ import annotations

import argparse
import ast
import shutil
import sys
import textwrap
from collections.abc import Iterable
from importlib.resources import files
from pathlib import Path

from ravestate.errors import DeclarationErrors, UsageError
from ravestate.loading.spec import AgentSpec, with_required
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

    With `announce`, print which Python code the agent files run. Some commands that only inspect an agent use this.
    Without ``--set`` and without other mistakes, the values of the settings are not checked here.

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
    if options.sets:
        check_values(agent)
    if options.seed is not None:
        agent.seed = options.seed
    return agent


def check_values(agent: AgentSpec) -> None:
    """Check the values of the settings.

    Raises:
        UsageError: A value is wrong. The message lists all wrong values.
    """
    from ravestate.settings import load_settings

    try:
        load_settings(with_required(agent.modules), agent.settings)
    except DeclarationErrors as error:
        raise UsageError("\n  - ".join(["wrong settings:", *map(str, error.exceptions)])) from None


def announce_platforms(agent: AgentSpec, command: str) -> None:
    """Print which platforms have no user, because another platform serves all users."""
    modules = with_required(agent.modules)
    servers = [module.name for module in modules if module.serve is not None]
    # webio needs voiceio, too, for the microphone of its page.
    idle = [name for name in ("conio", "voiceio") if any(module.name == name for module in agent.modules)]
    idle = [name for name in idle if name != "voiceio" or "webio" not in servers]
    if servers and idle:
        print(
            f"ravestate {command}: {' and '.join(idle)} will have no user: {' and '.join(servers)} serves all users",
            file=sys.stderr,
        )


def check_voice(agent: AgentSpec) -> None:
    """If the agent listens to this machine's microphone, check before the greeting whether it can hear and speak.

    Raises:
        PlatformError: A device, a model or a package for speech is missing.
    """
    modules = with_required(agent.modules)
    if all(module.name != "voiceio" for module in modules) or any(module.serve is not None for module in modules):
        return
    from ravestate.modules import voiceio
    from ravestate.modules.platform.voiceio.checking import require
    from ravestate.settings import load_settings

    require(load_settings([voiceio.module], {"voiceio": agent.settings.get("voiceio", {})})["voiceio"])


def listing() -> str:
    """Return a list of the built-in modules, each with the first line of its docstring. Import none of them."""
    width = min(shutil.get_terminal_size().columns, 120) - 2
    lines = ["built-in modules:"]
    for name, folder in sorted(BUILT_IN.items()):
        source = (files("ravestate.modules") / folder / name / "__init__.py").read_text(encoding="utf-8")
        summary = (ast.get_docstring(ast.parse(source)) or "").partition("\n")[0]
        lines.append(textwrap.fill(summary, width, initial_indent=f"  {name:<13}", subsequent_indent=" " * 15))
    return "\n".join(lines)
