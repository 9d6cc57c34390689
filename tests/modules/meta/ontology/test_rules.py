"""Agents with memory, and slots that are bound to memory."""

from __future__ import annotations

import asyncio
import sys
from pathlib import Path
from typing import Any

import pytest

import ravestate as rs
from modules.meta.ontology.conftest import Open
from ravestate.errors import DeclarationError
from ravestate.modules import ontology
from ravestate.testing import simulate

Node = ontology.Node

host = rs.Module("host", requires=[ontology])
ask = host.signal("ask", payload=str)
answer = host.slot("answer", "")
begun = host.slot("begun", "")


@host.rule(when=rs.startup, reads=ontology.memory, writes=begun)
async def begin(ctx: rs.RuleContext) -> None:
    """Use memory at startup: rules can use it from the first moment."""
    memory = ctx[ontology.memory]
    ctx[begun] = "no memory" if memory is None else f"{len(await memory.find('Person'))} known"


@host.rule(when=ask, reads=ontology.memory, writes=answer)
async def look_up(ctx: rs.RuleContext) -> rs.Resign | None:
    memory = ctx[ontology.memory]
    if memory is None:
        return rs.Resign("there is no memory")
    found = await memory.ensure("Person", name=ctx.payload(ask))
    ctx[answer] = f"{found['name']} of {len(await memory.find('Person'))}"
    return None


@host.rule(when=ask, reads=ontology.memory, writes=answer, weight=0.5)
def look_up_in_a_thread(ctx: rs.RuleContext) -> None:
    memory = ctx[ontology.memory]
    ctx[answer] = "none" if memory is None else str(len(memory.find("Person").result()))


def at(path: Path, **more: Any) -> dict[str, Any]:
    return {"ontology": {"path": path, **more}}


def test_memory_outlives_the_agent(tmp_path: Path) -> None:
    for number, name in enumerate(("Ada", "Bob", "Cy"), start=1):
        with simulate(host, settings=at(tmp_path / "m.lbug")) as sim:
            assert sim.read(begun) == f"{number - 1} known"
            sim.emit(ask, name)
            assert sim.read(answer) == f"{name} of {number}"
            assert sim.failures == [] and sim.now == 0.0


def test_plain_functions_can_use_memory(tmp_path: Path) -> None:
    threads = rs.Module("threads", requires=[ontology])
    go = threads.signal("go")
    found = threads.slot("found", 0)

    @threads.rule(when=go, reads=ontology.memory, writes=found)
    def look(ctx: rs.RuleContext) -> None:
        memory = ctx[ontology.memory]
        assert memory is not None
        memory.create("Person", name="Ada").result()
        ctx[found] = len(memory.find("Person").result())

    with simulate(threads, settings=at(tmp_path / "m.lbug")) as sim:
        sim.emit(go)
        assert sim.read(found) == 1


def test_contexts_of_one_process_share_a_file(tmp_path: Path) -> None:
    async def talk() -> list[str]:
        settings = at(tmp_path / "m.lbug")
        async with rs.Context(host, settings=settings) as one, rs.Context(host, settings=settings) as other:
            said: list[str] = []
            for context, name in ((one, "Ada"), (other, "Bob"), (one, "Cy")):
                context.emit(ask, name)
                said.append(await context.next(answer.changed, timeout=20))
            return said

    assert asyncio.run(talk()) == ["Ada of 1", "Bob of 2", "Cy of 3"]


def test_the_event_loop_continues_while_memory_is_busy(tmp_path: Path) -> None:
    async def talk() -> float:
        async with rs.Context(host, settings=at(tmp_path / "m.lbug")) as context:
            memory = context.read(ontology.memory)
            while memory is None:
                await asyncio.sleep(0)
                memory = context.read(ontology.memory)
            blocked = memory.submit("wait", lambda _: held.wait(20))
            context.emit(ask, "Ada")
            turns = 0
            while turns < 100:  # the loop continues while memory is blocked
                await asyncio.sleep(0)
                turns += 1
            assert context.read(answer) == ""
            held.set()
            assert await blocked
            await context.next(answer.changed, timeout=20)
            return turns

    import threading

    held = threading.Event()
    assert asyncio.run(talk()) == 100


