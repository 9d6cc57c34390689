"""`check` reads the source of a rule's function. It finds undeclared reads, writes and emits, and forgotten awaits."""

import functools
import inspect
from collections.abc import Callable
from types import ModuleType
from typing import Any

import pytest

import ravestate as rs
from ravestate.policy.source import Acts, acts_of, undeclared

demo = rs.Module("demo")
go, done, late = demo.signal("go", input=True), demo.signal("done"), demo.signal("late")
mood, face, lit = demo.slot("mood"), demo.slot("face"), demo.flag("lit")
people = demo.collection("people")


class Names:
    light = lit


def acts(function: Callable[..., Any], source: Any = inspect.getsource, **options: Any) -> tuple[Acts, list[str]]:
    """Make a function a rule. Return its acts (reads, writes, ...), and a phrase for each undeclared act."""
    module = rs.Module("rules", requires=[demo])
    module.rule(when=go, name="work", **options)(function)
    plan = rs.compile(module).rule_plan("rules:work")
    found = acts_of(plan, source)
    return found, list(undeclared(plan, found))


async def everything(ctx: Any) -> None:
    if ctx[mood] == "calm" and ctx[Names.light]:
        ctx[face] = "smile"
    ctx[mood] += "er"
    ctx[people].add("ada", 1)
    for _ in range(2):
        ctx.emit(done, payload=ctx.payload(late))
    await ctx.sleep(1)


def test_every_access_of_a_rule_to_its_context_is_found() -> None:
    found, faults = acts(everything)
    assert list(found.reads) == [mood, lit, people]
    assert list(found.writes) == [face, mood, people]
    assert (list(found.emits), list(found.payloads), found.forgotten) == ([done], [late], {})
    first = everything.__code__.co_firstlineno
    assert faults == [
        f"reads demo:lit (line {first + 1}) without declaring it: declare reads=demo.lit",
        f"writes demo:face (line {first + 2}), demo:mood (line {first + 3}), demo:people (line {first + 4}) without "
        "declaring it: declare writes=(demo.face, demo.mood, demo.people)",
        f"emits demo:done (line {first + 6}) without declaring it: declare emits=demo.done",
        f"asks for the payload of demo:late (line {first + 6}), which is not in its condition: write when=... | demo.late",
    ]


def test_declared_accesses_cause_no_finding() -> None:
    _, faults = acts(everything, reads=lit, writes=(face, mood, people), emits=done)
    assert len(faults) == 1 and "payload" in faults[0]


def test_names_from_closures_and_modules_are_resolved() -> None:
    here = rs.Module("here").slot("here")
    from ravestate.modules import rawio

    async def work(ctx: Any) -> None:
        ctx[here] = ctx[rawio.output]

    found, _ = acts(work)
    assert (list(found.writes), list(found.reads)) == ([here], [rawio.output])


async def shadowed(ctx: Any, mood: Any = None) -> None:
    face = demo
    ctx[mood] = ctx[face]
    for done in ():
        ctx.emit(done)


async def replaced(ctx: Any) -> None:
    ctx = {}
    ctx[mood] = 1


async def inner(ctx: Any) -> None:
    def helper(ctx: Any) -> None:
        ctx[mood] = 1

    helper({})


async def unknown(ctx: Any) -> None:
    ctx[mood.changed.name] = ctx[{}.get("mood")][face.nothing]
    ctx.emit([done][0])
    ctx.log[mood] = 1


@functools.wraps(everything)
async def wrapped(ctx: Any) -> None:
    await everything(ctx)


@pytest.mark.parametrize("function", [shadowed, replaced, inner, unknown, wrapped, functools.partial(everything)])
def test_names_that_cannot_be_resolved_cause_no_finding(function: Any) -> None:
    found, faults = acts(function)
    assert (found, faults) == (Acts(), [])


@pytest.mark.parametrize("error", [OSError, TypeError, SyntaxError])
def test_a_function_without_source_causes_no_finding(error: type[Exception]) -> None:
    def source(function: Any) -> str:
        raise error

    assert acts(everything, source) == (Acts(), [])


