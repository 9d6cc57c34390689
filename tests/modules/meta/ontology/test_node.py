"""Nodes and relations are immutable values."""

import copy
import pickle
from datetime import date

import pytest

from ravestate.modules.meta.ontology.node import Node, Relation


def test_a_new_node_has_an_id_with_its_type_and_later_nodes_have_greater_ids() -> None:
    nodes = [Node("Person") for _ in range(1000)]
    assert all(node.id.startswith("Person:") for node in nodes)
    assert [node.id for node in nodes] == sorted({node.id for node in nodes})


def test_a_changed_node_is_a_new_object_with_the_same_id() -> None:
    ada = Node("Person", {"name": "Ada"})
    older = ada.with_properties(age=36, name=None)
    assert older.id == ada.id and older != ada and hash(older) == hash(ada)
    assert dict(older.properties) == {"name": None, "age": 36}
    assert ada["name"] == "Ada" and ada.get("age") is None and ada.get("age", 0) == 0
    assert older.get("name", "?") == "?"
    with pytest.raises(KeyError, match="has no name; it has age"):
        older["name"]


def test_a_node_never_changes() -> None:
    given = {"name": "Ada"}
    ada = Node("Person", given)
    given["name"] = "Bob"
    assert ada["name"] == "Ada"
    with pytest.raises(TypeError):
        ada.properties["name"] = "Bob"  # type: ignore[index]
    with pytest.raises(AttributeError):
        ada.type = "City"  # type: ignore[misc]


def test_nodes_and_relations_can_be_copied_and_pickled() -> None:
    ada, london = Node("Person", {"born": date(1815, 12, 10)}), Node("City")
    relation = Relation(ada, "lives_in", london, {"since": date(1835, 1, 1)})
    for value in (ada, relation):
        assert copy.deepcopy(value) == pickle.loads(pickle.dumps(value)) == value
    assert len({relation, copy.copy(relation)}) == 1
