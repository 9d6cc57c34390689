"""The diagram as text for Graphviz."""

from __future__ import annotations

from ravestate.draw.graph import EDGES, JUNCTIONS, NODES, Diagram, EdgeKind, Node, NodeKind, describe, used
from ravestate.draw.style import EDGE_STYLES, NODE_COLOURS, TEXT
from ravestate.draw.text import clean

_SHAPES: dict[NodeKind, str] = {
    "slot": "shape=box, peripheries=2, style=filled",
    "signal": 'shape=box, style="rounded,filled"',
    "rule": "shape=box, style=filled",
    "module": "shape=tab, style=filled",
    "and": "shape=circle, style=filled, fixedsize=true, width=0.3",
    "or": "shape=diamond, style=filled, fixedsize=true, width=0.36, height=0.36",
}
_LINES: dict[EdgeKind, str] = {
    "reads": "style=dashed, arrowhead=vee",
    "writes": 'style="bold", penwidth=2.4, arrowhead=normal',
    "emits": "style=solid, arrowhead=normal",
    "emits_detached": "style=dotted, penwidth=2, arrowhead=empty",
    "condition": "style=solid, arrowhead=vee",
    "condition_detached": "style=dotted, penwidth=2, arrowhead=empty",
}


def dot(diagram: Diagram) -> str:
    """Return a diagram in the DOT language. Names may contain any characters."""
    ids = {node.id: f"n{i}" for i, node in enumerate(diagram.nodes)}
    lines = ['digraph "Signal-Rule-Slot diagram" {', *_legend(diagram)]
    lines.append('  graph [rankdir=LR, charset="UTF-8", fontname="Helvetica", nodesep=0.25, ranksep=0.45];')
    lines.append(f'  node [fontname="Helvetica", fontsize=12, fontcolor="{TEXT.light}"];')
    lines.append(f'  edge [fontname="Helvetica", fontsize=9, fontcolor="{TEXT.light}", arrowsize=0.8];')
    for node in diagram.nodes:
        fill, stroke = NODE_COLOURS[node.kind]
        lines.append(
            f"  {ids[node.id]} [{_SHAPES[node.kind]}, label={_label(node)}, "
            f'fillcolor="{fill.light}", color="{stroke.light}", tooltip={_quoted(describe(node))}];'
        )
    for edge in diagram.edges:
        label = f", label={_quoted(f' {edge.label} ')}" if edge.label else ""
        lines.append(
            f"  {ids[edge.source]} -> {ids[edge.target]} [{_LINES[edge.kind]}, "
            f'color="{EDGE_STYLES[edge.kind].paint.light}", tooltip={_quoted(EDGES[edge.kind])}{label}];'
        )
    lines.append("}")
    return "\n".join(lines) + "\n"


def _legend(diagram: Diagram) -> list[str]:
    nodes, edges = used(diagram)
    return [
        *(f"  // {NODES[kind]}: {_SHAPES[kind]}" for kind in nodes),
        *(f"  // {EDGES[kind]}: {_LINES[kind]}" for kind in edges),
    ]


def _label(node: Node) -> str:
    if node.kind in JUNCTIONS:
        return _quoted(JUNCTIONS[node.kind])
    parts = [part for part in (node.module, node.label, node.note) if part]
    return '"' + "\\n".join(_escaped(part) for part in parts) + '"'


def _quoted(text: str) -> str:
    return f'"{_escaped(text)}"'


def _escaped(text: str) -> str:
    """Escape quotes, backslashes and ampersands; Graphviz would read an ampersand as an HTML entity."""
    return clean(text).replace("&", "&amp;").replace("\\", "\\\\").replace('"', '\\"')
