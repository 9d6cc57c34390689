"""Agents for the tests of the bridges."""

import asyncio

import ravestate as rs
from ravestate.errors import PlatformError
from ravestate.modules import interloc, rawio

echo = rs.Module("echo", requires=[rawio])


@echo.rule(when=rawio.input.changed, writes=rawio.output)
async def repeat(ctx: rs.RuleContext) -> None:
    ctx[rawio.output] = f"You said {ctx.payload(rawio.input.changed)}"


silent = rs.Module("silent", requires=[rawio])


@silent.rule(when=rawio.input.changed, writes=rawio.output)
async def resign(ctx: rs.RuleContext) -> rs.Resign:
    return rs.Resign("there is nothing to say")


talker = rs.Module("talker", requires=[rawio])


@talker.rule(
    when=rawio.input.changed,
    writes=(rawio.output, rawio.speaking),
    emits=rawio.piece,
    until=rawio.input.changed,
)
async def talk(ctx: rs.RuleContext) -> None:
    """Say three pieces. If the user said "wait", hang after the second piece until the rule is cancelled."""
    said = ""
    ctx[rawio.speaking] = True
    try:
        for piece in ("One, ", "two, ", "three."):
            ctx.emit(rawio.piece, piece)
            said += piece
            if ctx.payload(rawio.input.changed) == "wait" and piece == "two, ":
                await asyncio.Event().wait()
        ctx[rawio.output] = said
    except asyncio.CancelledError:
        ctx[rawio.output] = said + "…"
        raise
    finally:
        ctx[rawio.speaking] = False


listener = rs.Module("listener", requires=[rawio])
captions = listener.slot("captions", "")
noticed = listener.slot("noticed", 0)


@listener.rule(when=rawio.input.changed, reads=(rawio.heard, captions, noticed), writes=rawio.output)
async def tell(ctx: rs.RuleContext) -> None:
    """Say what the user has heard, the newest caption of their speech, and the number of `typing` signals."""
    ctx[rawio.output] = f"heard {ctx[rawio.heard]!r}, captions {ctx[captions]!r}, speech {ctx[noticed]}"


@listener.rule(when=rawio.hearing.detached(), writes=captions)
async def follow(ctx: rs.RuleContext) -> None:
    ctx[captions] = ctx.payload(rawio.hearing)


@listener.rule(when=rawio.typing.detached(), writes=noticed)
async def notice(ctx: rs.RuleContext) -> None:
    ctx[noticed] += 1


interrupted = rs.Module("interrupted", requires=[talker])


@interrupted.rule(when=rawio.input.changed.where("what did I hear?".__eq__), reads=rawio.heard, writes=rawio.output)
async def remember(ctx: rs.RuleContext) -> None:
    ctx[rawio.output] = f"You heard {ctx[rawio.heard]!r}"


counter = rs.Module("counter", requires=[rawio])


@counter.rule(when=rawio.input.changed, reads=rawio.heard, writes=rawio.output)
async def count(ctx: rs.RuleContext) -> None:
    """Count in three sentences; if the user asks "what did I hear?", say what they heard."""
    asked = ctx.payload(rawio.input.changed) == "what did I hear?"
    ctx[rawio.output] = f"You heard {ctx[rawio.heard]}" if asked else "One. Two. Three."


two_part = rs.Module("two_part", requires=[rawio])


@two_part.rule(when=rawio.input.changed.detached(), writes=rawio.output)
async def stall(ctx: rs.RuleContext) -> None:
    ctx[rawio.output] = "Let me think."


@two_part.rule(when=rawio.input.changed, writes=rawio.output)
async def reply(ctx: rs.RuleContext) -> None:
    await ctx.sleep(0.01)
    ctx[rawio.output] = "It is Lima."


broken = rs.Module("broken", requires=[rawio])


@broken.rule(when=rawio.input.changed, writes=rawio.output, emits=rawio.piece)
async def fail(ctx: rs.RuleContext) -> None:
    """Fail immediately; if the user said "go on", fail in the middle of an utterance."""
    if ctx.payload(rawio.input.changed) == "go on":
        ctx.emit(rawio.piece, "I know that")
    raise PlatformError("the library is closed")


hopeless = rs.Module("hopeless", requires=[rawio])


@hopeless.rule(when=rawio.input.changed, writes=rawio.output)
async def give_up(ctx: rs.RuleContext) -> None:
    ctx.stop(PlatformError("the library has burnt down"))


leaver = rs.Module("leaver", requires=[rawio])


@leaver.rule(when=rs.startup, writes=rawio.output)
async def leave(ctx: rs.RuleContext) -> None:
    """Speak first, and end the conversation."""
    await ctx.sleep(0.01)
    ctx[rawio.output] = "I have to go."
    ctx.stop()


host = rs.Module("host", requires=[rawio, interloc])


@host.rule(when=interloc.users.added, writes=rawio.output)
async def greet(ctx: rs.RuleContext) -> None:
    ctx[rawio.output] = "Welcome!"


@host.rule(when=interloc.users.removed, writes=rawio.output)
async def see_off(ctx: rs.RuleContext) -> None:
    ctx[rawio.output] = "Goodbye!"