def test_a_failed_import_causes_no_finding() -> None:
    lazy = ModuleType("lazy")

    def fails(name: str) -> Any:
        if name == "slot":
            raise ImportError("a missing package")
        return ModuleType("other").gone

    lazy.__dict__["__getattr__"] = fails

    def broken(ctx: Any) -> None:
        ctx[lazy.slot] = ctx[lazy.other]

    assert acts(broken) == (Acts(), [])


def test_a_name_that_does_not_exist_is_found_with_a_suggestion() -> None:
    """A misspelt slot or signal fails when the rule runs; `check` finds it before."""
    from ravestate.modules import idle, rawio

    async def work(ctx: Any) -> None:
        ctx[rawio.outptu] = "x"  # type: ignore[attr-defined]
        if ctx[moood] and ctx[lit.tru]:  # type: ignore[name-defined] # noqa: F821
            ctx.emit(idle.borde)  # type: ignore[attr-defined]
        ctx.payload(rawio.inpt.changed)  # type: ignore[attr-defined]
        ctx[demo.peple].add("ada", 1)  # type: ignore[attr-defined]
        ctx.wipe(rs.startpu)  # type: ignore[attr-defined]

    found, faults = acts(work)
    first = work.__code__.co_firstlineno
    assert faults == []
    assert list(found.unknown) == [
        f"rawio.outptu (line {first + 1}), which does not exist; did you mean 'output'?",
        f"moood (line {first + 2}), which does not exist; did you mean 'mood'?",
        f"lit.tru (line {first + 2}), which does not exist; did you mean 'true'?",
        f"idle.borde (line {first + 3}), which does not exist; did you mean 'bored'?",
        f"rawio.inpt (line {first + 4}), which does not exist; did you mean 'input'?",
        f"demo.peple (line {first + 5}), which does not exist",
        f"rs.startpu (line {first + 6}), which does not exist; did you mean 'startup'?",
    ]


def test_builtins_and_local_names_cause_no_finding() -> None:
    async def work(ctx: Any) -> None:
        import ravestate.modules.modality.rawio as io

        for slot in (mood, face):
            ctx[slot] = "x"
        ctx[print] = [ctx[one] for one in (mood,)]
        ctx[io.output] = "x"

    assert acts(work)[0].unknown == {}


def test_a_closure_variable_without_a_value_causes_no_finding() -> None:
    def work(ctx: Any) -> None:
        ctx[later] = 1

    assert acts(work) == (Acts(), [])
    later = 1


def test_a_branch_that_a_closure_variable_excludes_causes_no_finding() -> None:
    def make(quiet: bool) -> Any:
        async def say(ctx: Any) -> None:
            if quiet:
                ctx[mood] = "calm"
            else:
                ctx[face] = "smile"
            ctx.emit(done)
            if quiet:
                return
            ctx[people].add("ada", 1)

        return say

    found, faults = acts(make(quiet=True), writes=mood)
    assert (found.writes, list(found.emits)) == ({}, [done])
    assert len(faults) == 1 and faults[0].startswith("emits demo:done")


def test_a_branch_that_depends_on_the_value_of_a_slot_is_examined() -> None:
    feeling = mood

    async def say(ctx: Any) -> None:
        if ctx[feeling] == "calm":
            ctx.emit(done)

    assert list(acts(say)[0].emits) == [done]


def test_the_advice_gives_a_built_in_flag_as_rs_dot_name() -> None:
    async def look(ctx: Any) -> None:
        ctx[rs.pressure]

    assert acts(look)[1][0].endswith("declare reads=rs.pressure")


HAVE_LIGHT = False


async def guarded(ctx: Any) -> None:
    if HAVE_LIGHT:
        ctx[face] = ctx[demo.slot_of_a_newer_version]
    if hasattr(demo, "loudness"):
        ctx[demo.loudness] = 1.0
    try:
        ctx.emit(demo.loud)
    except AttributeError:
        ctx[mood] = "quiet"


def test_code_that_first_checks_whether_a_name_exists_causes_no_finding() -> None:
    found, missing = acts(guarded, writes=mood)
    assert (list(found.unknown), missing) == ([], [])
