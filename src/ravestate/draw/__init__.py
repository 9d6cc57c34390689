"""Signal-Rule-Slot diagrams as SVG, DOT or Mermaid, without third-party packages.

The notation is that of the paper by Birkner et al., which README.md cites. `build` makes a diagram (`graph`) from
rules, and `fold` draws whole modules as one node each. `layout` places the nodes and lines. `svg`, `dot` and `mermaid`
write text.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import Any

from ravestate.declare.rule import Rule
from ravestate.draw.build import build
from ravestate.draw.dot import dot
from ravestate.draw.graph import Diagram
from ravestate.draw.mermaid import mermaid
from ravestate.draw.svg import svg

__all__ = ["FORMATS", "draw"]

FORMATS: dict[str, Callable[[Diagram], str]] = {"svg": svg, "dot": dot, "mermaid": mermaid}
"""Format → the function that writes a diagram in this format."""


def draw(rules: Iterable[Rule[Any, Any]], format: str = "svg") -> str:
    """Return the diagram of rules in one of `FORMATS`; for any other format, raise a ValueError."""
    writer = FORMATS.get(format)
    if writer is None:
        raise ValueError(f"diagram format {format!r} is unknown: write one of {', '.join(map(repr, FORMATS))}")
    return writer(build(rules))
