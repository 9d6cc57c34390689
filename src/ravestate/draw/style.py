"""Colours, dashes and heads of the notation. Slots are cyan, rules red, signals green, as in the paper.

Shapes differ too, for readers who cannot tell the colours apart. Slots have double sides, signals round corners, and each
kind of edge has its own line and head. The dark colours apply if the viewer prefers a dark colour scheme.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from ravestate.draw.graph import EdgeKind, NodeKind

Head = Literal["full", "hollow", "open"]


@dataclass(frozen=True, slots=True)
class Paint:
    """The two values of a colour: on a light and on a dark background."""

    light: str
    dark: str


@dataclass(frozen=True, slots=True)
class EdgeStyle:
    """The style of a kind of edge: its colour, width in pixels, dashes (in SVG's notation, or empty) and head."""

    paint: Paint
    width: float
    dashes: str
    head: Head


PAPER = Paint("#ffffff", "#14181d")
TEXT = Paint("#1b2026", "#e8ecf0")
_FAINT = Paint("#57606a", "#a3adb8")
_CYAN = Paint("#0b7796", "#4cc3e0")
_GREEN = Paint("#1f7a35", "#63c57a")
_RED = Paint("#b93128", "#f0837a")
_INK = Paint("#4b535c", "#b4bdc7")

NODE_COLOURS: dict[NodeKind, tuple[Paint, Paint]] = {
    "slot": (Paint("#d8f2fa", "#0f3644"), _CYAN),
    "signal": (Paint("#ddf4e1", "#153a20"), _GREEN),
    "rule": (Paint("#fde3e1", "#48201d"), _RED),
    "module": (Paint("#eef1f4", "#262d35"), _INK),
    "and": (PAPER, _INK),
    "or": (PAPER, _INK),
}
"""Kind of node → the colours of its fill and its outline."""

EDGE_STYLES: dict[EdgeKind, EdgeStyle] = {
    "reads": EdgeStyle(_CYAN, 1.5, "6 4", "open"),
    "writes": EdgeStyle(_CYAN, 2.4, "", "full"),
    "emits": EdgeStyle(_GREEN, 1.6, "", "full"),
    "emits_detached": EdgeStyle(_GREEN, 2.0, "0.1 5", "hollow"),
    "condition": EdgeStyle(_INK, 1.6, "", "open"),
    "condition_detached": EdgeStyle(_INK, 2.0, "0.1 5", "hollow"),
}
"""Kind of edge → its style. Dashes of length 0.1 look like dots, because line ends are round."""


def stylesheet() -> str:
    """Return the CSS of a standalone SVG.

    Each selector begins with the class ``srs`` of the root. So the style of an SVG inside a page does not reach the rest
    of the page.
    """
    rules: list[tuple[str, str, Paint, str]] = [
        (".srs .srs-paper", "fill", PAPER, ""),
        (".srs text", "fill", TEXT, f"font-family:{_FONTS};font-size:13px"),
        (".srs .srs-small", "fill", _FAINT, "font-size:10.5px"),
        (".srs .srs-label", "fill", TEXT, "font-size:10.5px"),
        (".srs .srs-line", "stroke", Paint("#d5dae0", "#39424c"), "fill:none"),
        (".srs .srs-sign", "stroke", TEXT, "fill:none;stroke-width:1.8;stroke-linecap:round;stroke-linejoin:round"),
    ]
    for node, (fill, stroke) in NODE_COLOURS.items():
        rules.append((f".srs .srs-{node}", "fill", fill, ""))
        rules.append((f".srs .srs-{node}", "stroke", stroke, "stroke-width:1.5"))
    for edge, style in EDGE_STYLES.items():
        name = edge.replace("_", "-")
        dashes = f";stroke-dasharray:{style.dashes}" if style.dashes else ""
        line = f"fill:none;stroke-width:{style.width:g};stroke-linecap:round;stroke-linejoin:round{dashes}"
        rules.append((f".srs .srs-{name}", "stroke", style.paint, line))
        fill = {"full": style.paint, "hollow": PAPER}.get(style.head)
        extra = "stroke-width:1.4;stroke-linejoin:round" + ("" if fill else ";fill:none")
        rules.append((f".srs .srs-{name}-head", "stroke", style.paint, extra))
        if fill:
            rules.append((f".srs .srs-{name}-head", "fill", fill, ""))
    light = [f"{selector}{{{what}:{paint.light}{';' + more if more else ''}}}" for selector, what, paint, more in rules]
    dark = [f"{selector}{{{what}:{paint.dark}}}" for selector, what, paint, _ in rules]
    return "\n".join([*light, "@media (prefers-color-scheme:dark){", *dark, "}"])


_FONTS = 'system-ui,-apple-system,"Segoe UI",Roboto,"Helvetica Neue",Arial,sans-serif'
