"""An index of the shipped collection, and an empty one."""

import sqlite3
from collections.abc import Iterator
from pathlib import Path

import pytest

from ravestate.language.network import network
from ravestate.modules.skill.genqa.answering import Answerer
from ravestate.modules.skill.genqa.index import Index


@pytest.fixture(scope="session", autouse=True)
def _networks() -> None:
    network().load()


@pytest.fixture(scope="session")
def collection_file(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return the file of the index of `collection`."""
    return tmp_path_factory.mktemp("collection") / "index.sqlite"


@pytest.fixture(scope="session")
def collection(collection_file: Path) -> Iterator[Answerer]:
    """Return an answerer for the collection that comes with Ravestate."""
    answerer = Answerer(collection_file)
    answerer.load()
    yield answerer
    answerer.close()


@pytest.fixture
def index(tmp_path: Path, connections: list[sqlite3.Connection]) -> Iterator[Index]:
    """Return an empty index."""
    with Index(tmp_path / "index.sqlite") as index:
        yield index
