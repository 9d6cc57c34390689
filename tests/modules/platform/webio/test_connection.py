"""A connection follows the protocol, keeps its limits, and reacts to faulty clients."""

import asyncio
import json

import pytest

import ravestate as rs
from modules.platform.webio.visit import Visit, in_virtual_time, page, past
from ravestate.modules import rawio, webio
from ravestate.modules.platform.webio import channel, connection
from ravestate.modules.platform.webio.history import MESSAGES
from ravestate.runtime.agent import Agent

TOKEN = "open sesame, please"

flood = rs.Module("flood", requires=(rawio,))


@flood.rule(when=rawio.input.changed, writes=rawio.output)
async def talk_without_end(ctx: rs.RuleContext) -> None:
    for number in range(MESSAGES + 10):
        ctx[rawio.output] = f"{number}"


@in_virtual_time
async def test_a_silent_client_gets_an_error_and_its_connection_is_closed() -> None:
    async with page() as app, Visit(app) as visit:
        error = await visit.next()
        assert error["text"] == 'no hello within 10 s: begin with {"type": "hello", "v": 1}'
        await visit.next()
        assert (visit.closed, asyncio.get_running_loop().time()) == (4408, 10.0)
        assert len(app.state.sessions) == 0


@pytest.mark.parametrize(
    ("first", "said"),
    [
        ("GET / HTTP/1.1", "not JSON"),
        ('{"type": "say", "id": "a", "text": "hello"}', "begin with"),
        ('{"type": "hello"}', 'hello lacks "v"'),
        ('{"type": "hello", "v": 2}', "this side speaks version 1 only"),
        (b"\x00\x01", "not a binary one"),
        ("", "not JSON"),
        (f'{{"type": "say", "id": "a", "text": "{"x" * 10_001}"}}', "at most 10,000 characters"),
        ('{"type": "say", "id": "a", "text": " "}', "has nothing in it"),
    ],
)
def test_a_client_that_begins_without_hello_gets_an_error_and_its_connection_is_closed(
    first: str | bytes, said: str
) -> None:
    @in_virtual_time
    async def test() -> None:
        async with page() as app, Visit(app) as visit:
            visit.send(first)
            assert said in (await visit.next())["text"]
            await visit.next()
            assert visit.closed == 4400
            assert len(app.state.sessions) == 0

    test()


@in_virtual_time
async def test_a_later_bad_frame_gets_an_error_and_the_conversation_continues() -> None:
    async with page() as app, Visit(app) as visit:
        await visit.hello()
        await visit.messages(1)
        for bad in ("nonsense", '{"type": "say", "id": "a"}', '{"type": "hello", "v": 1}', b"\xff"):
            visit.send(bad)
            assert (await visit.next())["code"] == "malformed"
        visit.say("x" * 10_001)
        assert (await visit.next())["text"] == 'say: "text" has at most 10,000 characters, not 10,001'
        visit.say("  \n ")
        error = await visit.next()
        assert (error["code"], error["text"]) == ("empty", 'say: "text" has nothing in it')
        visit.say("hello")
        assert await visit.messages(2) == ["user: hello", "agent: hello"]


@in_virtual_time
async def test_the_error_for_a_refused_text_has_its_id() -> None:
    async with page() as app, Visit(app) as visit:
        await visit.hello()
        await visit.messages(1)
        for text, code in (("x" * 10_001, "too-long"), ("\x85\x00", "empty")):
            visit.say(text, id=f"it-is-{code}")
            error = await visit.next()
            assert (error["code"], error["id"]) == (code, f"it-is-{code}")


@in_virtual_time
async def test_the_longest_text_is_accepted_even_if_json_escapes_each_character() -> None:
    text = "\U0001f98a" * 10_000  # JSON writes each character as twelve bytes
    async with page() as app, Visit(app) as visit:
        await visit.hello()
        await visit.messages(1)
        visit.send(json.dumps({"type": "say", "id": "fox", "text": text}, ensure_ascii=True))
        assert await visit.messages(2) == [f"user: {text}", f"agent: {text}"]


