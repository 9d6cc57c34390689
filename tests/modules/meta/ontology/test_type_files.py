"""Type files: their content, and the errors about their mistakes."""

from __future__ import annotations

from pathlib import Path

import pytest

from ravestate.errors import DeclarationError, PlatformError
from ravestate.modules import ontology
from ravestate.modules.meta.ontology.opening import types_of
from ravestate.modules.meta.ontology.type_files import read_types
from ravestate.modules.meta.ontology.types import Types


def read(tmp_path: Path, *texts: str) -> Types:
    """Write these texts to the files 0.yaml, 1.yaml, ..., and read their types."""
    files = [tmp_path / f"{number}.yaml" for number in range(len(texts))]
    for file, text in zip(files, texts, strict=True):
        file.write_text(text, encoding="utf-8")
    return read_types(files)


def test_types_inherit_properties_and_relations(tmp_path: Path) -> None:
    types = read(
        tmp_path,
        "Boat: {is: Thing, has: {length: number}, relations: {sails_to: [City, Harbour]}}\n"
        "Thing: {has: {name: text}}\nCity: {is: Thing}\nHarbour: {is: City, has: {deep: yes/no}}\nYacht: {is: Boat}\n",
    )
    assert list(types) == ["Thing", "Boat", "City", "Harbour", "Yacht"]
    assert types.properties("Yacht") == {"name": "text", "length": "number"}
    assert types.properties("Harbour") == {"name": "text", "deep": "yes/no"}
    assert types.subtypes("City") == ("City", "Harbour")
    assert types.is_a("Yacht", "Thing") and not types.is_a("Thing", "Yacht")
    assert types.pairs("sails_to") == [
        ("Boat", "City"), ("Boat", "Harbour"), ("Yacht", "City"), ("Yacht", "Harbour")
    ]  # fmt: skip
    types.check_relation("Yacht", "sails_to", "Harbour")
    types.check_end("Harbour", "sails_to", back=True)


def test_a_later_file_adds_to_the_types(tmp_path: Path) -> None:
    types = read(
        tmp_path,
        "Thing: {has: {name: text}}\nBoat: {is: Thing}\nPort:",
        "Boat: {is: Thing, has: {name: text, length: number}, relations: {in: Port}}",
        "Port: {relations: {in: Port}}\nBoat: {relations: {in: {to: Port, has: {since: date}}}}",
        "",
        "# nothing\n",
    )
    assert types.properties("Boat") == {"name": "text", "length": "number"}
    assert types.relating("in").ends == {("Boat", "Port"), ("Port", "Port")}
    assert types.relating("in").properties == {"since": "date"}


def test_the_built_in_types_are_complete() -> None:
    types = types_of(ontology.Settings())
    assert {
        "Thing", "Agent", "Person", "Robot", "Animal", "Place", "City", "Country", "Organisation", "Company",
        "Institution", "University", "Hobby", "Occupation", "Subject", "Ability", "Remark", "Account", "Face",
    } == set(types)  # fmt: skip
    assert types.properties("Person")["name"] == "text"
    for relation, source, target in (
        ("lives_in", "Person", "City"), ("comes_from", "Robot", "Country"), ("has_hobby", "Person", "Hobby"),
        ("works_as", "Person", "Occupation"), ("works_for", "Person", "Company"), ("studies", "Person", "Subject"),
        ("studies_at", "Person", "University"), ("friend_of", "Person", "Robot"), ("member_of", "Robot", "Organisation"),
        ("has_father", "Robot", "Person"), ("sibling_of", "Robot", "Robot"), ("likes", "Robot", "Thing"),
        ("wants_to_become", "Robot", "Thing"), ("can", "Robot", "Ability"), ("has_learned", "Robot", "Ability"),
        ("located_in", "City", "Country"), ("has_told", "Person", "Remark"),
    ):  # fmt: skip
        types.check_relation(source, relation, target)


