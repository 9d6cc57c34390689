"""The operations of memory, which behave the same in a file and on a server."""

from __future__ import annotations

import asyncio
import json
from datetime import UTC, date, datetime, timedelta, timezone
from pathlib import Path
from typing import Any

import pytest

from modules.meta.ontology.conftest import Open
from ravestate.errors import PlatformError, RuleError
from ravestate.modules.meta.ontology import Graph, Memory, Node
from ravestate.modules.meta.ontology.bolt import BoltStore
from ravestate.modules.meta.ontology.embedded import EmbeddedStore

NASTY = [
    "O'Brien",
    'quo"te`back`tick',
    "'}) DETACH DELETE n //",
    "$id",
    "\\u0041 \\' \\",
    "😀👩‍👩‍👧",
    "שלום عالم",
    "a\nb\tc\r\nd",
    "",
    " ",
    "null",
    "true",
    "2020-01-01",
    "x" * 100_000,
]


def names(nodes: list[Node]) -> list[str]:
    return [node["name"] for node in nodes]


# ------------------------------------------------------------------------------------ nodes


def test_a_node_is_created_and_found_again(memory: Memory) -> None:
    ada = memory.create("Person", name="Ada", age=36).result()
    assert (ada.type, dict(ada.properties)) == ("Person", {"name": "Ada", "age": 36})
    assert memory.get(ada.id).result() == ada
    assert memory.find("Person", name="Ada").result() == [ada]
    assert memory.find("Person", name="Bob").result() == []
    assert memory.get("Person:0").result() is None
    assert memory.get("nonsense").result() is None


def test_subtypes_are_found_with_their_type_oldest_first(memory: Memory) -> None:
    made = [memory.create(type, name="x").result() for type in ("Robot", "Person", "Thing", "Agent", "City")]
    robot, person, thing, agent, city = made
    assert memory.find("Agent").result() == [robot, person, agent]
    assert memory.find("Person").result() == [person]
    assert memory.find("Place", name="x").result() == [city]
    assert memory.find("Thing", name="x").result() == [robot, person, thing, agent, city]


def test_a_search_for_the_value_none_finds_nodes_without_this_property(memory: Memory) -> None:
    ada = memory.create("Person", name="Ada", age=36).result()
    bob = memory.create("Person", name="Bob").result()
    nobody = memory.create("Person", age=None).result()
    assert memory.find("Person", age=None).result() == [bob, nobody]
    assert memory.find("Person", name=None).result() == [nobody]
    assert memory.find("Person", age=36, nickname=None).result() == [ada]


@pytest.mark.parametrize("text", NASTY)
def test_any_text_can_be_stored_as_a_value(memory: Memory, text: str) -> None:
    other = memory.create("Person", name="other").result()
    node = memory.create("Person", name=text).result()
    assert node["name"] == text
    assert memory.find("Person", name=text).result() == [node]
    assert memory.update(node, nickname=text).result()["nickname"] == text
    city = memory.ensure("City", name=text).result()
    memory.relate(node, "lives_in", city).result()
    assert memory.related(node, "lives_in").result() == [city]
    assert memory.get(other.id).result() == other


def test_every_kind_of_value_comes_back_as_it_was(open_here: Open, place: dict[str, Any], tmp_path: Path) -> None:
    types = tmp_path / "kinds.yaml"
    types.write_text("Sample: {has: {a: text, b: integer, c: number, d: yes/no, e: date, f: time}}")
    memory = open_here(**place, types=(types,))
    moment = datetime(2024, 2, 29, 23, 59, 59, 999999, tzinfo=timezone(timedelta(hours=-5)))
    values: list[dict[str, Any]] = [
        {"a": "x", "b": 2**63 - 1, "c": 0.1, "d": True, "e": date(1, 1, 1), "f": moment},
        {"a": "", "b": -(2**63), "c": -1e300, "d": False, "e": date(9999, 12, 31), "f": datetime(1, 1, 2, tzinfo=UTC)},
        {"b": 0, "c": 5},
        {},
    ]  # fmt: skip
    for properties in values:
        node = memory.create("Sample", **properties).result()
        assert dict(node.properties) == properties
        assert memory.find("Sample", **properties).result()[-1] == node
    assert isinstance(memory.find("Sample", b=0).result()[0]["c"], float)
    assert len(memory.find("Sample", f=moment.astimezone(UTC)).result()) == 1