@in_virtual_time
async def test_a_frame_that_is_too_long_ends_the_connection() -> None:
    async with page() as app, Visit(app) as visit:
        await visit.hello()
        await visit.messages(1)
        visit.say("x" * channel.LONGEST)
        assert (await visit.next())["code"] == "too-large"
        await visit.next()
        assert visit.closed == 1009


@in_virtual_time
async def test_a_client_that_sends_too_many_texts_is_slowed_down_and_loses_nothing() -> None:
    async with page() as app, Visit(app) as visit, Visit(app) as other:
        await visit.hello()
        await other.hello()
        for number in range(100):
            visit.say(f"{number}", id=f"{number}")
        answers = [text for text in await visit.messages(201) if text.startswith("agent")]
        assert answers == ["agent: Hello!", *(f"agent: {number}" for number in range(100))]
        assert asyncio.get_running_loop().time() == pytest.approx(79 / connection.RATE)


@in_virtual_time
async def test_frames_about_writing_do_not_count_for_the_limit_of_texts() -> None:
    async with page() as app, Visit(app) as visit:
        await visit.hello()
        for number in range(connection.BURST):
            visit.tell("writing")
            visit.say(f"{number}", id=f"{number}")
        await visit.messages(2 * connection.BURST + 1)
        assert asyncio.get_running_loop().time() == 0.0


@in_virtual_time
async def test_a_text_after_many_frames_about_writing_is_heard_immediately() -> None:
    async with page() as app, Visit(app) as visit:
        await visit.hello()
        await visit.messages(1)
        for _ in range(100):
            visit.tell("writing")
        visit.say("hello")
        assert await visit.messages(2) == ["user: hello", "agent: hello"]
        assert asyncio.get_running_loop().time() == 0.0


@in_virtual_time
async def test_frames_about_writing_are_ignored_above_a_limit() -> None:
    noticed = 0
    scribe = rs.Module("scribe", requires=(rawio,))

    @scribe.rule(when=rawio.typing)
    async def count(ctx: rs.RuleContext) -> None:
        nonlocal noticed
        noticed += 1

    async with page(scribe) as app, Visit(app) as visit:
        await visit.hello()
        for _ in range(100):
            visit.tell("writing")
        await past(1.0)
        assert noticed == connection.BURST
        before = noticed
        visit.tell("writing")
        await past(1.0)
        assert noticed == before + 1  # the ignored frames have used up no tokens


@in_virtual_time
async def test_a_client_that_sends_many_malformed_frames_is_slowed_down() -> None:
    async with page() as app, Visit(app) as visit:
        await visit.hello()
        await visit.messages(1)
        for _ in range(30):
            visit.send("nonsense")
        for _ in range(30):
            assert (await visit.next())["code"] == "malformed"
        assert asyncio.get_running_loop().time() == pytest.approx(9 / connection.RATE)


@in_virtual_time
async def test_a_client_that_does_not_read_the_replies_to_its_frames_is_dropped() -> None:
    async with page() as app, Visit(app) as visit:
        await visit.hello()
        visit.reading.clear()
        for _ in range(connection.REPLIES + 2):
            visit.tell("ping")
        await visit.over()
        assert app.state.sessions.get(visit.session).onlookers == set()


@in_virtual_time
async def test_a_client_that_reads_too_slowly_is_dropped_and_can_resume_later() -> None:
    async with page(flood) as app, Visit(app) as slow:
        await slow.hello()
        slow.reading.clear()
        slow.say("go")
        (session,) = app.state.sessions
        while session.history.last < MESSAGES + 11:  # this takes several turns of the loop
            await past(0.0)
        slow.reading.set()
        frames = await slow.frames("error")
        assert frames[-1]["code"] == "behind"
        await slow.next()
        assert slow.closed == 4409
        last = max((frame["n"] for frame in frames if frame["type"] == "message"), default=0)
        async with Visit(app) as again:
            welcome = await again.hello(session=slow.session, last=last)
            assert welcome["resumed"]
            assert welcome["first"] == 12
            frames = [await again.next() for _ in range(MESSAGES)]
            assert [frame["n"] for frame in frames] == list(range(12, MESSAGES + 12))