@pytest.mark.parametrize(
    ("text", "line", "said"),
    [
        ("- Boat", 1, "a file of types maps types to their parts, but this is not a mapping"),
        ("Boat:\n  [x]", 2, "Boat has keys and values, but this is not a mapping"),
        ("Boat: {si: Thing}", 1, "Boat has no 'si'; did you mean 'is'? (a type has: is, has, relations)"),
        ("Boat:\n  is: Thnig\nThing:", 2, "Boat is a 'Thnig', which is not a type; did you mean 'Thing'?"),
        ("A: {is: B}\nB: {is: C}\nC: {is: A}", 1, "A is a B is a C is a A: types must not form a cycle"),
        ("A: {is: A}", 1, "A is a A: types must not form a cycle"),
        ("A: {is: [B]}\nB:", 1, "the parent of A is one type, but this is a sequence"),
        (
            "A:\n  has:\n    age: intger",
            3,
            "A.age: 'intger' is not a kind; did you mean 'integer'? (kinds: text, ",
        ),
        ("A:\n  has: {age: [text]}", 2, "A.age has a kind, but this is a sequence"),
        ("A: {has: [age]}", 1, "A has properties by name, but this is not a mapping"),
        ("A: {has: {id: text}}", 1, "A.id: every node has an id already"),
        ("A: {has: {Id: text}}", 1, "A.Id: every node has an id already"),
        ("A: {has: {shoe size: text}}", 1, "'shoe size' is not a name for a property"),
        ("A: {has: {x`: text}}", 1, "'x`' is not a name for a property"),
        ("_A:", 1, "'_A' is not a name for a type"),
        ("Ä:", 1, "'Ä' is not a name for a type"),
        ("1: {}", 1, "'1' is not a name for a type"),
        ("A) DETACH DELETE (n: {}", 1, "is not a name for a type"),
        ("x" * 64 + ":", 1, "at most 63"),
        ("City:\ncity:", 2, "city and City (FILE:1) are too similar"),
        ("City:\nBoat: {relations: {city: City}}", 2, "city and City (FILE:1) are too similar"),
        ("City: {relations: {sails: City}}\nSails:", 2, "Sails and sails (FILE:1) are too similar"),
        ("A: {has: {age: text}}\nB: {has: {age: integer}}", 2, "B.age is integer, and age is text at FILE:1"),
        ("A: {has: {age: text}}\nB: {has: {Age: text}}", 2, "B.Age is text, and age is text at FILE:1"),
        ("A:\nA:", 2, "'A' is here twice"),
        ("A: {has: {x: text, x: text}}", 1, "'x' is here twice"),
        ("A:\n  relations:\n    to_b: B", 3, "to_b goes to 'B', which is not a type"),
        ("A: {relations: {knows: {form: A}}}", 1, "knows has no 'form'"),
        ("A: {relations: {knows: {has: {x: text}}}}", 1, "relation knows has no target: write knows: {to: Thing}"),
        ("A: {relations: [knows]}", 1, "relations map names to types, but this is not a mapping"),
        ("A: {has: {age: text}", 1, "not valid YAML"),
        ("A: *nowhere", 1, "not valid YAML"),
        ("A:\n\tis: B", 2, "not valid YAML"),
        ("A:\n\x07", 2, "not valid YAML (a control character)"),
        ("{[a]: b}", 1, "a name is a text, but this is a sequence"),
    ],
)
def test_errors_name_the_file_and_the_line(tmp_path: Path, text: str, line: int, said: str) -> None:
    file = tmp_path / "0.yaml"
    with pytest.raises(DeclarationError) as caught:
        read(tmp_path, text)
    assert str(caught.value).startswith(f"{file}:{line}: ")
    assert said.replace("FILE", str(file)) in str(caught.value)


def test_type_files_that_contradict_each_other_are_refused(tmp_path: Path) -> None:
    first = "Thing: {has: {name: text}}\nBoat: {is: Thing}\nCar: {is: Thing}"
    with pytest.raises(DeclarationError, match=r"1\.yaml:1: Boat is a Thing already \(.*0\.yaml:2\)"):
        read(tmp_path, first, "Boat: {is: Car}")
    with pytest.raises(DeclarationError, match=r"1\.yaml:1: Boat\.name is integer, and name is text at .*0\.yaml:1"):
        read(tmp_path, first, "Boat: {has: {name: integer}}")


def test_the_error_names_a_file_that_cannot_be_read(tmp_path: Path) -> None:
    (tmp_path / "types.yaml").touch()
    with pytest.raises(PlatformError, match=r"does not exist; did you mean 'types\.yaml'\?"):
        read_types([tmp_path / "typse.yaml"])
    with pytest.raises(PlatformError, match="cannot be read"):
        read_types([tmp_path])
    (tmp_path / "types.yaml").write_bytes(b"\xff\xfe")
    with pytest.raises(DeclarationError, match="not UTF-8 text"):
        read_types([tmp_path / "types.yaml"])
    (tmp_path / "types.yaml").write_text("[" * 5000)
    with pytest.raises(DeclarationError, match="nested more than 50 levels"):
        read_types([tmp_path / "types.yaml"])
