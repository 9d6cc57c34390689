"""Rules and diagrams for tests: the paper's examples, large policies, and arbitrary diagrams from Hypothesis."""

from __future__ import annotations

from typing import Any

from hypothesis import strategies as st

from ravestate.declare.condition import Condition
from ravestate.declare.module import Module
from ravestate.declare.rule import Rule
from ravestate.draw.graph import Diagram, Edge, EdgeKind, Node, NodeKind

NODE_KINDS: tuple[NodeKind, ...] = ("slot", "signal", "rule", "module", "and", "or")
EDGE_KINDS: tuple[EdgeKind, ...] = (
    "reads",
    "writes",
    "emits",
    "emits_detached",
    "condition",
    "condition_detached",
)


def rule(module: Module, name: str, when: Condition, **options: Any) -> Rule[Any, Any]:
    """Declare a rule that does nothing."""

    def function(ctx: object) -> None: ...

    return module.rule(when=when, name=name, **options)(function)


def question_answering() -> Module:
    """The paper's example of rules that exclude each other and rules that are independent."""
    module = Module("qa")
    said, answer, face = module.slot("input"), module.slot("output"), module.slot("face")
    question = module.signal("question")
    rule(module, "Question", said.changed, reads=said, emits=question)
    rule(module, "Wildtalk", said.changed, reads=said, writes=answer)
    rule(module, "Qa", question, writes=answer)
    rule(module, "Emotion", said.changed, writes=face)
    return module


def games() -> Module:
    """The worked example of law L9."""
    module = Module("demo")
    said, answer, face = module.slot("input"), module.slot("output"), module.slot("face")
    question, about, play = (module.signal(name) for name in ("question", "about_agent", "games"))
    rule(module, "Question", said.changed, emits=question)
    rule(module, "AboutAgent", said.changed, emits=about)
    rule(module, "Games", said.changed, emits=play)
    rule(module, "Wildtalk", said.changed, writes=answer)
    rule(module, "Qa", question, writes=answer)
    rule(module, "Shy", about, writes=face)
    rule(module, "PersonalQa", question & about, writes=answer)
    rule(module, "OfferGames", question & play, writes=answer)
    return module


def prompting() -> Module:
    """The paper's loop of prompts, in which rules emit a detached signal."""
    module = Module("prompt")
    said, answer = module.slot("input"), module.slot("output")
    bored, prompted = module.signal("bored"), module.signal("prompted")
    rule(module, "Prompt", bored, writes=answer, emits=prompted, detached=True)
    rule(module, "PromptAgain", prompted.min_age(10.0).max_age(None), emits=prompted, detached=True)
    rule(module, "Answered", prompted.max_age(None) & said.changed, reads=said, writes=answer)
    return module


def many_rules(count: int) -> Module:
    """Declare rules with hubs, chains, conjunctions, alternatives, ages and loops, the same ones at each call."""
    module = Module("many")
    said, answer, memory = module.slot("input"), module.slot("output"), module.slot("memory")
    heard: list[Condition] = [said.changed, memory.changed]
    for i in range(count):
        when: Condition = heard[(i * 7) % min(len(heard), 2 + i // 8)]
        if i % 3 == 0:
            when = when & heard[(i * 5 + 1) % len(heard)]
        if i % 5 == 0:
            when = when | heard[(i * 11 + 1) % len(heard)]
        options: dict[str, Any] = {"reads": memory} if i % 4 == 1 else {}
        if i % 2:
            signal = module.signal(f"signal_{i}")
            heard.append(signal.min_age(2.0) if i % 10 == 1 else signal)
            rule(module, f"rule_{i}", when, emits=signal, detached=i % 12 == 5, **options)
        else:
            rule(module, f"rule_{i}", when, writes=answer if i % 8 else memory, **options)
    return module


def star(points: int, pairs: bool) -> Diagram:
    """Return rules that read one slot and write another. With `pairs`, only the first writes; each emits its own signal."""
    nodes = [Node("in", "slot", "input", "rawio"), Node("out", "slot", "intent", "verbaliser")]
    edges: list[Edge] = []
    for i in range(points):
        rule = f"rule_{i}"
        nodes.append(Node(rule, "rule", rule, "module"))
        edges.append(Edge("in", rule, "reads"))
        if pairs:
            nodes.append(Node(f"signal_{i}", "signal", f"signal_{i}", "module"))
            edges.append(Edge(rule, f"signal_{i}", "emits"))
        if not pairs or i == 0:
            edges.append(Edge(rule, "out", "writes"))
    return Diagram(tuple(nodes), tuple(edges))


ODD_NAMES = (
    'a"b',
    "<b>&amp;</b>",
    "]]>",
    "<!-- x --",
    "back\\slash\\N\\",
    "`**md**`",
    "1. list",
    "#35;",
    "{}|()[]",
    "end",
    "日本語",
    "👩‍👧",
    "\x00\x07\n\t",
    "\ud800",
    "\u202erev",
    "a" * 300,
    "",
)
names = st.one_of(
    st.sampled_from(ODD_NAMES),
    st.text(st.characters(codec=None), max_size=12),
    st.text("abc_", max_size=24),
)


@st.composite
def diagrams(draw: st.DrawFn, most_nodes: int = 14, most_edges: int = 30) -> Diagram:
    """Arbitrary nodes with arbitrary edges between them."""
    kinds = draw(st.lists(st.sampled_from(NODE_KINDS), max_size=most_nodes))
    nodes = tuple(Node(f"n{i}", kind, draw(names), draw(names), draw(names)) for i, kind in enumerate(kinds))
    edges: list[Edge] = []
    if len(nodes) > 1:
        ends = st.integers(0, len(nodes) - 1)
        for u, v in draw(st.lists(st.tuples(ends, ends), max_size=most_edges)):
            if u != v:
                label = draw(st.one_of(st.just(""), st.just("≥ 2 s"), names))
                edges.append(Edge(f"n{u}", f"n{v}", draw(st.sampled_from(EDGE_KINDS)), label))
    return Diagram(nodes, tuple(edges))
