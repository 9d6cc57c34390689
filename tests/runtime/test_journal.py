"""A new engine that gets the journal of a real run has the same effects (law L24)."""

import asyncio
from typing import Any

import ravestate as rs
from ravestate.engine.effects import Cancel, Effect, Ended, Run
from ravestate.engine.engine import Engine
from ravestate.engine.events import AddRule, Emit, Finish, Start, Stop, Write
from ravestate.engine.trace import Record
from ravestate.policy.policy import Policy
from ravestate.runtime.journal import Entry, Journal, Taken, replay
from ravestate.runtime.listeners import Hooks
from runtime.on_loop import on_loop, turns

m = rs.Module("m")
heard = m.slot("heard", "", always=True)
question, stop = m.signal("question"), m.signal("stop")
said, people = m.slot("said", "", always=True), m.collection("people")


@m.rule(when=heard.changed, emits=question)
async def classify(ctx: rs.RuleContext) -> None:
    await asyncio.sleep(0)
    if ctx.payload(heard.changed).endswith("?"):
        ctx.emit(question)


@m.rule(when=heard.changed, writes=said)
async def chat(ctx: rs.RuleContext) -> None:
    ctx[said] = "I see"


@m.rule(when=question, writes=said, cooldown=30.0)
async def answer(ctx: rs.RuleContext) -> None:
    ctx[said] = "because"


@m.rule(when=question & stop, writes=said)
async def refuse(ctx: rs.RuleContext) -> rs.Resign:
    return rs.Resign("never")


@m.rule(when=heard.changed, writes=people, until=stop)
def remember(ctx: rs.RuleContext) -> None:
    ctx[people].add(str(len(ctx[people])), ctx.payload(heard.changed))


async def conversation(context: rs.Context) -> None:
    """Give the context inputs one by one and several at the same time, with and without a wait. Also add a rule."""
    context.put(heard, "hello")
    await context.quiet()
    context.put(heard, "why?")
    context.emit(stop)
    context.put(heard, "why not?")
    await turns(2)
    context.put(heard, "no")
    await context.quiet()
    context.explain("m:chat")

    async def late(ctx: rs.RuleContext) -> None:
        raise ValueError("late")

    context.add_rule(rs.Module("late").rule(when=heard.changed, name="late")(late))
    for word in ("a?", "b", "c?"):
        context.put(heard, word)
    await context.quiet()


async def recorded() -> tuple[Policy, list[Entry], list[Record], list[object]]:
    journal, policy = Journal(), rs.compile(m)
    records: list[Record] = []
    async with rs.Context(policy, journal=journal, trace=records.append, patience=0.01) as context:
        await conversation(context)
        seen = [context.read(slot) for slot in (heard, said)] + [dict(context.read(people))]
    return policy, journal.entries, records, seen


def shape(effects: list[list[Effect]]) -> list[str]:
    return [repr((e.run, e.rule.name)) if isinstance(e, Run) else repr(e) for batch in effects for e in batch]


@on_loop
async def test_a_replay_gives_the_same_trace_and_the_same_values_as_the_run() -> None:
    policy, entries, records, seen = await recorded()
    engine = Engine(policy, patience=0.01)
    again: list[Record] = []
    engine.tracer = again.append
    replay(engine, entries)
    assert again == records
    assert [engine.read(engine.policy.slot_of[f"m:{name}"].index) for name in ("heard", "said")] == seen[:2]
    assert dict(engine.read(engine.policy.slot_of["m:people"].index)) == seen[2]


@on_loop
async def test_a_replay_gives_the_same_effects_each_time() -> None:
    policy, entries, *_ = await recorded()
    first = shape(replay(Engine(policy, patience=0.01), entries))
    second = shape(replay(Engine(policy, patience=0.01), entries))
    assert first == second
    assert any("m:answer" in effect for effect in first)


quick = rs.Module("quick")
asked, told, sure = quick.slot("asked", "", always=True), quick.slot("told", "", always=True), quick.signal("sure")


