"""The width of a text, estimated without a font, and the sizes of nodes and labels.

The viewer picks the sans serif font. The widths here are those of a wide font, so that a text always fits into its box.
"""

from __future__ import annotations

import unicodedata

from ravestate.draw.graph import JUNCTIONS, Node

_CLASSES: tuple[tuple[float, str], ...] = (
    (0.32, "\"',.Iijl| "),
    (0.40, "!()-/:;[\\]frt"),
    (0.50, "*J`s"),
    (0.56, "?L_ckvxyz{}"),
    (0.64, "$0123456789FTabdeghnopqu"),
    (0.70, "ABEKPSVXYZ^"),
    (0.80, "#&+<=>CDGHNOQRUw~"),
    (0.90, "M"),
    (1.00, "%Wm"),
    (1.10, "@"),
)
"""Widths in ems (multiples of the font size), each with the characters of this width."""
_EMS: dict[str, float] = {character: ems for ems, characters in _CLASSES for character in characters}
_OTHER = 0.85  # the width of any other character, in ems
_WIDE = 1.05  # the width of an East Asian wide character, in ems


def width(text: str, size: float) -> float:
    """Return an estimate of the width of a text in pixels; the font's `size` is also in pixels."""
    return size * sum(_ems(character) for character in text)


def shorten(text: str, size: float, limit: float) -> str:
    """Cut the middle out of a text wider than `limit` pixels; both ends stay, because names often differ there."""
    if width(text, size) <= limit:
        return text
    room = limit - width("…", size)
    head = tail = 0
    used = 0.0
    while head + tail < len(text):
        front = head <= tail
        ems = _ems(text[head] if front else text[-1 - tail]) * size
        if used + ems > room:
            break
        used += ems
        head, tail = (head + 1, tail) if front else (head, tail + 1)
    return f"{text[:head]}…{text[len(text) - tail :]}"


def clean(text: str) -> str:
    """Replace each control character, line break, surrogate, noncharacter and direction control by U+FFFD."""
    return "".join("\ufffd" if _unprintable(character) else character for character in text)


def _unprintable(character: str) -> bool:
    code = ord(character)
    return (
        unicodedata.category(character) in ("Cc", "Cs", "Zl", "Zp")
        or code & 0xFFFE == 0xFFFE  # noncharacters, as Unicode defines them
        or 0xFDD0 <= code <= 0xFDEF
        or 0x202A <= code <= 0x202E
        or 0x2066 <= code <= 0x2069
    )


def _ems(character: str) -> float:
    known = _EMS.get(character)
    if known is not None:
        return known
    if unicodedata.combining(character) or unicodedata.category(character) == "Cf":
        return 0.0
    return _WIDE if unicodedata.east_asian_width(character) in "WF" else _OTHER


NAME = 13.0  # the font size of a node's name, in pixels
SMALL = 10.5  # the font size of a node's module and note, in pixels
LABEL = 10.5  # the font size of an edge's label, in pixels
LONGEST = 250.0  # the maximum width of a text in pixels; a wider text is cut, and the tooltip shows the whole text
_JUNCTION = 22.0  # pixels: width and height of a junction


def shown(text: str, size: float) -> str:
    """Return a text for drawing: without control characters, shortened if too long."""
    return shorten(clean(text), size, LONGEST)


def node_size(node: Node) -> tuple[float, float]:
    """Return the width and height of a node in pixels."""
    if node.kind in JUNCTIONS:
        return (_JUNCTION, _JUNCTION)
    texts = ((node.label, NAME), (node.module, SMALL), (node.note, SMALL))
    widest = max(width(shown(text, size), size) for text, size in texts)
    height = 28.0 + (10.0 if node.module else 0.0) + (12.0 if node.note else 0.0)
    return (float(round(max(44.0, widest + 24.0))), height)


def label_size(label: str) -> tuple[float, float] | None:
    """Return the width and height of an edge's label in pixels, or ``None`` if the label is empty."""
    return (float(round(width(shown(label, LABEL), LABEL) + 8.0)), 16.0) if label else None