@pytest.mark.parametrize(
    ("type", "properties", "said"),
    [
        ("Persn", {}, "there is no type 'Persn'; did you mean 'Person'?"),
        ("Person) DETACH DELETE (n", {}, "there is no type"),
        ("Person", {"nmae": "Ada"}, "Person has no 'nmae'; did you mean 'name'?"),
        ("Person", {"name`": "Ada"}, "Person has no 'name`'"),
        ("Person", {"id": "x"}, "Person has no 'id'"),
        ("Person", {"age": "36"}, "Person.age is of kind integer, not '36': write for example 36"),
        ("Person", {"age": True}, "Person.age is of kind integer, not True"),
        ("Person", {"age": 2**63}, "Person.age is of kind integer"),
        ("Person", {"name": 3}, "Person.name is of kind text, not 3"),
        ("Person", {"name": "\ud800"}, "surrogates"),
        ("Person", {"born": datetime(2020, 1, 1, tzinfo=UTC)}, "Person.born is of kind date"),
        ("Person", {"born": "2020-01-01"}, "write for example datetime.date(1815, 12, 10)"),
    ],
)
def test_undeclared_types_and_properties_are_refused(
    memory: Memory, type: str, properties: dict[str, Any], said: str
) -> None:
    before = memory.export().result()
    for operation in (memory.create, memory.ensure, memory.find):
        with pytest.raises(RuleError) as caught:
            operation(type, **properties).result()
        assert said in str(caught.value)
    assert memory.export().result() == before


def test_the_operation_ensure_creates_a_node_once_and_later_finds_it(memory: Memory) -> None:
    first = memory.ensure("City", name="Hannover").result()
    assert memory.ensure("City", name="Hannover").result() == first
    assert memory.ensure("Place", name="Hannover").result() == first
    assert memory.ensure("City", name="Delft").result() != first
    assert len(memory.find("City").result()) == 2


def test_update_sets_properties_and_none_removes_them(memory: Memory) -> None:
    ada = memory.create("Person", name="Ada", age=36).result()
    assert dict(memory.update(ada, age=37, nickname="A").result().properties) == {
        "name": "Ada",
        "age": 37,
        "nickname": "A",
    }
    assert "age" not in memory.update(ada, age=None).result().properties
    assert memory.update(ada).result() == memory.get(ada.id).result()
    with pytest.raises(RuleError, match="memory does not know Person:"):
        memory.update(Node("Person"), age=3).result()


def test_save_writes_new_and_known_nodes(memory: Memory) -> None:
    ada = Node("Person", {"name": "Ada", "age": None})
    saved = memory.save(ada).result()
    assert saved.id == ada.id and dict(saved.properties) == {"name": "Ada"}
    memory.update(saved, nickname="A").result()
    again = memory.save(ada.with_properties(age=36, name=None)).result()
    assert dict(again.properties) == {"nickname": "A", "age": 36}
    assert len(memory.find("Person").result()) == 1
    with pytest.raises(RuleError, match="is a Person, not a City"):
        memory.save(ada, of="City").result()
    assert memory.save(ada, of="Agent").result().id == ada.id


@pytest.mark.parametrize("id", ["City:1", "1", "Person", "' OR 1=1"])
def test_an_id_begins_with_its_type(memory: Memory, id: str) -> None:
    with pytest.raises(RuleError, match="must begin with 'Person:'"):
        memory.save(Node("Person", {}, id)).result()


# ------------------------------------------------------------------------------------ relations


def test_nodes_are_related_once_and_in_one_direction(memory: Memory) -> None:
    ada, bob = (memory.create("Person", name=name).result() for name in ("Ada", "Bob"))
    london = memory.create("City", name="London").result()
    for _ in range(2):
        memory.relate(ada, "lives_in", london).result()
    memory.relate(bob, "lives_in", london).result()
    assert memory.related(ada, "lives_in").result() == [london]
    assert memory.related(london, "lives_in", back=True).result() == [ada, bob]
    memory.unrelate(ada, "lives_in", london).result()
    memory.unrelate(ada, "lives_in", london).result()
    assert memory.related(ada, "lives_in").result() == []
    assert memory.related(london, "lives_in", back=True).result() == [bob]
    assert memory.get(london.id).result() == london


