"""After any operations, memory has the same data as a simple model in a dictionary."""

from __future__ import annotations

import tempfile
from pathlib import Path
from typing import Any

from hypothesis import settings
from hypothesis import strategies as st
from hypothesis.stateful import Bundle, RuleBasedStateMachine, initialize, invariant, rule

from ravestate.modules import ontology
from ravestate.modules.meta.ontology.opening import open_memory

Node = ontology.Node

TYPES = ("Person", "Robot", "City", "Place")
PROPERTIES = {
    "name": st.text(st.characters(exclude_categories=["Cs"]), max_size=8),
    "age": st.integers(-(2**63), 2**63 - 1),
    "born": st.dates(),
}
RELATIONS = {  # some of the built-in relations: source type, target type
    "lives_in": (("Person", "Robot"), ("City", "Place")),
    "friend_of": (("Person", "Robot"), ("Person", "Robot")),
    "likes": (("Person", "Robot"), TYPES),
    "located_in": (("City", "Place"), ("City", "Place")),
}


@st.composite
def contents(draw: st.DrawFn) -> tuple[str, dict[str, Any]]:
    type = draw(st.sampled_from(TYPES))
    known = ("name",) if type in ("City", "Place") else tuple(PROPERTIES)
    chosen = draw(st.sets(st.sampled_from(known)))
    return type, {name: draw(st.none() | PROPERTIES[name]) for name in sorted(chosen)}


class MemoryAgainstModel(RuleBasedStateMachine):
    """Each step runs both in memory and on a dictionary."""

    nodes = Bundle("nodes")

    def __init__(self) -> None:
        super().__init__()
        self.folder = tempfile.TemporaryDirectory()
        self.known: dict[str, Node] = {}
        self.relations: set[tuple[str, str, str]] = set()

    @initialize()
    def open(self) -> None:
        self.memory = open_memory(ontology.Settings(path=Path(self.folder.name) / "memory.lbug"))

    @rule()
    def open_again(self) -> None:
        self.memory.close().result(60)
        self.open()

    @rule(target=nodes, content=contents())
    def create(self, content: tuple[str, dict[str, Any]]) -> Any:
        type, properties = content
        node = self.memory.create(type, **properties).result(60)
        self.known[node.id] = node
        assert dict(node.properties) == {k: v for k, v in properties.items() if v is not None}
        return node

    @rule(node=nodes, content=contents())
    def save(self, node: Node, content: tuple[str, dict[str, Any]]) -> None:
        type, properties = content
        if node.type != type:
            return
        before = self.known.get(node.id, Node(node.type, {}, node.id))
        after = {k: v for k, v in {**before.properties, **properties}.items() if v is not None}
        saved = self.memory.save(Node(node.type, properties, node.id)).result(60)
        assert (saved.id, dict(saved.properties)) == (node.id, after)
        self.known[node.id] = saved

    @rule(content=contents())
    def find(self, content: tuple[str, dict[str, Any]]) -> None:
        type, wanted = content
        types = ("City", "Place") if type == "Place" else (type,)
        found = self.memory.find(type, **wanted).result(60)
        assert found == [
            node for node in sorted(self.known.values(), key=lambda node: node.id.split(":")[1])
            if node.type in types and all(node.get(name) == value for name, value in wanted.items())
        ]  # fmt: skip

    @rule(one=nodes, name=st.sampled_from(sorted(RELATIONS)), other=nodes, end=st.booleans())
    def relate(self, one: Node, name: str, other: Node, end: bool) -> None:
        sources, targets = RELATIONS[name]
        if not (one.id in self.known and other.id in self.known and one.type in sources and other.type in targets):
            return
        if end:
            self.memory.unrelate(one, name, other).result(60)
            self.relations.discard((one.id, name, other.id))
        else:
            self.memory.relate(one, name, other).result(60)
            self.relations.add((one.id, name, other.id))

    @rule(keep=nodes, duplicate=nodes)
    def merge(self, keep: Node, duplicate: Node) -> None:
        known = self.known
        fits = keep.type == duplicate.type or (keep.type, duplicate.type) == ("City", "Place")
        if keep.id == duplicate.id or not fits or not {keep.id, duplicate.id} <= known.keys():
            return
        merged = self.memory.merge(keep, duplicate).result(60)
        gone = known.pop(duplicate.id)
        assert dict(merged.properties) == {**gone.properties, **known[keep.id].properties}
        known[keep.id] = merged
        moved: set[tuple[str, str, str]] = set()
        for source, name, target in self.relations:
            if {source, target} == {keep.id, gone.id}:
                continue
            moved.add((keep.id if source == gone.id else source, name, keep.id if target == gone.id else target))
        self.relations = moved

    @rule(node=nodes)
    def forget(self, node: Node) -> None:
        gone = {one.id for one in self.memory.forget(node).result(60)}
        if node.id not in self.known:
            assert gone == set()
            return
        assert node.id in gone
        for source, _, target in self.relations:  # each node to which a remaining node is related still exists
            assert target not in gone - {node.id} or source in gone
        for id in gone:
            del self.known[id]
        self.relations = {r for r in self.relations if r[0] not in gone and r[2] not in gone}

    @rule()
    def carry_over(self) -> None:
        """Load an export into another memory, which then must be equal."""
        document = self.memory.export().result(60)
        with tempfile.TemporaryDirectory() as folder:
            other = open_memory(ontology.Settings(path=Path(folder) / "other.lbug"))
            assert other.load(document).result(60) == len(self.known)
            assert other.export().result(60) == document
            other.close().result(60)

    @invariant()
    def both_hold_the_same(self) -> None:
        if not hasattr(self, "memory"):
            return
        document = self.memory.export().result(60)
        assert {node["id"] for node in document["nodes"]} == self.known.keys()
        assert {(r["from"], r["relation"], r["to"]) for r in document["relations"]} == self.relations
        for node in self.known.values():
            assert self.memory.get(node.id).result(60) == node

    def teardown(self) -> None:
        if hasattr(self, "memory"):
            self.memory.close().result(60)
        self.folder.cleanup()


MemoryAgainstModel.TestCase.settings = settings(max_examples=8, stateful_step_count=15, deadline=None)
test_memory_holds_what_its_model_holds = MemoryAgainstModel.TestCase
