"""A damaged file causes a clear message, and does not crash the process."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

from modules.meta.ontology.conftest import Open
from ravestate.errors import PlatformError
from ravestate.modules import ontology
from ravestate.modules.meta.ontology import database, embedded
from ravestate.modules.meta.ontology.database import META, NODE, RELATION, connect, survives
from ravestate.modules.meta.ontology.opening import open_memory

HERE = Path(__file__).parent

FORMAT_1 = (
    f"CREATE NODE TABLE `{META}` (`key` STRING PRIMARY KEY, `value` INT64)",
    f"CREATE (:`{META}` {{`key`: 'format', `value`: 1}})",
    "CREATE NODE TABLE Person (id STRING PRIMARY KEY, name STRING, age INT64)",
    "CREATE NODE TABLE City (id STRING PRIMARY KEY, name STRING)",
    "CREATE NODE TABLE Boat (id STRING PRIMARY KEY, name STRING, length DOUBLE)",
    "CREATE REL TABLE lives_in (FROM Person TO City)",
    "CREATE REL TABLE friend_of (FROM Person TO Person)",
    "CREATE REL TABLE owns (FROM Person TO Boat, FROM City TO Boat, since STRING)",
    "CREATE (:Person {id: 'Person:1', name: 'Ada', age: 36}), (:Person {id: 'Person:2', name: 'Bob'})",
    "CREATE (:City {id: 'City:3', name: 'London'}), (:Boat {id: 'Boat:4', name: 'Lady', length: 7.5})",
    "MATCH (a:Person {id: 'Person:1'}), (b:City) CREATE (a)-[:lives_in]->(b)",
    "MATCH (a:Person {id: 'Person:1'}), (b:Person {id: 'Person:2'}) CREATE (a)-[:friend_of]->(b)",
    "MATCH (a:Person), (b:Boat) CREATE (a)-[:owns {since: '2020-01-01'}]->(b)",
)
"""Statements that make a memory like those of earlier versions, with a table for each type and each relation."""


def write_format_1(path: Path, *more: str) -> None:
    database, connection = connect(path)
    for statement in (*FORMAT_1, *more):
        connection.execute(statement)
    connection.execute("CHECKPOINT")
    connection.close()
    database.close()


def small_memory(tmp_path: Path, open_here: Open) -> Path:
    memory = open_here(path=tmp_path / "memory.lbug")
    here = memory.create("City", name="here").result()
    for number in range(5):
        person = memory.create("Person", name=f"person {number}", nickname="x" * 100).result()
        memory.relate(person, "lives_in", here).result()
    memory.close().result()
    return tmp_path / "memory.lbug"


def test_a_damaged_file_is_read_or_called_broken(tmp_path: Path, open_here: Open) -> None:
    """Files are cut, have flipped bits, or pages of zeros or noise. About one in eight would crash its process."""
    path, cases = small_memory(tmp_path, open_here), 16
    run = subprocess.run(
        [sys.executable, HERE / "damaged.py", path, "4", str(cases)],
        capture_output=True, text=True, check=False, timeout=300,
    )  # fmt: skip
    outcomes = run.stdout.splitlines()
    assert run.returncode == 0, run.stderr[-500:]
    assert len(outcomes) == cases
    assert set(outcomes) <= {"read", "broken"}, outcomes
    assert outcomes.count("broken") >= cases // 4


def test_a_trial_opening_does_not_change_an_intact_file(tmp_path: Path, open_here: Open) -> None:
    """A separate process opens the file on trial, because a damaged file can crash the process that opens it."""
    path = small_memory(tmp_path, open_here)
    content = path.read_bytes()
    assert survives(path) and survives(path, whole_log=False)
    assert path.read_bytes() == content


def test_a_trial_opening_fails_only_if_its_process_crashes_or_hangs(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(database, "PATIENCE", 2.0)
    file = tmp_path / "trial.py"
    for program, alive in (
        ("import os; os.abort()", False),
        ("raise OSError", True),
        ("import signal; signal.pause()", False),
    ):
        file.write_text(program)
        monkeypatch.setattr(database, "__file__", str(file))
        assert survives(tmp_path) is alive


def test_a_memory_of_format_1_keeps_all_nodes_and_relations(tmp_path: Path, open_here: Open) -> None:
    path, types = tmp_path / "memory.lbug", tmp_path / "mine.yaml"
    types.write_text(
        "Boat: {is: Thing, has: {length: number}}\nPerson: {relations: {owns: {to: Boat, has: {since: date}}}}"
    )
    write_format_1(path)
    memory = open_here(path=path)  # its types lack Boat and owns
    [ada] = memory.find("Person", name="Ada").result()
    assert dict(ada.properties) == {"name": "Ada", "age": 36}
    assert [(one.name, one.target.id) for one in memory.relations(ada).result()] == [
        ("friend_of", "Person:2"),
        ("lives_in", "City:3"),
    ]
    assert memory.undeclared().result() == ["Boat"]
    memory.update(ada, nickname="Countess").result()
    memory.close().result()
    for _ in range(2):  # the second opening reads the new format
        memory = open_here(path=path, types=(types,))
        [boat] = memory.find("Boat").result()
        assert dict(boat.properties) == {"name": "Lady", "length": 7.5}
        owned = [(str(one.source["name"]), str(one.properties["since"])) for one in memory.relations(boat).result()]
        assert owned == [("Ada", "2020-01-01"), ("Bob", "2020-01-01")]
        assert memory.get("Person:1").result() == ada.with_properties(nickname="Countess")
        memory.close().result()
    assert sorted(file.name for file in tmp_path.iterdir()) == ["memory.lbug", "memory.lbug.sum", "mine.yaml"]


def test_a_memory_of_format_1_that_cannot_be_copied_keeps_its_data(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def fail(*_: object) -> None:
        raise OSError("no more space")

    path = tmp_path / "memory.lbug"
    write_format_1(path)
    monkeypatch.setattr(embedded, "copy_database", fail)
    memory = open_memory(ontology.Settings(path=path))
    with pytest.raises(PlatformError, match=r"cannot be copied to the new format: no more space\. Nothing was changed"):
        memory.opened().result(60)
    memory.close().result(60)
    database, connection = connect(path)
    people = connection.execute("MATCH (p:Person) RETURN p.name ORDER BY p.name").get_all()
    assert people == [["Ada"], ["Bob"]]
    connection.close()
    database.close()
    assert sorted(file.name for file in tmp_path.iterdir()) == ["memory.lbug", "memory.lbug.sum"]


DOG = "Dog: {is: Thing, has: {size: text}}"
CAT = "Cat: {is: Thing, has: {size: number}}"
COW = "Cow: {is: Thing, has: {Size: number}}"


def file_of(tmp_path: Path, types: str) -> tuple[Path]:
    file = tmp_path / f"{types[:3]}.yaml"
    file.write_text(types)
    return (file,)


def test_types_of_format_1_can_have_properties_of_equal_names_and_different_kinds(
    tmp_path: Path, open_here: Open
) -> None:
    """Earlier versions had a table for each type. The file keeps the tables of types that are no longer declared."""
    path = tmp_path / "memory.lbug"
    write_format_1(
        path,
        "CREATE NODE TABLE Dog (id STRING PRIMARY KEY, name STRING, size STRING)",
        "CREATE NODE TABLE Cat (id STRING PRIMARY KEY, name STRING, size DOUBLE)",
        "CREATE NODE TABLE Cow (id STRING PRIMARY KEY, name STRING, Size DOUBLE)",
        "CREATE (:Dog {id: 'Dog:5', size: 'big'}), (:Cat {id: 'Cat:6', size: 3.5}), (:Cow {id: 'Cow:7', Size: 9.0})",
    )
    for types, id, name, value in [
        (CAT, "Cat:6", "size", 3.5), (COW, "Cow:7", "Size", 9.0), (DOG, "Dog:5", "size", "big"), (CAT, "Cat:6", "size", 3.5),
    ]:  # fmt: skip
        memory = open_here(path=path, types=file_of(tmp_path, types))
        found = memory.get(id).result()
        assert found is not None and dict(found.properties) == {name: value}
        memory.close().result()


def test_a_hidden_type_does_not_reserve_its_properties(tmp_path: Path, open_here: Open) -> None:
    path = tmp_path / "memory.lbug"
    for types, type, property, value in [
        (DOG, "Dog", "size", "big"), (CAT, "Cat", "size", 3.5), (COW, "Cow", "Size", 9.0), (DOG, "Dog", "size", "small"),
    ]:  # fmt: skip
        memory = open_here(path=path, types=file_of(tmp_path, types))
        memory.create(type, **{property: value}).result()
        memory.purge().result()
        memory.close().result()
    memory = open_here(path=path, types=file_of(tmp_path, DOG))
    gone = memory.create("Dog").result()
    memory.forget(gone).result()  # the rewrite keeps the values of hidden types
    assert [dog["size"] for dog in memory.find("Dog").result()] == ["big", "small"]
    memory.close().result()
    memory = open_here(path=path, types=file_of(tmp_path, CAT))
    assert [cat["size"] for cat in memory.find("Cat").result()] == [3.5]


def test_a_property_that_another_context_uses_keeps_its_kind(tmp_path: Path, open_here: Open) -> None:
    path = tmp_path / "memory.lbug"
    dogs = open_here(path=path, types=file_of(tmp_path, DOG))
    dogs.opened().result()
    cats = open_memory(ontology.Settings(path=path, types=file_of(tmp_path, CAT)))
    with pytest.raises(PlatformError, match=r"has Dog\.size as text, but the types say number"):
        cats.opened().result()
    cats.close().result()
    assert dogs.create("Dog", size="big").result()["size"] == "big"


def test_all_types_share_one_table(tmp_path: Path, open_here: Open) -> None:
    """Ladybug takes 3.5 MB of main memory for each table of nodes, and 10 MB for each table of relations."""
    path = small_memory(tmp_path, open_here)
    database, connection = connect(path)
    tables = connection.execute("CALL show_tables() RETURN name").get_all()
    assert sorted(name for [name] in tables) == sorted([META, NODE, RELATION])
    connection.close()
    database.close()