def test_unrelate_with_forget_also_removes_the_other_node_unless_memory_needs_it(memory: Memory) -> None:
    ada, bob = (memory.create("Person", name=name).result() for name in ("Ada", "Bob"))
    london, kim = memory.create("City", name="London").result(), memory.create("Person", name="Kim").result()
    for person in (ada, bob):
        memory.relate(person, "lives_in", london).result()
    memory.relate(ada, "friend_of", kim).result()
    memory.relate(ada, "friend_of", bob).result()
    memory.unrelate(ada, "lives_in", london, forget=True).result()
    assert memory.get(london.id).result() == london  # Bob lives there, too
    for friend in (kim, bob):
        memory.unrelate(ada, "friend_of", friend, forget=True).result()
    assert (memory.get(kim.id).result(), memory.get(bob.id).result()) == (
        None,
        bob,
    )  # memory has more about Bob than his name
    memory.unrelate(bob, "lives_in", london, forget=True).result()
    assert memory.get(london.id).result() is None


def test_a_relation_has_properties(open_here: Open, place: dict[str, Any], tmp_path: Path) -> None:
    types = tmp_path / "mine.yaml"
    types.write_text("Person: {relations: {works_for: {to: Company, has: {since: date, hours: number}}}}")
    memory = open_here(**place, types=(types,))
    ada, firm = (
        memory.create("Person", name="Ada").result(),
        memory.create("Company", name="Engines").result(),
    )
    memory.relate(ada, "works_for", firm, since=date(1833, 6, 5), hours=2).result()
    memory.relate(ada, "works_for", firm, hours=None).result()
    [relation] = memory.relations(ada).result()
    assert (relation.source, relation.name, relation.target) == (ada, "works_for", firm)
    assert dict(relation.properties) == {"since": date(1833, 6, 5)}
    assert memory.relations(firm).result() == [relation]
    with pytest.raises(RuleError, match="works_for has no 'sinec'; did you mean 'since'"):
        memory.relate(ada, "works_for", firm, sinec=date(1833, 6, 5)).result()


def test_a_node_can_be_related_to_itself(memory: Memory) -> None:
    ada = memory.create("Person", name="Ada").result()
    memory.relate(ada, "likes", ada).result()
    assert memory.related(ada, "likes").result() == memory.related(ada, "likes", back=True).result() == [ada]
    assert len(memory.relations(ada).result()) == 1


def test_a_relation_that_the_types_do_not_have_is_refused(memory: Memory) -> None:
    ada, london = memory.create("Person", name="Ada").result(), memory.create("City", name="London").result()
    with pytest.raises(RuleError, match="there is no relation 'lives_at'; did you mean 'lives_in'"):
        memory.relate(ada, "lives_at", london).result()
    with pytest.raises(RuleError, match="there is no relation"):
        memory.related(ada, "lives_in]->() DETACH DELETE a //").result()
    with pytest.raises(RuleError, match="lives_in does not go from City to Person, but from Agent to Place"):
        memory.relate(london, "lives_in", ada).result()
    with pytest.raises(RuleError, match="lives_in goes from Agent, not from City"):
        memory.related(london, "lives_in").result()
    with pytest.raises(RuleError, match="lives_in goes to Place, not to Person"):
        memory.related(ada, "lives_in", back=True).result()
    with pytest.raises(RuleError, match="memory does not know City:"):
        memory.relate(ada, "lives_in", Node("City")).result()
    assert memory.relations(ada).result() == []


# ------------------------------------------------------------------------------------ merging and forgetting


