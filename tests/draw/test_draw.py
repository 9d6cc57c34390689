"""`policy.diagram` draws a policy in each format."""

import pytest

from draw.examples import games, rule
from ravestate.declare.module import Module
from ravestate.draw import FORMATS, draw
from ravestate.policy.compile import compile_policy


@pytest.mark.parametrize(("format", "start"), [("svg", "<?xml"), ("dot", "digraph"), ("mermaid", "flowchart LR")])
def test_a_policy_can_be_drawn_in_each_format(format: str, start: str) -> None:
    policy = compile_policy(games())
    text = policy.diagram(format)  # type: ignore[arg-type]
    assert text.startswith(start) and text == draw(policy.rules.values(), format)
    for name in ("OfferGames", "input:changed", "about_agent", "face"):
        assert name in text


def test_svg_is_the_default() -> None:
    policy = compile_policy(games())
    assert policy.diagram() == policy.diagram("svg")


def test_the_message_for_an_unknown_format_lists_the_known_formats() -> None:
    with pytest.raises(ValueError, match="'png' is unknown: write one of 'svg', 'dot', 'mermaid'"):
        draw(compile_policy(games()).rules.values(), "png")
    assert list(FORMATS) == ["svg", "dot", "mermaid"]


def test_a_policy_without_rules_has_a_diagram() -> None:
    policy = compile_policy(Module("empty"))
    assert all(policy.diagram(format) for format in ("svg", "dot", "mermaid"))


def test_the_diagram_includes_the_required_modules() -> None:
    base = Module("base")
    ping = base.signal("ping", input=True)
    rule(base, "sound", ping)
    user = Module("user", requires=[base])
    rule(user, "hear", ping)
    assert {"sound", "hear"} <= set(
        draw(compile_policy(user).rules.values(), "mermaid").replace('"', "<br/>").split("<br/>")
    )
