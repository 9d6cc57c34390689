"""The diagram as a Mermaid flowchart."""

from __future__ import annotations

from ravestate.draw.graph import EDGES, JUNCTIONS, NODES, Diagram, Edge, EdgeKind, Node, NodeKind, used
from ravestate.draw.style import EDGE_STYLES, NODE_COLOURS, TEXT
from ravestate.draw.text import clean

_SHAPES: dict[NodeKind, tuple[str, str]] = {
    "slot": ("[[", "]]"),
    "signal": ("([", "])"),
    "rule": ("[", "]"),
    "module": ("[/", "/]"),
    "and": ("((", "))"),
    "or": ("{", "}"),
}
_ARROWS: dict[EdgeKind, str] = {
    "reads": "-.->",
    "writes": "==>",
    "emits": "-->",
    "emits_detached": "-.->",
    "condition": "-->",
    "condition_detached": "-.->",
}
_WORDS: dict[EdgeKind, str] = {"reads": "reads", "emits_detached": "detached", "condition_detached": "detached"}
"""Kind of edge → words on its line: Mermaid has too few arrows to tell these kinds apart without colour."""

_MOST_EDGES = 500  # the maximum number of edges that Mermaid draws by default
_PLAIN = " _:,×≥≤–…"  # characters that need no escape, besides letters and digits


def mermaid(diagram: Diagram) -> str:
    """Return a diagram as a Mermaid flowchart. Names may contain any characters."""
    ids = {node.id: f"n{i}" for i, node in enumerate(diagram.nodes)}
    lines = ["flowchart LR", *_legend(diagram)]
    if len(diagram.edges) > _MOST_EDGES:
        lines.append(
            f"  %% {len(diagram.edges)} edges: Mermaid draws {_MOST_EDGES} unless initialised with a greater maxEdges"
        )
    for node in diagram.nodes:
        before, after = _SHAPES[node.kind]
        lines.append(f'  {ids[node.id]}{before}"{_label(node)}"{after}:::{_class(node.kind)}')
    for edge in diagram.edges:
        words = _words(edge)
        label = f'|"{_escaped(words)}"|' if words else ""
        lines.append(f"  {ids[edge.source]} {_ARROWS[edge.kind]}{label} {ids[edge.target]}")
    for kind, (fill, stroke) in NODE_COLOURS.items():
        lines.append(f"  classDef {_class(kind)} fill:{fill.light},stroke:{stroke.light},color:{TEXT.light}")
    for kind, style in EDGE_STYLES.items():
        numbers = [str(i) for i, edge in enumerate(diagram.edges) if edge.kind == kind]
        if numbers:
            lines.append(f"  linkStyle {','.join(numbers)} stroke:{style.paint.light},stroke-width:{style.width:g}px")
    return "\n".join(lines) + "\n"


def _legend(diagram: Diagram) -> list[str]:
    nodes, edges = used(diagram)
    return [
        *(f"  %% {NODES[kind]} {' '.join(_SHAPES[kind])}" for kind in nodes),
        *(f"  %% {EDGES[kind]} {_ARROWS[kind]} {EDGE_STYLES[kind].paint.light}" for kind in edges),
    ]


def _class(kind: NodeKind) -> str:
    return f"srs-{kind}"


def _label(node: Node) -> str:
    if node.kind in JUNCTIONS:
        return JUNCTIONS[node.kind]
    return "<br/>".join(_escaped(part) for part in (node.module, node.label, node.note) if part)


def _words(edge: Edge) -> str:
    words = _WORDS.get(edge.kind, "")
    if edge.kind == "condition_detached" and edge.label.startswith("until"):
        words = ""  # an `until` condition holds no spikes, so the word "detached" would mislead
    return ", ".join(word for word in (words, edge.label) if word)


def _escaped(text: str) -> str:
    """Return the text with numeric entities for all characters that Mermaid, Markdown or HTML might interpret."""
    return "".join(
        character if character.isalnum() or character in _PLAIN else f"#{ord(character)};" for character in clean(text)
    )
