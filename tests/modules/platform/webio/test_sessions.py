"""Conversations are separate, can be resumed, are kept for a while, end cleanly, and are limited in number."""

import asyncio
import logging

import pytest

import ravestate as rs
from modules.platform.webio.visit import Visit, in_virtual_time, page, parrot, past
from ravestate.modules import interloc, rawio
from ravestate.modules.platform.webio import sessions

chronicle: list[str] = []
keeper = rs.Module("keeper", requires=(rawio, interloc))


@keeper.rule(when=interloc.users.added)
async def note_who_comes(ctx: rs.RuleContext) -> None:
    chronicle.append(f"+{ctx.payload(interloc.users.added).item}")


@keeper.rule(when=interloc.users.removed)
async def note_who_goes(ctx: rs.RuleContext) -> None:
    chronicle.append(f"-{ctx.payload(interloc.users.removed).item}")


@keeper.rule(when=rs.shutdown)
async def note_the_end(ctx: rs.RuleContext) -> None:
    await ctx.sleep(0.5)
    chronicle.append("end")


quitter = rs.Module("quitter", requires=(rawio,))


@quitter.rule(when=rawio.input.changed, writes=rawio.output)
async def quit_or_fail(ctx: rs.RuleContext) -> None:
    if ctx.payload(rawio.input.changed) == "fail":
        ctx.stop(rs.PlatformError("the robot has fallen over"))
    else:
        ctx[rawio.output] = "I go."
        ctx.stop()


@pytest.fixture(autouse=True)
def _new_chronicle() -> None:
    chronicle.clear()


@in_virtual_time
async def test_two_visitors_have_separate_conversations() -> None:
    async with page() as app, Visit(app) as ada, Visit(app) as bob:
        await ada.hello(name="Ada")
        await bob.hello(name="Bob")
        assert ada.session != bob.session
        assert await ada.messages(1) == ["agent: Hello Ada!"]
        assert await bob.messages(1) == ["agent: Hello Bob!"]
        ada.say("I am Ada")
        bob.say("I am Bob")
        assert await ada.messages(2) == ["user: I am Ada", "agent: I am Ada"]
        assert await bob.messages(2) == ["user: I am Bob", "agent: I am Bob"]
        assert ada.nothing_more()
        assert bob.nothing_more()


@in_virtual_time
async def test_after_a_lost_connection_each_message_arrives_exactly_once() -> None:
    async with page() as app:
        async with Visit(app) as first:
            await first.hello()
            await first.messages(1)
            first.say("one")
            assert await first.messages(2) == ["user: one", "agent: one"]
            first.say("two")
        async with Visit(app) as second:
            welcome = await second.hello(session=first.session, last=3)
            assert (welcome["resumed"], welcome["session"], welcome["first"]) == (True, first.session, 1)
            assert await second.messages(2) == ["user: two", "agent: two"]
        async with Visit(app) as third:
            await third.hello(session=first.session)
            frames = [await third.next() for _ in range(5)]
            assert [frame["n"] for frame in frames] == [1, 2, 3, 4, 5]
            assert third.nothing_more()


@in_virtual_time
async def test_a_text_that_is_sent_twice_is_heard_only_once() -> None:
    async with page() as app, Visit(app) as visit:
        await visit.hello()
        visit.say("one", id="a")
        visit.say("one", id="a")
        await visit.messages(3)
        async with Visit(app) as again:
            await again.hello(session=visit.session, last=3)
            again.say("one", id="a")
            again.say("two", id="b")
            assert await again.messages(2) == ["user: two", "agent: two"]


@in_virtual_time
async def test_the_method_hear_returns_whether_the_conversation_accepts_the_text() -> None:
    async with page() as app, Visit(app) as visit:
        await visit.hello()
        await visit.messages(1)
        (session,) = app.state.sessions
        assert session.hear("a", "one")
        assert session.hear("a", "one")  # the same text again is accepted, too
        assert not session.leaving
        visit.tell("bye")
        await visit.frames("ended")
        assert session.leaving
        assert not session.hear("b", "two")
        assert not session.hear("a", "one")
        assert [message.text for message in session.history.since(0)] == ["Hello!", "one", "one", "Bye!"]


@in_virtual_time
async def test_all_windows_of_a_visitor_show_the_same_messages() -> None:
    async with page() as app, Visit(app) as one, Visit(app) as other:
        await one.hello()
        await other.hello(session=one.session)
        one.say("hello", id="a")
        assert await one.messages(3) == await other.messages(3)


@in_virtual_time
async def test_a_client_cannot_choose_the_id_of_a_new_conversation() -> None:
    async with page() as app, Visit(app) as visit:
        welcome = await visit.hello(session="chosen-by-the-client", last=7)
        assert not welcome["resumed"]
        assert welcome["session"] != "chosen-by-the-client"
        assert await visit.messages(1) == ["agent: Hello!"]


@in_virtual_time
async def test_a_client_that_claims_a_message_number_from_the_future_gets_all_messages() -> None:
    async with page() as app, Visit(app) as visit:
        await visit.hello()
        await visit.messages(1)
        async with Visit(app) as again:
            await again.hello(session=visit.session, last=99)
            assert await again.messages(1) == ["agent: Hello!"]