@in_virtual_time
async def test_a_client_sends_the_token_in_its_hello_or_in_a_header() -> None:
    async with page(token=TOKEN, host="0.0.0.0") as app:
        async with Visit(app) as visit:
            assert (await visit.hello(token=TOKEN))["type"] == "welcome"
        async with Visit(app, authorization=f"Bearer {TOKEN}") as visit:
            assert (await visit.hello())["type"] == "welcome"
        for wrong in ({}, {"token": "guess"}):
            async with Visit(app) as visit:
                assert (await visit.hello(**wrong))["code"] == "token"
                await visit.next()
                assert visit.closed == 4401


@in_virtual_time
async def test_a_foreign_origin_is_refused_before_the_websocket_opens() -> None:
    async with page() as app, Visit(app, origin="https://evil.example") as visit:
        start, body = await visit.next(), await visit.next()
        assert (visit.accepted, start["status"]) == (False, 403)
        assert b"'https://evil.example' may not connect" in body["body"]


@in_virtual_time
async def test_a_site_that_may_embed_the_page_may_connect() -> None:
    site = "https://museum.example"
    async with page(origins=(site,)) as app, Visit(app, origin=site) as visit:
        assert (await visit.hello())["type"] == "welcome"


@in_virtual_time
async def test_a_script_in_a_text_is_sent_as_plain_text() -> None:
    script = "</script><script>alert(1)</script>"
    async with page() as app, Visit(app) as visit:
        await visit.hello(name=script)
        assert await visit.messages(1) == [f"agent: Hello {script}!"]
        visit.say(script)
        assert await visit.messages(2) == [f"user: {script}", f"agent: {script}"]


def test_an_agent_without_the_module_has_no_page() -> None:
    with pytest.raises(rs.PlatformError, match=r"the agent has no webio: write Agent\(webio, \.\.\.\)"):
        webio.app(Agent(flood))


def test_an_agent_with_webio_and_conio_is_refused() -> None:
    from ravestate.modules import conio

    with pytest.raises(rs.PlatformError, match="webio has many users, conio has one: leave conio out"):
        webio.app(Agent(webio, conio))


def test_the_welcome_has_the_note_from_the_settings() -> None:
    @in_virtual_time
    async def test() -> None:
        async with page(note="Small talk without a language model.") as app, Visit(app) as visit:
            assert (await visit.hello())["note"] == "Small talk without a language model."


def test_the_server_sends_the_frames_that_the_reference_shows() -> None:
    @in_virtual_time
    async def test() -> None:
        async with page(title="Elske") as app, Visit(app) as visit:
            welcome = await visit.hello()
            assert welcome == {
                "type": "welcome",
                "v": 1,
                "session": visit.session,
                "resumed": False,
                "first": 1,
                "agent": "Elske",
                "last": 0,
                "writing": True,
                "suggestions": ["Hello!", "Who are you?", "What can you do?"],
            }
            hello = await visit.next()
            visit.say("hi", id="a1")
            heard, answer = [await visit.next() for _ in range(2)]
            assert json.dumps([{**f, "time": 0} for f in (hello, heard, answer)]) == json.dumps(
                [
                    {"type": "message", "n": 1, "from": "agent", "text": "Hello!", "time": 0},
                    {"type": "message", "n": 2, "from": "user", "text": "hi", "time": 0, "id": "a1"},
                    {"type": "message", "n": 3, "from": "agent", "text": "hi", "time": 0},
                ]
            )

    test()
