"""The diagram as a standalone SVG, which loads no other files and follows the viewer's light or dark mode."""

from __future__ import annotations

import hashlib
import html
from collections import Counter

from ravestate.draw.graph import EDGES, JUNCTIONS, NODES, Diagram, Edge, Node, NodeKind, describe
from ravestate.draw.layout import Box, lay_out
from ravestate.draw.legend import NARROWEST, legend
from ravestate.draw.shapes import heads, line, number, outline
from ravestate.draw.style import stylesheet
from ravestate.draw.text import LABEL, NAME, SMALL, clean, label_size, node_size, shown

_MARGIN = 24.0  # pixels around the picture and its legend
_SENTENCES = 60  # the maximum number of edges in the description


def svg(diagram: Diagram) -> str:
    """Return a diagram as SVG, to be encoded as UTF-8. The same diagram gives the same bytes.

    The document has a title and a description for screen readers, and a title for each node and edge.
    """
    layout = lay_out(diagram, {n.id: node_size(n) for n in diagram.nodes}, [label_size(e.label) for e in diagram.edges])
    prefix = "srs-" + hashlib.sha256(repr(diagram).encode("utf-8", "backslashreplace")).hexdigest()[:8]
    nodes = {node.id: node for node in diagram.nodes}
    top = _MARGIN + layout.height + (28.0 if diagram.nodes else 0.0)
    key = legend(diagram, _MARGIN, top, max(layout.width, NARROWEST), prefix)
    width = max(layout.width, key.width) + 2 * _MARGIN
    height = top + key.height + _MARGIN
    drawn = [
        '<?xml version="1.0" encoding="UTF-8"?>',
        f'<svg xmlns="http://www.w3.org/2000/svg" class="srs" role="img" aria-labelledby="{prefix}-title {prefix}-desc" '
        f'width="{number(width)}" height="{number(height)}" viewBox="0 0 {number(width)} {number(height)}">',
        f'<title id="{prefix}-title">Signal-Rule-Slot diagram</title>',
        f'<desc id="{prefix}-desc">{_text(_description(diagram, nodes))}</desc>',
        f"<style>{stylesheet()}</style>",
        f"<defs>{heads(prefix)}</defs>",
        '<rect class="srs-paper" width="100%" height="100%"/>',
        f'<g class="srs-edges" transform="translate({number(_MARGIN)} {number(_MARGIN)})">',
    ]
    for edge, points in zip(diagram.edges, layout.lines, strict=True):
        drawn.append(f"<g><title>{_text(_sentence(edge, nodes))}</title>{line(edge.kind, points, prefix)}</g>")
    drawn.append("</g>")
    drawn.append(f'<g class="srs-nodes" transform="translate({number(_MARGIN)} {number(_MARGIN)})">')
    for edge, box in zip(diagram.edges, layout.labels, strict=True):
        if box is not None:
            drawn.append(_label(edge, box, nodes))
    drawn.extend(_node(node, layout.boxes[node.id]) for node in diagram.nodes)
    drawn.append("</g>")
    if diagram.nodes:
        drawn.append(f'<path class="srs-line" d="M{number(_MARGIN)} {number(top - 10.0)}H{number(width - _MARGIN)}"/>')
    drawn.append(f'<g class="srs-legend" aria-label="legend">{key.elements}</g>')
    drawn.append("</svg>")
    return "\n".join(drawn) + "\n"


def _node(node: Node, box: Box) -> str:
    middle = number(box.x + box.width / 2)
    texts: list[str] = []
    if node.kind not in JUNCTIONS:
        y = box.y + 18.5
        small = f'<text class="srs-small" text-anchor="middle" x="{middle}"'
        if node.module:
            texts.append(f'{small} y="{number(y - 4.0)}">{_text(shown(node.module, SMALL))}</text>')
            y += 11.0
        texts.append(f'<text text-anchor="middle" x="{middle}" y="{number(y)}">{_text(shown(node.label, NAME))}</text>')
        if node.note:
            texts.append(f'{small} y="{number(y + 13.0)}">{_text(shown(node.note, SMALL))}</text>')
    return f"<g><title>{_text(describe(node))}</title>{outline(node.kind, box)}{''.join(texts)}</g>"


def _label(edge: Edge, box: Box, nodes: dict[str, Node]) -> str:
    x, y, w, h = (number(value) for value in (box.x, box.y, box.width, box.height))
    return (
        f'<g><title>{_text(_sentence(edge, nodes))}</title><rect class="srs-paper" x="{x}" y="{y}" width="{w}" height="{h}"/>'
        f'<text class="srs-label" text-anchor="middle" x="{number(box.x + box.width / 2)}" '
        f'y="{number(box.y + 11.7)}">{_text(shown(edge.label, LABEL))}</text></g>'
    )


def _sentence(edge: Edge, nodes: dict[str, Node]) -> str:
    """Return an edge as a sentence in the terms of the notation: subject, verb, object."""
    source, target = nodes[edge.source], nodes[edge.target]
    if edge.kind == "reads":
        words = f"{_name(target)} reads {_name(source)}"
    elif edge.kind in ("condition", "condition_detached"):
        words = f"{_name(source)} is {EDGES[edge.kind]} of {_name(target)}"
    else:
        words = f"{_name(source)} {EDGES[edge.kind]} {_name(target)}"
    return f"{words} ({edge.label})" if edge.label else words


def _name(node: Node) -> str:
    return node.name or f"a {describe(node)}"


def _description(diagram: Diagram, nodes: dict[str, Node]) -> str:
    counts = Counter(node.kind for node in diagram.nodes)
    kinds: list[NodeKind] = [kind for kind in NODES if counts[kind] and kind not in JUNCTIONS]
    words = ", ".join(f"{counts[kind]} {NODES[kind]}{'' if counts[kind] == 1 else 's'}" for kind in kinds)
    sentences = [f"{words or 'empty'}.", *(f"{_sentence(edge, nodes)}." for edge in diagram.edges[:_SENTENCES])]
    if len(diagram.edges) > _SENTENCES:
        sentences.append(f"And {len(diagram.edges) - _SENTENCES} more.")
    return " ".join(sentences)


def _text(text: str) -> str:
    return html.escape(clean(text), quote=False)