@in_virtual_time
async def test_a_conversation_is_kept_for_a_while_and_then_ends_cleanly() -> None:
    async with page(keeper, keep=60.0) as app:
        async with Visit(app) as visit:
            await visit.hello(name="Ada")
            visit.tell("ping")
            await visit.next()
        await past(59.0)
        async with Visit(app) as again:
            assert (await again.hello(session=visit.session))["resumed"]
            await past(100.0)
            assert chronicle == ["+Ada"]  # the conversation is kept, because a window is open
        await past(59.9)
        assert chronicle == ["+Ada"]
        await past(1.0)
        assert chronicle == ["+Ada", "-Ada", "end"]
        assert len(app.state.sessions) == 0
        async with Visit(app) as late:
            assert not (await late.hello(session=visit.session))["resumed"]


@in_virtual_time
async def test_a_visitor_who_leaves_gets_the_farewell_of_the_agent() -> None:
    async with page(parrot, keeper) as app, Visit(app) as visit:
        await visit.hello()
        visit.tell("bye")
        assert [frame.get("text") for frame in await visit.frames("ended")] == ["Hello!", "Bye!", "you left"]
        assert (await visit.next())["type"] == "websocket.close"
        assert visit.closed == 1000
        assert chronicle == ["+None", "-None", "end"]
        async with Visit(app) as again:
            assert not (await again.hello(session=visit.session))["resumed"]


@in_virtual_time
async def test_all_visitors_get_a_message_when_the_server_closes() -> None:
    async with page() as app, Visit(app) as one, Visit(app) as other:
        await one.hello()
        await other.hello()
        await app.state.sessions.close()
        for visit in (one, other):
            assert (await visit.frames("ended"))[-1]["text"] == "the agent has been switched off"
        async with Visit(app) as late:
            assert (await late.hello())["code"] == "closing"
            await late.next()
            assert late.closed == 1001


@in_virtual_time
async def test_an_agent_that_leaves_ends_only_its_own_conversation() -> None:
    async with page(quitter) as app, Visit(app) as one, Visit(app) as other:
        await one.hello()
        await other.hello()
        one.say("go")
        assert [f.get("text") for f in await one.frames("ended")] == ["go", "I go.", "the agent has left"]
        other.say("go")
        assert (await other.next())["text"] == "go"


@in_virtual_time
async def test_a_text_sent_while_the_conversation_ends_leaves_no_task_behind() -> None:
    async with page(quitter) as app, Visit(app) as visit:
        await visit.hello()
        visit.say("go")
        for _ in range(10):
            visit.say("are you still there?")
        await visit.frames("ended")
        await visit.over()
    assert not [task for task in asyncio.all_tasks() if task is not asyncio.current_task()]


@in_virtual_time
async def test_the_failure_of_an_agent_ends_its_conversation_with_a_message(
    caplog: pytest.LogCaptureFixture,
) -> None:
    async with page(quitter) as app, Visit(app) as visit:
        await visit.hello()
        with caplog.at_level(logging.ERROR):
            visit.say("fail")
            assert (await visit.frames("ended"))[-1]["text"] == "the agent has failed"
        assert "a conversation ended: the robot has fallen over" in caplog.text


@in_virtual_time
async def test_at_the_limit_the_abandoned_conversation_of_a_silent_visitor_ends_before_that_of_a_talker() -> None:
    async with page(sessions=3) as app, Visit(app) as present:
        await present.hello()
        async with Visit(app) as talker:
            await talker.hello()
            talker.say("hello")
            await talker.messages(3)
        async with Visit(app) as silent:
            await silent.hello()
        async with Visit(app) as fourth:
            assert (await fourth.hello())["type"] == "welcome"
            assert app.state.sessions.get(silent.session) is None
            async with Visit(app) as fifth:
                assert (await fifth.hello())["type"] == "welcome"
                assert app.state.sessions.get(talker.session) is None
                async with Visit(app) as sixth:
                    refused = await sixth.hello()
                    assert refused["text"] == "3 visitors are here already: try again later"
                    await sixth.next()
                    assert sixth.closed == 1013
        present.say("still here")
        assert await present.messages(3) == ["agent: Hello!", "user: still here", "agent: still here"]


@in_virtual_time
async def test_the_number_of_windows_of_a_conversation_is_limited() -> None:
    async with page() as app, Visit(app) as visit:
        await visit.hello()
        windows = [Visit(app) for _ in range(sessions.ONLOOKERS - 1)]
        for window in windows:
            await window.__aenter__()
            assert (await window.hello(session=visit.session))["resumed"]
        async with Visit(app) as one_more:
            assert (await one_more.hello(session=visit.session))["code"] == "full"
        for window in windows:
            await window.drop()


@in_virtual_time
async def test_conversations_that_have_ended_leave_no_sessions_and_no_tasks() -> None:
    async with page(keep=0.0) as app:
        for _ in range(5):
            async with Visit(app) as visit:
                await visit.hello()
                visit.say("hello")
                await visit.messages(3)
        await past(10.0)
        assert len(app.state.sessions) == 0
        assert not [task for task in asyncio.all_tasks() if task is not asyncio.current_task()]
