"""The agent keeps a node about itself in memory."""

from __future__ import annotations

import asyncio
from collections.abc import Awaitable, Callable
from dataclasses import replace
from datetime import date
from pathlib import Path
from typing import Any

import pytest

from ravestate.modules import ontology
from ravestate.modules.meta.ontology.opening import open_memory, types_of
from ravestate.modules.skill.agentqa import Life
from ravestate.modules.skill.agentqa.itself import RELATIONS, recall, settle

LIFE = Life({"name": "Robin", "born": "2020-05-04", "hobbies": ("chess", "art"), "home": "Rome", "wheels": "3"}, {})


@pytest.fixture
def with_memory(tmp_path: Path) -> Callable[[Callable[[ontology.Memory], Awaitable[Any]]], Any]:
    def run(use: Callable[[ontology.Memory], Awaitable[Any]]) -> Any:
        async def inside() -> Any:
            memory = open_memory(ontology.Settings(path=tmp_path / "m.lbug"))
            try:
                return await use(memory)
            finally:
                await memory.close()

        return asyncio.run(inside())

    return run


def changed(**facts: Any) -> Life:
    return replace(LIFE, facts={key: fact for key, fact in {**LIFE.facts, **facts}.items() if fact is not None})


def test_memory_has_each_relation_and_type_that_the_agents_facts_need() -> None:
    types = types_of(ontology.Settings())
    for relation, type in RELATIONS.values():
        types.check_relation("Robot", relation, type)  # raises an error if memory has no such relation


def test_each_start_updates_the_agents_node_in_memory_from_the_life_file(with_memory: Any) -> None:
    async def first(memory: ontology.Memory) -> None:
        node = await settle(LIFE, memory)
        assert node["born"] == date(2020, 5, 4)
        assert {home["name"] for home in await memory.related(node, "lives_in")} == {"Rome"}

    async def second(memory: ontology.Memory) -> None:
        node = await settle(changed(home="Paris", hobbies=("art", "tea"), born="2021-01-01"), memory)
        assert len(await memory.find("Robot")) == 1 and node["born"] == date(2021, 1, 1)
        assert {home["name"] for home in await memory.related(node, "lives_in")} == {"Paris"}
        assert {hobby["name"] for hobby in await memory.related(node, "has_hobby")} == {"art", "tea"}

    with_memory(first)
    with_memory(second)


def test_storing_the_same_facts_a_second_time_changes_nothing(with_memory: Any) -> None:
    async def use(memory: ontology.Memory) -> None:
        await settle(LIFE, memory)
        before = await memory.export()
        await settle(LIFE, memory)
        assert await memory.export() == before

    with_memory(use)


def test_facts_come_from_memory_in_the_order_of_the_life_file(with_memory: Any) -> None:
    async def use(memory: ontology.Memory) -> None:
        node = await settle(LIFE, memory)
        await memory.relate(node, "has_hobby", await memory.ensure("Hobby", name="juggling"))
        await memory.relate(node, "friend_of", await memory.ensure("Person", name="Ada"))
        facts = await recall(LIFE, memory)
        assert facts["hobbies"] == ("chess", "art", "juggling")
        assert facts["friends"] == ("Ada",)  # only in memory, not in the life file
        assert facts["wheels"] == "3" and facts["siblings"] == ()

    with_memory(use)


def test_memory_keeps_facts_that_the_life_file_does_not_mention(with_memory: Any) -> None:
    async def use(memory: ontology.Memory) -> None:
        node = await settle(LIFE, memory)
        await memory.relate(node, "friend_of", await memory.ensure("Person", name="Ada"))
        await settle(LIFE, memory)
        assert (await recall(LIFE, memory))["friends"] == ("Ada",)
        await settle(changed(friends=("Bob",)), memory)
        assert (await recall(LIFE, memory))["friends"] == ("Bob",)
        assert await memory.find("Person", name="Ada")  # Ada stays in memory

    with_memory(use)


def test_without_a_node_in_memory_the_facts_come_from_the_life_file(with_memory: Any) -> None:
    async def use(memory: ontology.Memory) -> None:
        assert await recall(LIFE, memory) == LIFE.facts

    with_memory(use)
