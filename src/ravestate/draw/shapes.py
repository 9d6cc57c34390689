"""The shapes of the notation as SVG elements, for the picture and its legend."""

from __future__ import annotations

from collections.abc import Sequence

from ravestate.draw.graph import EdgeKind, NodeKind
from ravestate.draw.layout import Box
from ravestate.draw.routing import Point
from ravestate.draw.style import EDGE_STYLES

_ROUND = 7.0  # pixels: radius of a turn
_CORNER = 10.0  # pixels: radius of a signal's corners
_HEAD = 9.0  # pixels: length of an arrow's head
_BACK = {"full": 6.0, "hollow": 8.5, "open": 1.5}  # kind of head → pixels between the end of the line and the tip


def number(value: float) -> str:
    """Return a coordinate (pixels) as short text, rounded to a hundredth."""
    text = f"{value:.2f}".rstrip("0").rstrip(".")
    return "0" if text == "-0" else text


def outline(kind: NodeKind, box: Box) -> str:
    """Return the outline of a node as SVG; a junction has its sign inside."""
    x, y, w, h = (number(value) for value in (box.x, box.y, box.width, box.height))
    middle_x, middle_y = box.x + box.width / 2, box.y + box.height / 2
    if kind == "slot":
        bars = "".join(f"M{number(at)} {y}v{h}" for at in (box.x + 5.0, box.x + box.width - 5.0))
        return f'<rect class="srs-slot" x="{x}" y="{y}" width="{w}" height="{h}"/><path class="srs-slot" d="{bars}"/>'
    if kind == "signal":
        corner = number(min(_CORNER, box.height / 2))
        return f'<rect class="srs-signal" x="{x}" y="{y}" width="{w}" height="{h}" rx="{corner}"/>'
    if kind in ("rule", "module"):
        corner = "1.5" if kind == "rule" else "4"
        return f'<rect class="srs-{kind}" x="{x}" y="{y}" width="{w}" height="{h}" rx="{corner}"/>'
    reach = box.width * 0.2
    rise = reach if kind == "and" else -reach
    sign = (
        f'<path class="srs-sign" d="M{number(middle_x - reach)} {number(middle_y + rise * 0.9)}'
        f"L{number(middle_x)} {number(middle_y - rise * 0.9)}"
        f'L{number(middle_x + reach)} {number(middle_y + rise * 0.9)}"/>'
    )
    if kind == "and":
        radius = number(box.width / 2)
        return f'<circle class="srs-and" cx="{number(middle_x)}" cy="{number(middle_y)}" r="{radius}"/>{sign}'
    corners = f"M{x} {number(middle_y)}L{number(middle_x)} {y}L{number(box.x + box.width)} {number(middle_y)}"
    return f'<path class="srs-or" d="{corners}L{number(middle_x)} {number(box.y + box.height)}Z"/>{sign}'


def heads(prefix: str) -> str:
    """Return the definitions of the arrowheads, one for each kind of edge; ids begin with `prefix`."""
    found: list[str] = []
    for kind, style in EDGE_STYLES.items():
        shape = "M1 1L9 5L1 9" + ("" if style.head == "open" else "Z")
        found.append(
            f'<marker id="{prefix}-{_dashed(kind)}" viewBox="0 0 10 10" markerWidth="10" markerHeight="10" '
            f'refX="{number(_HEAD - _BACK[style.head])}" refY="5" markerUnits="userSpaceOnUse" orient="auto">'
            f'<path class="srs-{_dashed(kind)}-head" d="{shape}"/></marker>'
        )
    return "".join(found)


def line(kind: EdgeKind, points: Sequence[Point], prefix: str) -> str:
    """Return the line of an edge as SVG, with round turns and a head; the tip of the head is at the last point."""
    back = _BACK[EDGE_STYLES[kind].head]
    (ax, ay), (bx, by) = points[-2], points[-1]
    length = ((bx - ax) ** 2 + (by - ay) ** 2) ** 0.5
    cut = min(back / length, 1.0) if length else 0.0
    path = [*points[:-1], (bx - (bx - ax) * cut, by - (by - ay) * cut)]
    commands = [f"M{_point(path[0])}"]
    for before, turn, after in zip(path, path[1:], path[2:], strict=False):
        into, out = _towards(turn, before), _towards(turn, after)
        commands.append(f"L{_point(into)}Q{_point(turn)} {_point(out)}")
    commands.append(f"L{_point(path[-1])}")
    name = _dashed(kind)
    return f'<path class="srs-{name}" marker-end="url(#{prefix}-{name})" d="{"".join(commands)}"/>'


def _towards(turn: Point, other: Point) -> Point:
    """Return the point on the way from `turn` to `other` at which a round turn begins or ends."""
    dx, dy = other[0] - turn[0], other[1] - turn[1]
    length = (dx * dx + dy * dy) ** 0.5
    share = min(_ROUND / length, 0.5) if length else 0.0
    return (turn[0] + dx * share, turn[1] + dy * share)


def _point(point: Point) -> str:
    return f"{number(point[0])} {number(point[1])}"


def _dashed(kind: EdgeKind) -> str:
    return kind.replace("_", "-")
