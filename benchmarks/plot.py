"""Figures as a picture: a bar for Ravestate and for each peer, on a logarithmic axis. The SVG follows light and dark
mode."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from html import escape

from benchmarks.figures import Figure, Spread
from benchmarks.table import value_text
from ravestate.draw.style import NODE_COLOURS, PAPER, TEXT

__all__ = ["plot"]

FEWEST = 3
"""A measured quantity with at least this many peers gets a panel. The picture leaves out quantities with fewer
peers."""

WIDE, LEFT, RIGHT, ROW, HEAD = 760.0, 190.0, 80.0, 20.0, 34.0
"""In pixels: the picture's width, the room for names (left) and for values (right). Then the heights of a bar's row and
of a panel's title."""


def plot(figures: Iterable[Figure]) -> str:
    """Return a picture with a panel for each quantity that has enough peers. In a panel, the shortest time comes
    first."""
    panels: dict[str, dict[str, Spread]] = {}
    for figure in figures:
        if figure.unit == "s" and figure.ours is not None and figure.theirs is not None:
            bars = panels.setdefault(figure.what, {"Ravestate": figure.ours})
            bars.setdefault(figure.against, figure.theirs)
    shown = {what: bars for what, bars in panels.items() if len(bars) > FEWEST}
    times = [spread.median for bars in shown.values() for spread in bars.values()] or [1.0]
    low, high = math.floor(math.log10(min(times))), math.ceil(math.log10(max(times)))
    parts: list[str] = []
    y = 8.0
    for what, bars in shown.items():
        parts.append(_text(12, y + 20, what, "name", "start"))
        y += HEAD
        height = ROW * len(bars)
        for power in range(low, high + 1):
            x = _place(10.0**power, low, high)
            parts.append(f'<path class="rail" d="M{x:.1f} {y - 4:.1f}v{height + 4:.1f}"/>')
            parts.append(_text(x, y + height + 12, _power(power), "small", "middle"))
        for name, spread in sorted(bars.items(), key=lambda bar: bar[1].median):
            parts += _bar(name, spread, y, low, high)
            y += ROW
        y += 24
    return _document(y, parts)


def _bar(name: str, spread: Spread, y: float, low: int, high: int) -> Sequence[str]:
    """Return one row: name, bar, value."""
    end = _place(spread.median, low, high)
    kind = "ours" if name == "Ravestate" else "floor" if name.startswith("floor") else "theirs"
    return (
        _text(LEFT - 8, y + 13, name.split(":")[0], "name" if kind == "ours" else "", "end"),
        f'<rect class="{kind}" x="{LEFT:g}" y="{y + 2:.1f}" width="{end - LEFT:.1f}" height="{ROW - 5:g}" rx="2"/>',
        _text(end + 6, y + 13, value_text(spread, "s"), "", "start"),
    )


def _place(seconds: float, low: int, high: int) -> float:
    return LEFT + (math.log10(seconds) - low) / max(1, high - low) * (WIDE - LEFT - RIGHT)


def _power(power: int) -> str:
    return value_text(Spread.of([10.0**power]), "s").replace(".00", "").replace(".0", "")


def _text(x: float, y: float, words: str, kind: str, anchor: str) -> str:
    return f'<text class="{kind}" text-anchor="{anchor}" x="{x:.1f}" y="{y:.1f}">{escape(words, quote=False)}</text>'


def _document(high: float, parts: Sequence[str]) -> str:
    fills = {
        ".paper": PAPER,
        "text": TEXT,
        ".ours": NODE_COLOURS["rule"][1],
        ".theirs": NODE_COLOURS["slot"][1],
        ".floor": NODE_COLOURS["module"][1],
    }
    light = "".join(f"{selector}{{fill:{paint.light}}}" for selector, paint in fills.items())
    dark = "".join(f"{selector}{{fill:{paint.dark}}}" for selector, paint in fills.items())
    rail = NODE_COLOURS["module"][0]
    title = "Time from an input to its answer: shorter is better, and each line on the axis is ten times the one before"
    return "\n".join(
        [
            '<?xml version="1.0" encoding="UTF-8"?>',
            f'<svg xmlns="http://www.w3.org/2000/svg" role="img" width="{WIDE:g}" height="{high:g}" '
            f'viewBox="0 0 {WIDE:g} {high:g}">',
            f"<title>{title}</title>",
            "<style>text{font:12px system-ui,sans-serif}.name{font-weight:600}.small{font-size:10.5px}"
            f".rail{{stroke:{rail.light}}}{light}"
            f"@media (prefers-color-scheme:dark){{.rail{{stroke:{rail.dark}}}{dark}}}</style>",
            '<rect class="paper" width="100%" height="100%"/>',
            *parts,
            "</svg>\n",
        ]
    )