@quick.rule(when=asked.changed, emits=sure)
async def judge(ctx: rs.RuleContext) -> rs.Resign | None:
    if ctx.payload(asked.changed) == "never":
        return rs.Resign("not sure")
    ctx.emit(sure)
    return None


@quick.rule(when=sure, writes=told, cooldown=1000.0, timeout=1000.0)
async def tell(ctx: rs.RuleContext) -> None:
    ctx[told] = "yes"


@quick.rule(when=asked.changed, writes=told, until=sure)
async def doubt(ctx: rs.RuleContext) -> None:
    ctx[told] = "perhaps"
    await ctx.sleep(0.001)


@on_loop
async def test_a_recorded_or_traced_run_makes_the_same_decisions_as_a_plain_run() -> None:
    """Without a journal and a trace, the runner calls the engine directly, without event records (L25)."""

    async def ends(**options: Any) -> list[Ended]:
        found: list[Ended] = []
        context = rs.Context(quick, **options)
        await context.start(Hooks(on_ended=found.append))
        for text in ("well", "never", "well", "so", "never", "never"):
            context.put(asked, text)
            await context.quiet()
        await context.stop()
        return found

    told_short = await ends()
    assert len({end.outcome for end in told_short}) > 1
    assert (
        told_short
        == await ends(journal=Journal())
        == await ends(trace=True)
        == await ends(journal=Journal(), trace=True)
    )


@on_loop
async def test_a_journal_has_every_event_in_order_with_its_time() -> None:
    _, entries, *_ = await recorded()
    kinds = [type(entry.event) for entry in entries]
    assert kinds[0] is Start and kinds.count(Stop) == 1 and kinds.count(AddRule) == 1
    assert {Write, Emit, Finish, Taken} <= set(kinds)
    times = [entry.time for entry in entries]
    assert times == sorted(times) and times[0] >= 0.0


@on_loop
async def test_a_function_can_be_the_journal() -> None:
    told: list[tuple[object, float]] = []
    async with rs.Context(m, journal=lambda event, time: told.append((event, time))) as context:
        context.emit(stop)
    assert Emit("m:stop") in [event for event, _ in told]


def test_a_journal_keeps_copies_of_events() -> None:
    journal = Journal()
    event = Emit("m:stop", "before")
    journal(event, 1.0)
    event.payload = "after"
    assert journal.entries == [Entry(1.0, Emit("m:stop", "before"))]


def test_a_replay_interrupts_a_run_that_was_interrupted() -> None:
    n = rs.Module("n")
    go, halt = n.signal("go"), n.signal("halt")

    @n.rule(when=go, until=halt)
    async def long(ctx: rs.RuleContext) -> None:
        await asyncio.get_running_loop().create_future()

    journal, policy = Journal(), rs.compile(n)

    async def main() -> None:
        async with rs.Context(policy, journal=journal) as context:
            context.emit(go)
            await turns()
            context.emit(halt)
            await context.quiet()

    asyncio.run(main())
    effects = [effect for batch in replay(Engine(policy), journal.entries) for effect in batch]
    assert [effect.reason for effect in effects if isinstance(effect, Cancel)] == ["interrupted"]


def test_a_journal_can_be_written_and_replayed_with_or_without_a_tracer() -> None:
    n = rs.Module("n")
    one, two = n.signal("one"), n.signal("two")

    @n.rule(when=one & two)
    async def pair(ctx: rs.RuleContext) -> None: ...

    policy = rs.compile(n)

    async def journal_of(*, trace: bool) -> list[Entry]:
        journal = Journal()
        async with rs.Context(policy, journal=journal, trace=trace) as context:
            for signal in (two, one, two, one):
                context.emit(signal)
            await context.quiet()
        return journal.entries

    told: list[list[str]] = []
    for written_traced in (False, True):
        entries = asyncio.run(journal_of(trace=written_traced))
        for replayed_traced in (False, True):
            engine = Engine(policy)
            engine.tracer = void if replayed_traced else None
            told.append([repr(batch) for batch in replay(engine, entries)])
    assert "run=2" in "".join(told[0])
    assert all(one == told[0] for one in told)


def void(record: Record) -> None:
    """Ignore a record."""