def test_without_the_package_the_agent_runs_without_memory(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    monkeypatch.setitem(sys.modules, "ladybug", None)
    with simulate(host, settings=at(tmp_path / "m.lbug")) as sim:
        assert sim.read(ontology.memory) is None
        sim.emit(ask, "Ada")
        assert sim.read(answer) == "none"  # the next best rule has answered
        assert {rule for rule, _ in sim.failures} <= {"host:begin"}
    [warned] = [record for record in caplog.records if record.name == "ravestate.ontology.open_up"]
    assert warned.levelname == "WARNING"
    assert warned.getMessage() == (
        "there is no long-term memory in this conversation: ontology needs ladybug: pip install 'ravestate[ontology]'"
    )


def test_a_context_with_an_error_in_a_type_file_cannot_be_made(tmp_path: Path) -> None:
    types = tmp_path / "mine.yaml"
    types.write_text("Boat:\n  is: Thnig\n")
    with pytest.raises(rs.DeclarationErrors) as refused:
        simulate(ontology, settings=at(tmp_path / "m.lbug", types=(types,)))
    assert f"{types}:2: Boat is a 'Thnig', which is not a type; did you mean 'Thing'?" in str(
        refused.value.exceptions[0]
    )


# ------------------------------------------------------------------------------------ bound slots

desk = rs.Module("desk", requires=[ontology])
guest = ontology.bound(desk, "guest", "Person")
said = desk.signal("said", payload=object)


@desk.rule(when=said, reads=guest, writes=guest)
async def meet(ctx: rs.RuleContext) -> None:
    known = ctx[guest]
    what = ctx.payload(said)
    if isinstance(what, dict):
        ctx[guest] = Node("Person", what) if known is None else known.with_properties(**what)
    else:
        ctx[guest] = what


def test_a_write_to_a_bound_slot_also_writes_to_memory(tmp_path: Path, open_here: Open) -> None:
    with simulate(desk, settings=at(tmp_path / "m.lbug")) as sim:
        for number in range(20):
            sim.emit(said, {"name": f"Ada {number}", "age": number})
        sim.emit(said, {"nickname": "A", "age": None})
        ada = sim.read(guest)
        assert ada is not None and sim.failures == []
    memory = open_here(path=tmp_path / "m.lbug")
    [found] = memory.find("Person").result()
    assert (found.id, dict(found.properties)) == (ada.id, {"name": "Ada 19", "nickname": "A"})


def test_writing_none_to_a_bound_slot_does_not_forget_the_person(tmp_path: Path, open_here: Open) -> None:
    with simulate(desk, settings=at(tmp_path / "m.lbug")) as sim:
        sim.emit(said, {"name": "Ada"})
        sim.emit(said, None)
        sim.emit(said, {"name": "Bob"})
        assert sim.failures == []
    memory = open_here(path=tmp_path / "m.lbug")
    assert [node["name"] for node in memory.find("Person").result()] == ["Ada", "Bob"]


def test_writes_before_memory_is_open_and_right_before_the_end_are_kept(tmp_path: Path, open_here: Open) -> None:
    hasty = rs.Module("hasty", requires=[ontology])
    first, last = ontology.bound(hasty, "first", "Person"), ontology.bound(hasty, "last", "Person")

    @hasty.rule(when=rs.startup, writes=first)
    async def begin(ctx: rs.RuleContext) -> None:
        ctx[first] = Node("Person", {"name": "Ada"})

    @hasty.rule(when=rs.shutdown, writes=last)
    async def end(ctx: rs.RuleContext) -> None:
        await ctx.sleep(0.5)
        ctx[last] = Node("Person", {"name": "Zoe"})

    with simulate(hasty, settings=at(tmp_path / "m.lbug")) as sim:
        pass
    assert sim.failures == []
    memory = open_here(path=tmp_path / "m.lbug")
    assert [node["name"] for node in memory.find("Person").result()] == ["Ada", "Zoe"]


@pytest.mark.parametrize(
    ("value", "message"),
    [
        (Node("Person", {"nmae": "Ada"}), "Person has no 'nmae'; did you mean 'name'?"),
        (Node("City", {"name": "Ham"}), "is a City, not a Person"),
        (Node("Boat"), "there is no type 'Boat'"),
    ],
)
def test_a_write_that_memory_refuses_raises_an_error(tmp_path: Path, value: object, message: str) -> None:
    with simulate(desk, settings=at(tmp_path / "m.lbug")) as sim:
        sim.emit(said, value)
        [(rule, error)] = sim.failures
        assert rule == "desk:remember_guest" and message in str(error)


def test_a_write_to_a_bound_slot_without_memory_raises_an_error(tmp_path: Path) -> None:
    (tmp_path / "m.lbug").mkdir()
    with simulate(desk, settings=at(tmp_path / "m.lbug")) as sim:
        sim.emit(said, {"name": "Ada"})
        [(rule, error)] = sim.failures
        assert rule == "desk:remember_guest" and "is not remembered: there is no memory" in str(error)


def test_a_bound_slot_needs_a_module_that_requires_ontology() -> None:
    with pytest.raises(DeclarationError, match=r"write rs.Module\('alone', requires=\[ontology, ...\]\)"):
        ontology.bound(rs.Module("alone"), "guest", "Person")


def test_bound_slots_cause_no_findings() -> None:
    policy = rs.compile(desk)
    assert "desk:remember_guest" in policy.rules
    assert [finding for finding in policy.findings() if "guest" in str(finding)] == []
