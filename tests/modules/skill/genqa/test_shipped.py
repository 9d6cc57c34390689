"""The collection of documents that comes with Ravestate is complete, well-formed and small."""

import re
import sqlite3
from importlib.resources import files
from importlib.resources.abc import Traversable

from ravestate.modules.skill.genqa.index import Index
from ravestate.modules.skill.genqa.shipped import SHIPPED, bring_up, documents

FOLDER = files("ravestate.modules.skill.genqa") / "collection"


def content_files() -> list[Traversable]:
    return sorted(FOLDER.iterdir(), key=lambda file: (file.name != "world-factbook.jsonl.gz", file.name))


def sentences() -> dict[str, list[str]]:
    content = [file.read_bytes() for file in content_files()]
    said: dict[str, list[str]] = {}
    for document in documents(*content):
        said.setdefault(document.title, []).extend(p.text for p in document.passages)
    return said


def test_each_country_has_the_facts_that_people_ask_for() -> None:
    said = sentences()
    for country in (
        "Peru",
        "Kenya",
        "Japan",
        "United States",
        "Democratic Republic of the Congo",
        "Vatican City",
    ):
        for beginning in (
            "The capital of",
            "The population of",
            "The area of",
            "The currency of",
            "The form of government of",
        ):
            assert any(text.startswith(beginning) for text in said[country]), (country, beginning)
    assert len(said) > 250


def test_the_sentences_of_the_collection_are_short_and_complete() -> None:
    for title, texts in sentences().items():
        assert len(texts) == len(set(texts)), title
        for text in texts:
            assert 10 < len(text) <= 650, text
            assert text[0] == text[0].upper() or not text[0].isalpha(), text
            assert re.search(r"[.!?][)\"”’]*$", text), text
            assert not re.search(r"<[a-z/]|&\w+;|\s\s|\.\.|[\x00-\x1f]", text), text


def test_the_collection_is_small() -> None:
    assert sum(len(file.read_bytes()) for file in content_files()) < 2_000_000


def test_the_collection_is_indexed_only_once(index: Index) -> None:
    assert bring_up(index)
    assert not bring_up(index)
    known = index.file(SHIPPED)
    assert known is not None
    assert known.passages == index.size() == sum(map(len, sentences().values()))


def test_another_version_of_the_collection_replaces_the_old_one(index: Index) -> None:
    bring_up(index)
    with sqlite3.connect(index.path) as base:
        base.execute("UPDATE files SET digest = 'old'")
    base.close()
    size = index.size()
    assert bring_up(index)
    assert index.size() == size