def test_duplicates_are_merged(memory: Memory) -> None:
    ada = memory.create("Person", name="Ada", age=36).result()
    twin = memory.create("Agent", name="Ada L.", nickname="Lady", age=20).result()
    bob = memory.create("Person", name="Bob").result()
    london, chess = (
        memory.create("City", name="London").result(),
        memory.create("Hobby", name="chess").result(),
    )
    memory.relate(ada, "lives_in", london).result()
    for relation, other in (
        ("lives_in", london),
        ("has_hobby", chess),
        ("friend_of", twin),
        ("friend_of", ada),
    ):
        memory.relate(twin, relation, other).result()
    memory.relate(ada, "friend_of", twin).result()
    memory.relate(bob, "friend_of", twin).result()

    merged = memory.merge(ada, twin).result()
    assert merged.id == ada.id
    assert dict(merged.properties) == {"name": "Ada", "age": 36, "nickname": "Lady"}
    assert memory.get(twin.id).result() is None
    found = {(r.source["name"], r.name, r.target["name"]) for r in memory.relations(merged).result()}
    assert found == {
        ("Ada", "lives_in", "London"),
        ("Ada", "has_hobby", "chess"),
        ("Ada", "friend_of", "Ada"),
        ("Bob", "friend_of", "Ada"),
    }


def test_merging_keeps_the_properties_of_relations(open_here: Open, place: dict[str, Any], tmp_path: Path) -> None:
    types = tmp_path / "mine.yaml"
    types.write_text("Person: {relations: {works_for: {to: Company, has: {since: date, hours: number}}}}")
    memory = open_here(**place, types=(types,))
    ada, twin = (memory.create("Person", name="Ada").result() for _ in range(2))
    firm = memory.create("Company", name="Engines").result()
    memory.relate(ada, "works_for", firm, hours=2).result()
    memory.relate(twin, "works_for", firm, hours=8, since=date(1833, 6, 5)).result()
    [relation] = memory.relations(memory.merge(ada, twin).result()).result()
    assert dict(relation.properties) == {"hours": 2, "since": date(1833, 6, 5)}


def test_a_refused_merge_changes_nothing(memory: Memory) -> None:
    ada, agent = memory.create("Person", name="Ada").result(), memory.create("Agent", name="Ada").result()
    city = memory.create("City", name="Ada").result()
    before = memory.export().result()
    with pytest.raises(RuleError, match="cannot be merged with itself"):
        memory.merge(ada, ada).result()
    with pytest.raises(RuleError, match="a Agent is not a Person; merge them the other way round"):
        memory.merge(agent, ada).result()
    with pytest.raises(RuleError, match=r"a City is not a Person$"):
        memory.merge(city, ada).result()
    with pytest.raises(RuleError, match="memory does not know"):
        memory.merge(ada, Node("Person")).result()
    assert memory.export().result() == before


def test_a_person_is_forgotten_with_everything_about_them(memory: Memory) -> None:
    def make(type: str, name: str, **more: Any) -> Node:
        return memory.create(type, name=name, **more).result()

    ada, eve = make("Person", "Ada", age=36), make("Person", "Eve", age=30)
    mentioned, guest, robot = (
        make("Person", "Bob"),
        make("Person", "Cy", age=3),
        make("Robot", "Robby", model="R1"),
    )
    ham, surrey, london = make("City", "Ham"), make("Place", "Surrey"), make("City", "London")
    chess, shared = make("Hobby", "chess"), make("Hobby", "walking")
    for source, relation, target in (
        (ada, "lives_in", ham), (ham, "located_in", surrey), (ada, "comes_from", london), (eve, "lives_in", london),
        (ada, "has_hobby", chess), (ada, "has_hobby", shared), (eve, "has_hobby", shared), (ada, "friend_of", mentioned),
        (ada, "friend_of", guest), (ada, "friend_of", robot), (robot, "friend_of", ada), (guest, "lives_in", ham),
    ):  # fmt: skip
        memory.relate(source, relation, target).result()
    memory.unrelate(guest, "lives_in", ham).result()

    foreseen = memory.only_about(ada).result()
    gone = memory.forget(ada).result()
    assert gone == foreseen and gone[0].id == ada.id
    assert sorted(names(gone)) == ["Ada", "Bob", "Ham", "Surrey", "chess"]
    assert sorted(names(memory.find("Thing").result())) == ["Cy", "Eve", "London", "Robby", "walking"]
    left = json.dumps(memory.export().result())
    assert all(node.id not in left for node in gone)
    assert memory.relations(robot).result() == memory.relations(guest).result() == []
    assert memory.forget(ada).result() == memory.only_about(ada).result() == []


