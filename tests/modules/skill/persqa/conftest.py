"""A pipeline that all tests share, and a memory file for each test."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from ravestate.language.matcher import bundled_matcher
from ravestate.language.network import network
from ravestate.modules import ontology
from ravestate.modules.meta.nlp.analysis import MATCHERS
from ravestate.modules.meta.nlp.pipeline import pipeline
from ravestate.modules.meta.ontology.opening import open_memory
from ravestate.modules.skill.persqa import kinds

Look = Callable[[], dict[str, Any]]


@pytest.fixture(scope="session")
def reader() -> None:
    """Load the pipeline and the examples, once for all tests."""
    pipeline("").load()
    kinds.load()
    network().load()
    for name in MATCHERS:
        bundled_matcher(name).load()


@pytest.fixture
def file(tmp_path: Path) -> Path:
    return tmp_path / "memory.lbug"


@pytest.fixture
def look(file: Path) -> Look:
    """Return a function that returns the people in memory: name → relation → names of the related nodes.

    Call this function only while no agent runs.
    """

    def people() -> dict[str, Any]:
        memory = open_memory(ontology.Settings(path=file))
        try:
            found: dict[str, Any] = {}
            for person in memory.find("Person").result(20):
                relations = memory.relations(person).result(20)
                own = [relation for relation in relations if relation.source.id == person.id]
                found.setdefault(person["name"], {})
                for relation in own:
                    target = relation.target.get("name") or relation.target["wording"]
                    found[person["name"]].setdefault(relation.name, []).append(target)
            return found
        finally:
            memory.close().result(20)

    return people
