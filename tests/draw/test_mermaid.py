"""The diagram as text for Mermaid: valid syntax, and labels for kinds without an arrow."""

import re

from hypothesis import given

from draw.examples import diagrams, games, many_rules
from ravestate.draw.build import build
from ravestate.draw.graph import Diagram, Edge, Node
from ravestate.draw.mermaid import mermaid

TEXT = r'"(?:[^"`<>&|\[\](){}%\\\n#;*.-]|#\d+;|<br/>)*"'
NODE = re.compile(rf"  n\d+(\[\[{TEXT}\]\]|\(\[{TEXT}\]\)|\[/?{TEXT}/?\]|\(\({TEXT}\)\)|\{{{TEXT}\}}):::srs-\w+")
EDGE = re.compile(rf"  n\d+ (-->|==>|-\.->)(\|{TEXT}\|)? n\d+")


@given(diagrams())
def test_any_names_give_lines_that_are_valid_statements(diagram: Diagram) -> None:
    first, *lines = mermaid(diagram).splitlines()
    assert first == "flowchart LR"
    lines = [line for line in lines if not line.startswith(("  %%", "  classDef ", "  linkStyle "))]
    count = len(diagram.nodes)
    assert all(NODE.fullmatch(line) for line in lines[:count])
    assert all(EDGE.fullmatch(line) for line in lines[count:])
    assert len(lines) == count + len(diagram.edges)


def test_special_characters_become_entities() -> None:
    assert '["m<br/>#60;b#62; #34;x#34; a_b"]' in mermaid(Diagram((Node("a", "rule", '<b> "x" a_b', "m"),), ()))


def test_edges_without_their_own_kind_of_arrow_have_a_label() -> None:
    nodes = (Node("a", "slot", "a"), Node("b", "rule", "b"))
    text = mermaid(Diagram(nodes, (Edge("a", "b", "reads"), Edge("b", "a", "writes"))))
    assert '  n0 -.->|"reads"| n1' in text and "  n1 ==> n0" in text


def test_the_worked_example_has_the_expected_nodes() -> None:
    text = mermaid(build(games().rules))
    assert '(["demo<br/>input:changed"]):::srs-signal' in text
    assert '[["demo<br/>output"]]:::srs-slot' in text
    assert text.count('(("∧"))') == 2


def test_a_comment_warns_of_more_edges_than_mermaid_draws_by_default() -> None:
    assert "maxEdges" in mermaid(build(many_rules(250).rules))
    assert "maxEdges" not in mermaid(build(games().rules))


def test_the_comments_explain_only_kinds_that_the_diagram_has() -> None:
    text = mermaid(Diagram((Node("a", "signal", "a"), Node("b", "rule", "b")), (Edge("a", "b", "condition"),)))
    comments = [line.split()[1] for line in text.splitlines() if line.startswith("  %%")]
    assert comments == ["signal", "rule", "condition"]
