"""The diagram as text for Graphviz: valid syntax, and the style of each kind of edge."""

import re

from hypothesis import given

from draw.examples import diagrams, prompting
from ravestate.draw.build import build
from ravestate.draw.dot import dot
from ravestate.draw.graph import Diagram, Edge, Node

TOKEN = re.compile(r'"(?:[^"\\\n]|\\.)*"|//[^\n]*|[A-Za-z0-9_.]+|->|[\[\]{}=,;]|\s+')


@given(diagrams())
def test_any_names_give_a_text_of_valid_tokens(diagram: Diagram) -> None:
    text = dot(diagram)
    at = 0
    while at < len(text):
        token = TOKEN.match(text, at)
        assert token is not None, text[at : at + 60]
        at = token.end()
    assert text.count(" -> ") >= len(diagram.edges)


def test_quotes_backslashes_and_entities_are_escaped() -> None:
    text = dot(Diagram((Node("a", "rule", 'say "\\N" &lt;', module="m\n"),), ()))
    assert 'label="m\ufffd\\nsay \\"\\\\N\\" &amp;lt;"' in text


def test_each_kind_of_edge_looks_different() -> None:
    nodes = (Node("a", "slot", "a"), Node("b", "rule", "b"))
    kinds = ("reads", "writes", "emits", "emits_detached", "condition", "condition_detached")
    looks = {dot(Diagram(nodes, (Edge("a", "b", kind),))).splitlines()[-2] for kind in kinds}
    assert len(looks) == len(kinds)


def test_a_detached_loop_has_dotted_lines_and_labels() -> None:
    text = dot(build(prompting().rules))
    assert 'digraph "Signal-Rule-Slot diagram" {' in text
    assert "style=dotted, penwidth=2, arrowhead=empty" in text
    assert 'label=" ≥ 10 s "' in text


def test_the_comments_explain_only_kinds_that_the_diagram_has() -> None:
    text = dot(Diagram((Node("a", "signal", "a"), Node("b", "rule", "b")), (Edge("a", "b", "condition"),)))
    comments = [line.split(":")[0].strip() for line in text.splitlines() if line.startswith("  //")]
    assert comments == ["// signal", "// rule", "// condition"]