def test_the_operation_forget_keeps_nodes_that_other_nodes_need_even_in_a_cycle(memory: Memory) -> None:
    ada = memory.create("Person", name="Ada").result()
    here, there = memory.create("City", name="here").result(), memory.create("City", name="there").result()
    for source, relation, target in (
        (ada, "lives_in", here), (here, "located_in", there), (there, "located_in", here)
    ):  # fmt: skip
        memory.relate(source, relation, target).result()
    eve = memory.create("Person", name="Eve", age=1).result()
    memory.relate(eve, "lives_in", there).result()
    assert names(memory.forget(ada).result()) == ["Ada"]  # `there` stays for Eve, and leads to `here`
    assert sorted(names(memory.forget(eve).result())) == ["Eve", "here", "there"]
    assert memory.find("Thing").result() == []


# ------------------------------------------------------------------------------------ documents and types


def test_an_export_contains_everything_and_can_be_loaded_elsewhere(
    memory: Memory, open_here: Open, tmp_path: Path
) -> None:
    ada = memory.create("Person", name="Ada 😀", born=date(1815, 12, 10)).result()
    london = memory.create("City", name="London").result()
    memory.relate(ada, "lives_in", london).result()
    document = json.loads(json.dumps(memory.export().result()))
    assert [node["properties"] for node in document["nodes"]] == [
        {"name": "Ada 😀", "born": "1815-12-10"},
        {"name": "London"},
    ]
    assert memory.load(document).result() == 2  # memory has it already, so nothing changes
    assert memory.export().result() == document
    other = open_here(path=tmp_path / "other.lbug")
    assert other.load(document).result() == 2
    assert other.export().result() == document
    assert other.related(ada, "lives_in").result() == [london]


@pytest.mark.parametrize(
    ("document", "said"),
    [
        ({}, "not an exported memory"),
        ({"format": 2, "nodes": [], "relations": []}, "not an exported memory"),
        ({"format": 1, "nodes": {}, "relations": []}, "nodes: Input should be a valid list"),
        ({"format": 1, "nodes": [1], "relations": []}, "nodes.0: Input should be a valid dictionary"),
        ({"format": 1, "nodes": [{"type": "Person"}], "relations": []}, "nodes.0.id: Field required"),
        ({"format": 1, "nodes": [{"type": "Persn", "id": "Persn:1"}], "relations": []}, "no type 'Persn'"),
        ({"format": 1, "nodes": [{"type": "Person", "id": "City:1"}], "relations": []}, "must begin with"),
        (
            {
                "format": 1,
                "nodes": [{"type": "Person", "id": "Person:1", "properties": {"born": "x"}}],
                "relations": [],
            },
            "born = 'x'",
        ),
        (
            {"format": 1, "nodes": [], "relations": [{"from": "a", "to": "b", "relation": "likes"}]},
            "nodes that the document does not have",
        ),
        (
            {
                "format": 1,
                "nodes": [{"type": "Person", "id": "Person:1"}, {"type": "City", "id": "City:1"}],
                "relations": [{"from": "City:1", "to": "Person:1", "relation": "lives_in"}],
            },
            "lives_in does not go from City",
        ),
    ],
)
def test_a_document_with_an_error_is_not_loaded_even_in_part(
    memory: Memory, document: dict[str, Any], said: str
) -> None:
    with pytest.raises(RuleError) as caught:
        memory.load(document).result()
    assert said in str(caught.value)
    assert memory.find("Thing").result() == []


def test_types_can_be_added_and_removed_without_loss_of_data(
    open_here: Open, place: dict[str, Any], tmp_path: Path
) -> None:
    memory = open_here(**place)
    ada = memory.create("Person", name="Ada").result()
    memory.close().result()
    types = tmp_path / "mine.yaml"
    types.write_text(
        "Person: {has: {shoe_size: number}, relations: {owns: Boat}}\n"
        "Boat: {is: Thing, has: {length: number}, relations: {sails_to: [City, Country]}}\n"
    )
    memory = open_here(**place, types=(types,))
    [found] = memory.find("Person", name="Ada").result()
    assert found == ada
    memory.update(found, shoe_size=38.5).result()
    boat = memory.create("Boat", name="Lady", length=7).result()
    memory.relate(found, "owns", boat).result()
    memory.relate(found, "likes", boat).result()  # an old relation to a node of a new type
    memory.relate(boat, "sails_to", memory.create("City", name="Ham").result()).result()
    memory.close().result()

    narrower = open_here(**place)  # without the type file, the data stays but is hidden
    assert narrower.undeclared().result() == ["Boat"]
    assert narrower.find("Thing", name="Lady").result() == []
    assert narrower.related(found, "likes").result() == []
    assert "shoe_size" not in narrower.find("Person").result()[0].properties
    twin = narrower.create("Person", name="Twin").result()
    with pytest.raises(RuleError, match="is related by Boat, owns, which no file of types declares"):
        narrower.merge(twin, found).result()
    narrower.close().result()

    again = open_here(**place, types=(types,))
    assert again.related(found, "owns").result() == [boat]
    assert again.find("Person", shoe_size=38.5).result()[0].id == ada.id


