"""The built-in modules in the help of the commands."""

from __future__ import annotations

import ast
import shutil
import textwrap
from importlib.resources import files

from ravestate.modules import BUILT_IN


def listing() -> str:
    """Return a list of the built-in modules, each with the first line of its docstring, without importing any."""
    width = min(shutil.get_terminal_size().columns, 120) - 2
    lines = ["built-in modules:"]
    for name, folder in sorted(BUILT_IN.items()):
        source = (files("ravestate.modules") / folder / name / "__init__.py").read_text(encoding="utf-8")
        summary = (ast.get_docstring(ast.parse(source)) or "").partition("\n")[0]
        lines.append(textwrap.fill(summary, width, initial_indent=f"  {name:<13}", subsequent_indent=" " * 15))
    return "\n".join(lines)
