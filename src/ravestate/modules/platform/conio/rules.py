"""The rules of the console: read lines, print utterances, print pieces while an utterance grows."""

from __future__ import annotations

import asyncio
import contextlib
import sys

import ravestate as rs
from ravestate.errors import PlatformError
from ravestate.modules import interloc, rawio

from .console import Console, history_file, is_terminal, prepare
from .log_file import log_file, log_to_file
from .names import module, screen
from .pipes import Pipes

USER = "conio"
"""The key of the user at the console, among the users present."""


@module.rule(
    when=rs.startup.detached(),  # so that it does not block slots for other platforms
    writes=(screen, rawio.input, interloc.users),
    emits=rawio.typing,
    detached=True,  # each line is a separate cause
    background=True,
)
async def listen(ctx: rs.RuleContext) -> None:
    """Write each typed line to the input; end the agent after the last line."""
    await asyncio.to_thread(prepare)
    history = history_file() if ctx.settings.history else None

    def tell() -> None:
        ctx.emit(rawio.typing)

    try:
        # This runs off the loop, because it takes long while other threads load models.
        plain = Pipes(sys.stdin, sys.stdout) if ctx.settings.plain else None
        console = await asyncio.to_thread(
            Console, screen=plain, prompt=ctx.settings.prompt, history=history, on_key=tell
        )
    except PlatformError as error:
        ctx.stop(error)  # otherwise the agent would keep running, and nobody could talk to it
        return
    async with contextlib.AsyncExitStack() as stack:
        stack.enter_context(log_to_file(log_file()))
        await stack.enter_async_context(console)
        ctx[screen] = console
        if is_terminal(sys.stdin, sys.stdout):
            console.write("Ctrl-D ends the conversation.")
        ctx[interloc.users].add(USER, ctx.settings.name)
        try:
            async for line in console:
                if line.strip():
                    ctx[rawio.input] = line
                if not console.interactive:
                    await ctx.quiet()  # all lines may arrive at once, and each needs its own answer
            if console.ending == "end of input":
                await ctx.quiet()  # a user who leaves normally hears the answer
            else:
                ctx.wipe(rawio.input.changed)  # a user who interrupts does not
            ctx[interloc.users].remove(USER)
            await ctx.quiet()  # the farewell
        finally:
            ctx[screen] = None
            ctx.stop(console.failure)


@module.rule(when=rawio.output.changed.max_age(None).detached(), reads=screen)
async def show(ctx: rs.RuleContext) -> None:
    """Print each utterance."""
    console = ctx[screen]
    if console is not None:
        console.write(ctx.payload(rawio.output.changed))


@module.rule(when=rawio.piece.max_age(None).detached(), reads=screen, background=True)
async def show_piece(ctx: rs.RuleContext) -> None:
    """Print the pieces of the utterance that is being made."""
    console = ctx[screen]
    if console is not None:
        console.stream(ctx.payload(rawio.piece))


@module.rule(when=rawio.speaking.false.max_age(None).detached(), reads=screen, background=True)
async def end_line(ctx: rs.RuleContext) -> None:
    """End the line of pieces, even if they never became an utterance."""
    console = ctx[screen]
    if console is not None:
        console.end()
