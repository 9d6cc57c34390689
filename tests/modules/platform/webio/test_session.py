"""In a conversation: visitors who are writing, the agent's name, and the reason for the end."""

import asyncio

import pytest

import ravestate as rs
from modules.platform.webio.visit import Visit, in_virtual_time, page, parrot, past
from ravestate.modules import idle, interloc, rawio
from ravestate.modules.platform.webio.session import Ending

watcher = rs.Module("watcher", requires=(rawio,))


@watcher.rule(when=rawio.typing, writes=rawio.output)
async def notice(ctx: rs.RuleContext) -> None:
    ctx[rawio.output] = "You write."


bored = rs.Module("bored", requires=(rawio, idle))


@bored.rule(when=idle.bored, writes=rawio.output)
async def remark(ctx: rs.RuleContext) -> None:
    ctx[rawio.output] = "It is quiet here."


named = rs.Module("named", requires=(rawio, interloc))


@named.rule(when=rs.startup.detached(), writes=interloc.agent, detached=True)
async def be_born(ctx: rs.RuleContext) -> None:
    ctx[interloc.agent] = "Robin"


@named.rule(when=rawio.input.changed, writes=(interloc.agent, rawio.output))
async def be_renamed(ctx: rs.RuleContext) -> None:
    ctx[interloc.agent] = ctx.payload(rawio.input.changed)
    ctx[rawio.output] = "So be it."


late = rs.Module("late", requires=(interloc,))


@late.rule(when=rs.startup.detached(), writes=interloc.agent, detached=True)
async def find_out(ctx: rs.RuleContext) -> None:
    await ctx.sleep(3.0)
    ctx[interloc.agent] = "Ro\x1b[2Jbin"


def now() -> float:
    return asyncio.get_running_loop().time()


@in_virtual_time
async def test_only_the_visitors_own_agent_notices_that_they_are_writing() -> None:
    async with page(watcher) as app, Visit(app) as ada, Visit(app) as bob:
        await ada.hello()
        await bob.hello()
        ada.tell("writing")
        assert await ada.messages(1) == ["agent: You write."]
        assert bob.nothing_more()


@in_virtual_time
async def test_a_bored_agent_speaks_to_a_silent_visitor() -> None:
    async with page(bored) as app, Visit(app) as visit:
        await visit.hello()
        assert await visit.messages(1) == ["agent: It is quiet here."]
        assert now() == idle.Settings().bored_after


@in_virtual_time
async def test_the_agent_is_not_bored_while_the_visitor_is_writing() -> None:
    async with page(parrot, bored) as app, Visit(app) as visit:
        await visit.hello()
        await visit.messages(1)
        for _ in range(15):
            await past(2.0)
            visit.tell("writing")
        await past(1.0)
        assert visit.nothing_more()
        visit.say("Half a minute.")
        assert await visit.messages(3) == [
            "user: Half a minute.",
            "agent: Half a minute.",
            "agent: It is quiet here.",
        ]
        assert now() == 31.0 + idle.Settings().bored_after


@in_virtual_time
async def test_the_agent_speaks_to_a_visitor_who_writes_but_never_sends_the_text() -> None:
    async with page(bored) as app, Visit(app) as visit:
        await visit.hello()
        await past(1.0)
        visit.tell("writing")
        assert await visit.messages(1) == ["agent: It is quiet here."]
        assert now() == 1.0 + idle.Settings().writing_time


@in_virtual_time
async def test_writing_after_the_farewell_is_ignored() -> None:
    async with page(watcher) as app, Visit(app) as visit:
        await visit.hello()
        visit.tell("bye")
        visit.tell("writing")
        assert [frame["type"] for frame in await visit.frames("ended")] == ["ended"]


@in_virtual_time
async def test_a_text_after_the_farewell_gets_an_error() -> None:
    async with page(parrot) as app, Visit(app) as visit:
        await visit.hello()
        await visit.messages(1)
        visit.tell("bye")
        visit.say("wait!", id="a")
        frames = await visit.frames("ended")
        assert {
            "type": "error",
            "code": "over",
            "text": "the conversation is ending, so it takes no more words",
            "id": "a",
        } in frames
        assert [frame["text"] for frame in frames if frame["type"] == "message"] == ["Bye!"]


