"""Signal-Rule-Slot diagrams in the paper's notation, as SVG, DOT or Mermaid, without third-party packages.

`build` makes a diagram (`graph`) from rules, `fold` folds modules, `layout` places the nodes and lines, and `svg`, `dot`
and `mermaid` write text.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

from ravestate.draw.build import build
from ravestate.draw.dot import dot
from ravestate.draw.graph import Diagram
from ravestate.draw.mermaid import mermaid
from ravestate.draw.svg import svg

if TYPE_CHECKING:
    from ravestate.policy.policy import Policy

__all__ = ["FORMATS", "draw"]

FORMATS: dict[str, Callable[[Diagram], str]] = {"svg": svg, "dot": dot, "mermaid": mermaid}
"""Format → the function that writes a diagram in this format."""


def draw(policy: Policy, format: str = "svg") -> str:
    """Return the diagram of a policy in one of `FORMATS`; for any other format, raise a ValueError."""
    writer = FORMATS.get(format)
    if writer is None:
        raise ValueError(f"diagram format {format!r} is unknown: write one of {', '.join(map(repr, FORMATS))}")
    return writer(build(policy.rules.values()))
