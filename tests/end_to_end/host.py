"""Modules for the agents in the browser tests."""

import asyncio

import ravestate as rs
from ravestate.modules import interloc, rawio

host = rs.Module("host", requires=(rawio, interloc))


@host.rule(when=interloc.users.added, writes=rawio.output)
async def greet(ctx: rs.RuleContext) -> None:
    ctx[rawio.output] = "Good evening."


@host.rule(when=interloc.users.removed, writes=rawio.output)
async def bid_farewell(ctx: rs.RuleContext) -> None:
    ctx[rawio.output] = "Until next time!"


@host.rule(when=rawio.input.changed, writes=rawio.output)
async def repeat(ctx: rs.RuleContext) -> None:
    ctx[rawio.output] = f"You said: {ctx.payload(rawio.input.changed)}"


watcher = rs.Module("watcher", requires=(rawio,))


@watcher.rule(when=rawio.typing, writes=rawio.output)
async def notice(ctx: rs.RuleContext) -> None:
    ctx[rawio.output] = "You are writing."


namesake = rs.Module("namesake", requires=(rawio, interloc))


@namesake.rule(when=rawio.input.changed.where(lambda text: text.startswith("I call you ")), writes=interloc.agent)
async def be_called(ctx: rs.RuleContext) -> None:
    ctx[interloc.agent] = ctx.payload(rawio.input.changed).removeprefix("I call you ")


storyteller = rs.Module("storyteller", requires=(rawio,))


class Cue:
    """Two events for which `tell` waits. The test sets them on the same loop."""

    thought = asyncio.Event()
    told = asyncio.Event()


@storyteller.rule(
    when=rawio.input.changed.where(lambda text: "story" in text),
    writes=(rawio.output, rawio.speaking),
    emits=rawio.piece,
)
async def tell(ctx: rs.RuleContext) -> None:
    """Think, and then tell the story in two pieces. Before each piece, wait for the test."""
    await Cue.thought.wait()
    ctx[rawio.speaking] = True
    ctx.emit(rawio.piece, "Once upon a time ")
    await Cue.told.wait()
    ctx[rawio.output] = "Once upon a time there was a raven."
    ctx[rawio.speaking] = False
