"""Reading YAML: correct texts, and hostile or invalid texts that must be refused quickly with a message."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from ravestate.errors import DeclarationError, RavestateError
from ravestate.loading.spec import AgentSpec
from ravestate.modules.meta.ontology.type_files import read_types
from ravestate.modules.meta.verbaliser.phrases import PhraseBook
from ravestate.modules.skill.agentqa.life_file import read_life
from ravestate.yaml_text import compose_yaml, load_yaml

LAUGHS = "a: &a [x, x, x, x, x, x, x, x, x, x]\n" + "".join(
    f"{name}: &{name} [{', '.join([f'*{before}'] * 10)}]\n"
    for before, name in zip("abcdefghijkl", "bcdefghijklm", strict=True)
)
"""YAML with a trillion values in 13 lines."""

HOSTILE = {
    "aliases": (LAUGHS, "file.yaml:5: more than 100,000 values once the aliases are followed"),
    "lists": ("[" * 5_000, "file.yaml:1: nested more than 50 levels deep"),
    "mappings": ("{a: " * 5_000, "file.yaml:1: nested more than 50 levels deep"),
    "lines": ("- " * 5_000, "file.yaml:1: nested more than 50 levels deep"),
    "a repeated key": ("a: 1\na: 2", "file.yaml:2: 'a' is here twice (first in line 1): write it once"),
    "a circle": ("a: 1\nb: &b [*b]", "file.yaml:2: alias *b refers to itself"),
}


def test_a_yaml_text_is_read_as_its_values() -> None:
    assert load_yaml("a: &a [1, two, 3.0, yes]\nb: *a\nc: {<<: {d: e}}\n", "file.yaml") == {
        "a": [1, "two", 3.0, True], "b": [1, "two", 3.0, True], "c": {"d": "e"},
    }  # fmt: skip
    assert load_yaml("", "file.yaml") is compose_yaml("", "file.yaml") is None


@pytest.mark.parametrize("read", [load_yaml, compose_yaml])
@pytest.mark.parametrize(("text", "message"), HOSTILE.values(), ids=HOSTILE)
def test_hostile_texts_are_refused_immediately(read: Callable[[str, str], Any], text: str, message: str) -> None:
    with pytest.raises(DeclarationError) as caught:
        read(text, "file.yaml")
    assert str(caught.value) == message


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (
            "a: 1\nb: [",
            "file.yaml:2: not valid YAML (while parsing a flow node, expected the node content, but ",
        ),
        ("a: b: c", "file.yaml:1: not valid YAML (mapping values are not allowed here). Put quotes around"),
        ("a: 1\n\x07", "file.yaml:2: not valid YAML (a control character)"),
        ("a: *b", "file.yaml:1: not valid YAML (found undefined alias 'b')"),
        ("a: !!python/name:os.system", "file.yaml:1: not valid YAML (could not determine a constructor"),
        ("a: 2023-02-30", "file.yaml: not valid YAML (day "),
        (f"a: {'1' * 5_000}", "file.yaml:1: not valid YAML (a number of more than 300 digits)"),
        (f"a: {':'.join(['59'] * 200_000)}", "file.yaml:1: not valid YAML (a number of more than 300 digits)"),
        (f"a: {':'.join(['59'] * 1_000)}.5", "file.yaml:1: not valid YAML (a number of more than 300 digits)"),
    ],
)
def test_the_error_about_an_invalid_text_names_the_line(text: str, message: str) -> None:
    with pytest.raises(DeclarationError) as caught:
        load_yaml(text, "file.yaml")
    assert str(caught.value).startswith(message)


@pytest.mark.parametrize("read", [load_yaml, compose_yaml])
@pytest.mark.parametrize(
    ("text", "message"),
    [
        ('a: {b: 1, c: 2,\n  "b": 3}', "file.yaml:2: 'b' is here twice (first in line 1): write it once"),
        ("- &k a: 1\n- *k : 2\n  *k : 3", "file.yaml:1: 'a' is here twice (first in line 1): write it once"),
    ],
)
def test_a_key_that_a_mapping_repeats_is_refused(read: Callable[[str, str], Any], text: str, message: str) -> None:
    with pytest.raises(DeclarationError) as caught:
        read(text, "file.yaml")
    assert str(caught.value) == message


def test_keys_may_be_equal_in_different_mappings_or_differ_by_type() -> None:
    assert load_yaml('[{a: 1}, {a: {a: 2}}, {1: 3, "1": 4}]', "file.yaml") == [
        {"a": 1},
        {"a": {"a": 2}},
        {1: 3, "1": 4},
    ]


def test_a_mapping_may_merge_several_others() -> None:
    text = "x: &x {a: 1}\ny: &y {b: 2}\nz:\n  <<: *x\n  <<: *y\n  c: 3"
    assert load_yaml(text, "file.yaml")["z"] == {"a": 1, "b": 2, "c": 3}
    assert load_yaml("x: &x {a: 1, b: 1}\nz: {<<: *x, a: 2}", "file.yaml")["z"] == {"a": 2, "b": 1}


@pytest.mark.parametrize(
    ("first", "second"),
    [("1", "0x1"), ("yes", "true"), ("1", "1.0"), ("1", "on"), ("~", "null")],
)
def test_equal_keys_are_refused_in_any_spelling(first: str, second: str) -> None:
    text = f"a: 1\n{first}: b\n{second}: c"
    with pytest.raises(DeclarationError) as caught:
        load_yaml(text, "file.yaml")
    assert str(caught.value) == f"file.yaml:3: {second!r} is the same key as {first!r} in line 2: write it once"
    assert compose_yaml(text, "file.yaml") is not None  # there, each scalar is a text


READERS: dict[str, Callable[[Path], object]] = {
    "types": lambda path: read_types([path]),
    "phrases": lambda path: PhraseBook.load([path]),
    "life": read_life,
    "agent": AgentSpec.from_file,
}


@pytest.mark.parametrize("read", READERS.values(), ids=READERS)
@pytest.mark.parametrize("kind", ["aliases", "mappings", "a repeated key"])
def test_every_reader_of_user_files_refuses_hostile_texts(
    read: Callable[[Path], object], kind: str, tmp_path: Path
) -> None:
    text, message = HOSTILE[kind]
    (tmp_path / "file.yaml").write_text(text, encoding="utf-8")
    with pytest.raises(RavestateError) as caught:
        read(tmp_path / "file.yaml")
    assert message.partition(":")[2] in str(caught.value) and "file.yaml" in str(caught.value)