@in_virtual_time
async def test_the_page_shows_the_agents_name_and_later_its_new_name() -> None:
    async with page(named) as app, Visit(app) as visit:
        assert (await visit.hello())["agent"] == "Ravestate"  # no rule has named the agent yet
        assert await visit.next() == {"type": "renamed", "agent": "Robin"}
        visit.say("Elske", id="a")
        frames = [await visit.next() for _ in range(3)]
        assert {"type": "renamed", "agent": "Elske"} in frames
        assert [frame["text"] for frame in frames if frame["type"] == "message"] == ["Elske", "So be it."]
        async with Visit(app) as again:
            assert (await again.hello(session=visit.session, last=2))["agent"] == "Elske"
            visit.tell("bye")
            assert (await again.next())[
                "type"
            ] == "ended"  # no frame `renamed` comes before it, because the welcome had the name
        async with Visit(app) as other:
            await other.hello()
            # Another conversation has its own name for the agent.
            assert await other.next() == {"type": "renamed", "agent": "Robin"}


@in_virtual_time
async def test_a_name_that_the_agent_gets_later_is_shown_as_plain_text() -> None:
    async with page(late) as app, Visit(app) as visit:
        assert (await visit.hello())["agent"] == "Ravestate"
        assert await visit.next() == {"type": "renamed", "agent": "Robin"}
        assert now() == 3.0


@pytest.mark.parametrize(
    ("name", "shown"),
    [
        ("", "Ravestate"),
        (" \n\x07", "Ravestate"),
        ("Ro\n\n\u2028bin\t the  2nd", "Ro bin the 2nd"),
        ("Ro\u202ebin\u2066", "Robin"),
        ("Ro\ud800bin", "Ro\ufffdbin"),
        ("\u200b\ufeff", "Ravestate"),
        ("x" * 100_000, "x" * 80),
        ("\U0001f469\u200d\U0001f680 Valentina", "\U0001f469\u200d\U0001f680 Valentina"),
    ],
)
def test_any_name_of_the_agent_is_shown_in_a_readable_form(name: str, shown: str) -> None:
    @in_virtual_time
    async def test() -> None:
        async with page(parrot) as app, Visit(app) as visit:
            await visit.hello()
            await visit.messages(1)
            (session,) = app.state.sessions
            session.context.put(interloc.agent, "Elske")
            assert await visit.next() == {"type": "renamed", "agent": "Elske"}
            session.context.put(interloc.agent, name)
            assert await visit.next() == {"type": "renamed", "agent": shown}
            async with Visit(app) as window:
                assert (await window.hello(session=visit.session))["agent"] == shown

    test()


@in_virtual_time
async def test_the_setting_title_overrides_the_agents_own_name() -> None:
    async with page(named, title="Ravestate") as app, Visit(app) as visit:
        assert (await visit.hello())["agent"] == "Ravestate"
        visit.say("Elske", id="a")
        frames = [await visit.next() for _ in range(2)]
        assert [frame["type"] for frame in frames] == ["message", "message"]
        visit.tell("bye")
        assert (await visit.next())["type"] == "ended"


@in_virtual_time
async def test_after_bye_the_page_says_you_left_and_the_log_says_the_visitor_left() -> None:
    async with page(parrot) as app, Visit(app) as visit, Visit(app) as window:
        await visit.hello()
        await window.hello(session=visit.session)
        (session,) = app.state.sessions
        visit.tell("bye")
        for own in (visit, window):
            assert (await own.frames("ended"))[-1]["text"] == "you left"
        assert session.ended is Ending.BYE
        assert str(session.ended) == "the visitor left"


@pytest.mark.parametrize("ending", [ending for ending in Ending if ending is not Ending.BYE])
def test_for_each_other_ending_the_page_and_the_log_give_the_same_reason(
    ending: Ending,
) -> None:
    assert ending.for_visitor == str(ending)