# ------------------------------------------------------------------------------------ use


def test_operations_run_in_the_order_of_the_calls(memory: Memory) -> None:
    ada = Node("Person", {"name": "Ada"})
    replies = [memory.save(ada.with_properties(age=age)) for age in range(50)]
    assert [reply.result()["age"] for reply in replies] == list(range(50))
    assert memory.find("Person").result()[0]["age"] == 49


def test_the_operations_of_a_together_call_are_one_transaction(memory: Memory) -> None:
    ada = memory.create("Person", name="Ada").result()

    def befriend(graph: Graph) -> Node:
        charles = graph.ensure("Person", {"name": "Charles"})
        graph.relate(ada, "friend_of", graph.update(charles, {"age": 79}), {})
        return charles

    def fail(graph: Graph) -> None:
        befriend(graph)
        graph.forget(ada)
        assert graph.get(ada.id) is None
        raise KeyError("no")

    with pytest.raises(KeyError):
        memory.together(fail).result()
    assert memory.find("Person").result() == [ada]
    charles = memory.together(befriend).result()
    assert memory.related(ada, "friend_of").result() == [charles.with_properties(age=79)]
    assert memory.together(lambda graph: graph.find("City", {})).result() == []


def test_an_operation_continues_even_if_the_task_that_awaits_it_is_cancelled(memory: Memory) -> None:
    async def use() -> Node:
        ada = await memory.create("Person", name="Ada")
        for impatient in [asyncio.ensure_future(_wait(memory, age)) for age in range(5)]:
            await asyncio.sleep(0)
            impatient.cancel()
        return ada

    async def _wait(memory: Memory, age: int) -> None:
        await memory.create("Person", name="late", age=age)

    ada = asyncio.run(use())
    assert memory.find("Person", name="Ada").result() == [ada]
    assert len(memory.find("Person", name="late").result()) == 5


def test_a_closed_memory_refuses_operations(memory: Memory) -> None:
    ada = memory.create("Person", name="Ada")
    closing = memory.close()
    assert ada.result()["name"] == "Ada"
    closing.result()
    assert memory.close() is closing
    with pytest.raises(RuleError, match="is closed: create comes too late"):
        memory.create("Person", name="Bob")


def test_a_memory_of_a_newer_format_is_refused(open_here: Open, place: dict[str, Any]) -> None:
    memory = open_here(**place)
    memory.create("Person", name="Ada").result()
    memory.close().result()
    store = EmbeddedStore(place["path"]) if "path" in place else BoltStore(**place, timeout=5.0)
    store.write("MATCH (m:`_ravestate` {`key`: 'format'}) SET m.`value` = 3", {})
    store.close()
    with pytest.raises(PlatformError, match=r"is of format 3, and this version of ravestate knows up to [12]:"):
        open_here(**place)


def test_tidy_changes_no_data(memory: Memory) -> None:
    ada, london = memory.create("Person", name="Ada").result(), memory.create("City", name="London").result()
    memory.relate(ada, "lives_in", london).result()
    before = memory.export().result()
    memory.tidy().result()
    assert memory.export().result() == before


def test_unrelate_refuses_a_node_whose_id_has_another_type(memory: Memory) -> None:
    ada = memory.create("Person", name="Ada").result()
    london = memory.create("City", name="London").result()
    memory.relate(ada, "lives_in", london).result()
    with pytest.raises(RuleError, match="must begin with 'Robot:'"):
        memory.unrelate(Node("Robot", {}, ada.id), "lives_in", london).result()
    assert memory.related(ada, "lives_in").result() == [london]
