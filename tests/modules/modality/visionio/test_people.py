"""Functions that store, find, merge and forget faces in memory."""

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from modules.modality.visionio.photographs import OBAMA, faces
from ravestate.modules import ontology
from ravestate.modules.meta.ontology import Graph, Memory, Node
from ravestate.modules.meta.ontology.opening import open_memory
from ravestate.modules.modality.visionio import people


@pytest.fixture
def graph(memory: Path) -> Iterator[Memory]:
    opened = open_memory(ontology.Settings(path=memory))
    yield opened
    opened.close().result(20)


def vector(name: str) -> tuple[float, ...]:
    return faces()[name].vector


def do(memory: Memory, operation: Any) -> Any:
    return memory.together(operation).result(20)


def keep(memory: Memory, name: str, *photos: str, most: int = 8) -> tuple[Node, int]:
    def file(graph: Graph) -> tuple[Node, int]:
        person = graph.ensure("Person", {"name": name})
        return people.keep(graph, person, [(1.0, vector(photo)) for photo in photos], most)

    return do(memory, file)


def test_a_vector_can_be_packed_as_text_and_damaged_text_unpacks_to_none() -> None:
    text = people.packed(vector("obama"))
    assert people.unpacked(text) == pytest.approx(vector("obama"), abs=1e-7)
    assert people.unpacked("") is None and people.unpacked(text[:-4]) is None and people.unpacked("ä" * 684) is None


def test_the_function_nearest_returns_the_nearest_person_within_the_threshold(graph: Memory) -> None:
    assert do(graph, lambda g: people.nearest(g, vector("obama"), 0.55)) is None
    keep(graph, "Barack", "obama")
    keep(graph, "Joe", "biden")
    found = do(graph, lambda g: people.nearest(g, vector("obama3"), 0.55))
    assert found.person["name"] == "Barack" and 0.2 < found.distance < 0.45
    assert do(graph, lambda g: people.nearest(g, vector("six_1"), 0.55)) is None
    assert do(graph, lambda g: people.nearest(g, vector("obama3"), 0.1)) is None
    assert 0.6 < do(graph, lambda g: people.least(g, vector("six_1"))) < 1.0


def test_no_person_is_recognised_if_two_people_are_equally_near(graph: Memory) -> None:
    keep(graph, "Barack", "obama")
    keep(graph, "Bary", "obama")
    assert do(graph, lambda g: people.nearest(g, vector("obama3"), 0.55)) is None


def test_no_person_is_recognised_if_a_second_person_is_about_as_near_but_beyond_the_threshold(graph: Memory) -> None:
    def file(graph: Graph) -> None:
        for name, distance in (("Ada", 0.44), ("Bob", 0.46)):
            people.keep(graph, graph.ensure("Person", {"name": name}), [(1.0, (distance, *[0.0] * 127))], 8)

    do(graph, file)
    assert do(graph, lambda g: people.nearest(g, [0.0] * 128, 0.45)) is None


def test_the_function_keep_skips_known_views_and_drops_the_oldest_views(graph: Memory) -> None:
    assert keep(graph, "Barack", "obama2", "obama2_32bit")[1] == 1
    person, filed = keep(graph, "Barack", *OBAMA, most=3)
    assert filed >= 3
    assert len(do(graph, lambda g: people.faces_of(g, person))) == 3


def test_the_function_keep_merges_only_people_with_equal_names_and_similar_faces(graph: Memory) -> None:
    first, _ = keep(graph, "Barack", "obama")
    keep(graph, "Joe", "biden")

    def file(g: Graph) -> tuple[Node, int]:
        g.relate(first, "lives_in", g.ensure("City", {"name": "Chicago"}), {})
        return people.keep(g, Node("Person", {"name": "barack"}), [(1.0, vector("obama_partial_face"))], 8)

    kept, _ = do(graph, file)
    names = sorted(one["name"] for one in graph.find("Person").result(20))
    assert names == ["Joe", "barack"]
    assert [one["name"] for one in graph.related(kept, "lives_in").result(20)] == ["Chicago"]
    assert len(do(graph, lambda g: people.faces_of(g, kept))) == 2
    do(graph, lambda g: people.keep(g, Node("Person", {"name": "barack"}), [(1.0, vector("hanks"))], 8))
    assert len(graph.find("Person", name="barack").result(20)) == 2  # another man with the same name


def test_faces_can_be_forgotten_without_or_with_their_person(graph: Memory) -> None:
    person, _ = keep(graph, "Barack", "obama", "obama2")
    assert do(graph, lambda g: people.forget_faces(g, person)) == 2
    assert do(graph, people.stored) == [] and graph.get(person.id).result(20) is not None
    assert do(graph, lambda g: people.forget_faces(g, Node("Person"))) == 0
    keep(graph, "Barack", "obama")
    graph.forget(person).result(20)
    assert do(graph, people.stored) == []
