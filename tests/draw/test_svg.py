"""The diagram as SVG: a well-formed document that is accessible, repeatable and explained by a legend."""

import os
import re
import subprocess
import sys
from xml.etree import ElementTree

import pytest
from hypothesis import given

from draw.examples import diagrams, games, many_rules, prompting, rule
from ravestate.declare.module import Module
from ravestate.draw.build import build
from ravestate.draw.graph import EDGES, NODES, Diagram, Edge, Node
from ravestate.draw.style import stylesheet
from ravestate.draw.svg import svg
from ravestate.draw.text import clean

SVG = "{http://www.w3.org/2000/svg}"


def parsed(diagram: Diagram) -> ElementTree.Element:
    return ElementTree.fromstring(svg(diagram).encode("utf-8"))


def texts(root: ElementTree.Element, tag: str) -> list[str]:
    return [element.text or "" for element in root.iter(SVG + tag)]


def test_the_style_of_a_diagram_inside_a_page_does_not_reach_the_rest_of_the_page() -> None:
    selectors = re.findall(r"^([^@{}]+)\{", stylesheet(), re.MULTILINE)
    assert selectors
    assert [selector for selector in selectors if not selector.startswith(".srs ")] == []


@given(diagrams())
def test_any_names_give_a_well_formed_document(diagram: Diagram) -> None:
    titles = texts(parsed(diagram), "title")
    for node in diagram.nodes:
        assert any(clean(node.label) in title for title in titles)


def test_names_are_shown_unchanged() -> None:
    node = Node("a", "rule", '<b>&amp; "c"', module="m<n")
    root = parsed(Diagram((node,), ()))
    assert '<b>&amp; "c"' in texts(root, "text") and "m<n" in texts(root, "text")
    assert 'rule m<n:<b>&amp; "c"' in texts(root, "title")


def test_the_title_of_a_node_has_the_whole_name_even_if_it_is_long() -> None:
    root = parsed(Diagram((Node("a", "slot", "x" * 300),), ()))
    assert "slot " + "x" * 300 in texts(root, "title")
    assert not any("x" * 300 in text for text in texts(root, "text"))


def test_a_screen_reader_finds_a_title_and_a_description() -> None:
    root = parsed(build(games().rules))
    assert root.get("role") == "img"
    ids = {element.get("id"): element for element in root.iter()}
    title, description = (ids[name] for name in (root.get("aria-labelledby") or "").split())
    assert title.text == "Signal-Rule-Slot diagram"
    assert (description.text or "").startswith("3 slots, 4 signals, 8 rules. demo:input emits demo:input:changed.")


def test_each_edge_has_a_title_in_words() -> None:
    titles = texts(parsed(build(prompting().rules)), "title")
    assert "prompt:Answered reads prompt:input" in titles
    assert "prompt:Prompt writes prompt:output" in titles
    assert "prompt:PromptAgain emits detached prompt:prompted" in titles
    assert "prompt:prompted is condition of prompt:PromptAgain (≥ 10 s)" in titles
    assert "prompt:prompted is condition of a conjunction (any age)" in titles


def legend(diagram: Diagram) -> list[str]:
    (key,) = (group for group in parsed(diagram).iter(f"{SVG}g") if group.get("class") == "srs-legend")
    return [text.text or "" for text in key.iter(f"{SVG}text")]


def test_the_legend_of_a_picture_with_all_kinds_explains_the_whole_notation() -> None:
    nodes = tuple(Node(kind, kind) for kind in NODES)
    diagram = Diagram(nodes, tuple(Edge("slot", "rule", kind) for kind in EDGES))
    plain, junctions = list(NODES.values())[:4], list(NODES.values())[4:]
    assert legend(diagram) == [*plain, *EDGES.values(), *junctions]


def test_the_legend_explains_only_kinds_that_the_picture_has() -> None:
    assert legend(Diagram((), ())) == []
    module = Module("m")
    rule(module, "r", module.signal("a"))
    assert legend(build(module.rules)) == ["signal", "rule", "condition"]
    rule(module, "s", module.signal("b") & module.signal("c").detached(), emits=module.signal("d"))
    assert legend(build(module.rules)) == [
        "signal", "rule", "emits", "condition", "detached condition", "conjunction",
    ]  # fmt: skip


def test_the_picture_has_a_light_and_a_dark_mode_and_loads_nothing() -> None:
    text = svg(build(games().rules))
    assert "prefers-color-scheme:dark" in text
    assert "href" not in text and "@import" not in text and "<script" not in text
    assert re.findall(r"https?://[^\"]*", text) == ["http://www.w3.org/2000/svg"]


def test_the_document_defines_each_arrowhead_that_it_uses() -> None:
    text = svg(Diagram((Node("a", "slot"), Node("b", "rule")), (Edge("a", "b", "reads"),)))
    assert set(re.findall(r"url\(#([^)]*)\)", text)) <= set(re.findall(r'marker id="([^"]*)"', text))


def test_two_pictures_share_no_ids() -> None:
    one, two = svg(build(games().rules)), svg(build(prompting().rules))
    assert not set(re.findall(r' id="([^"]*)"', one)) & set(re.findall(r' id="([^"]*)"', two))


@pytest.mark.parametrize("format", ["svg", "dot", "mermaid"])
def test_the_same_rules_give_the_same_bytes_in_any_process(format: str) -> None:
    program = (
        "import sys; from draw.examples import many_rules; from ravestate.draw.build import build;"
        "from ravestate.draw import FORMATS;"
        f"sys.stdout.buffer.write(FORMATS[{format!r}](build(many_rules(40).rules)).encode())"
    )
    outputs = {
        subprocess.run(
            [sys.executable, "-c", program],
            env={**os.environ, "PYTHONHASHSEED": seed, "PYTHONPATH": os.pathsep.join(sys.path)},
            capture_output=True,
            check=True,
        ).stdout
        for seed in ("0", "1", "42", "4242")
    }
    assert len(outputs) == 1


def test_the_picture_of_120_rules_has_every_rule() -> None:
    diagram = build(many_rules(120).rules)
    assert sum(node.kind == "rule" for node in diagram.nodes) == 120
    titles = texts(parsed(diagram), "title")
    assert all(f"many:rule_{i}" in " ".join(titles) for i in range(120))
