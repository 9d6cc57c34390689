"""The page shows messages, utterances as they grow, and whether the agent is thinking."""

import asyncio

import ravestate as rs
from modules.platform.webio.visit import Visit, in_virtual_time, page
from ravestate.modules import fillers, rawio, webio
from ravestate.testing import simulate

slow = rs.Module("slow", requires=(rawio,))


@slow.rule(when=rawio.input.changed, writes=rawio.output)
async def ponder(ctx: rs.RuleContext) -> None:
    await ctx.sleep(float(ctx.payload(rawio.input.changed)))
    ctx[rawio.output] = "done"


speaker = rs.Module("speaker", requires=(rawio,))


@speaker.rule(when=rawio.input.changed, writes=(rawio.output, rawio.speaking), emits=rawio.piece)
async def speak(ctx: rs.RuleContext) -> None:
    """Emit the parts of the input before the `/` as pieces, one per second. Then write the text after the `/`."""
    words, _, whole = ctx.payload(rawio.input.changed).partition("/")
    ctx[rawio.speaking] = True
    for word in words.split("|"):
        ctx.emit(rawio.piece, word)
        await ctx.sleep(1.0)
    if whole:
        ctx[rawio.output] = whole
    ctx[rawio.speaking] = False


doubter = rs.Module("doubter", requires=(rawio,))
asked = doubter.signal("asked")


@doubter.rule(when=rawio.input.changed, emits=asked)
async def wonder(ctx: rs.RuleContext) -> None:
    await ctx.sleep(2.0)


@doubter.rule(when=asked, writes=rawio.output)
async def answer(ctx: rs.RuleContext) -> None:
    ctx[rawio.output] = "an answer"


@doubter.rule(when=rawio.input.changed, writes=rawio.output)
async def chat(ctx: rs.RuleContext) -> None:
    await ctx.sleep(1.0)
    ctx[rawio.output] = "small talk"


@in_virtual_time
async def test_the_page_does_not_show_a_quick_agent_as_thinking() -> None:
    async with page(slow) as app, Visit(app) as visit:
        await visit.hello()
        visit.say("0.2")
        frames = [await visit.next() for _ in range(2)]
        assert [(f["type"], f["text"]) for f in frames] == [("message", "0.2"), ("message", "done")]
        visit.tell("ping")
        assert (await visit.next())["type"] == "pong"


@in_virtual_time
async def test_the_page_shows_a_slower_agent_as_thinking_until_the_answer() -> None:
    async with page(slow) as app, Visit(app) as visit:
        await visit.hello()
        visit.say("2.0")
        assert (await visit.next())["text"] == "2.0"
        assert await visit.next() == {"type": "typing", "on": True}
        assert asyncio.get_running_loop().time() == 0.3
        assert (await visit.next())["text"] == "done"
        assert await visit.next() == {"type": "typing", "on": False}
        assert asyncio.get_running_loop().time() == 2.0


@in_virtual_time
async def test_after_a_filler_the_page_still_shows_the_agent_as_thinking() -> None:
    async with page(doubter, fillers) as app, Visit(app) as visit:
        await visit.hello()
        visit.say("who?")
        kinds = [(f["type"], f.get("on", f.get("text"))) for f in [await visit.next() for _ in range(5)]]
        assert kinds[:2] == [("message", "who?"), ("typing", True)]
        filler, answered, over = kinds[2:]
        assert filler[0] == "message"
        assert answered == ("message", "small talk")
        assert over == ("typing", False)
        assert asyncio.get_running_loop().time() == 3.0


thinker = rs.Module("thinker", requires=(rawio,))


@thinker.rule(when=rawio.input.changed, writes=rawio.output)
async def think(ctx: rs.RuleContext) -> None:
    await ctx.sleep(9.0)
    ctx[rawio.output] = "forty-two"


@thinker.rule(when=rawio.output.changed.detached(), emits=rawio.typing)
async def take_note(ctx: rs.RuleContext) -> None:
    """Do other work after each output."""
    await ctx.sleep(60.0)


@in_virtual_time
async def test_several_fillers_do_not_interrupt_the_display_of_thinking() -> None:
    async with page(thinker, fillers) as app, Visit(app) as visit:
        await visit.hello()
        visit.say("why?")
        frames = await visit.frames("typing")
        said: list[str] = []
        while "forty-two" not in said:
            frames.append(frame := await visit.next())
            if frame["type"] == "message":
                said.append(frame["text"])
        assert len(said) > 1
        assert [frame["on"] for frame in frames if frame["type"] == "typing"] == [True]
        assert await visit.next() == {"type": "typing", "on": False}
        assert asyncio.get_running_loop().time() == 9.0


@in_virtual_time
async def test_the_page_shows_that_the_clock_pauses_and_resumes() -> None:
    async with page(slow) as app, Visit(app) as visit:
        await visit.hello()
        (session,) = app.state.sessions
        session.context.pause()
        session.notify()
        assert await visit.next() == {"type": "paused", "on": True}
        async with Visit(app) as window:
            await window.hello(session=visit.session)
            assert await window.next() == {"type": "paused", "on": True}
        session.context.resume()
        session.notify()
        assert await visit.next() == {"type": "paused", "on": False}


@in_virtual_time
async def test_an_utterance_is_shown_as_it_grows() -> None:
    async with page(speaker) as app, Visit(app) as visit:
        await visit.hello()
        visit.say("Ve🙂r|meer |did./Ve🙂rmeer did it.")
        frames = (await visit.frames("message"))[1:] + await visit.frames("message")
        assert frames == [
            {"type": "piece", "at": 0, "text": "Ve🙂r"},
            {"type": "piece", "at": 5, "text": "meer "},  # positions count UTF-16 units
            {"type": "piece", "at": 10, "text": "did."},
            frames[-1],
        ]
        assert frames[-1]["text"] == "Ve🙂rmeer did it."


@in_virtual_time
async def test_pieces_without_an_utterance_become_a_message() -> None:
    async with page(speaker) as app, Visit(app) as visit:
        await visit.hello()
        visit.say("I, |I")
        assert await visit.messages(2) == ["user: I, |I", "agent: I, I"]


@in_virtual_time
async def test_a_window_that_opens_during_an_utterance_shows_its_beginning() -> None:
    async with page(speaker) as app, Visit(app) as visit:
        await visit.hello()
        visit.say("one |two/one two")
        assert (await visit.frames("piece"))[-1]["text"] == "one "
        async with Visit(app) as second:
            assert (await second.hello(session=visit.session, last=1))["resumed"]
            assert await second.next() == {"type": "piece", "at": 0, "text": "one "}
            assert await second.next() == {"type": "piece", "at": 4, "text": "two"}
            assert (await second.next())["text"] == "one two"


@in_virtual_time
async def test_control_characters_are_not_shown() -> None:
    async with page() as app, Visit(app) as visit:
        await visit.hello()
        await visit.messages(1)
        visit.say("a\x1b[2Jb\x07", id="a")
        assert await visit.messages(2) == ["user: ab", "agent: ab"]


def test_without_a_page_the_module_does_nothing() -> None:
    with simulate(webio, doubter, fillers) as sim:
        sim.say("who?")
        sim.advance(10.0)
        assert sim.said[-1] == "small talk"
        assert not any(name.startswith("core:error") for name in sim.fired)
