"""The rules of the console: they read lines, and print the agent's words."""

from __future__ import annotations

import asyncio
import contextlib
import sys

import ravestate as rs
from ravestate.errors import PlatformError
from ravestate.language.loading import expect_prompt, note_prompt
from ravestate.modules import interloc, rawio

from .console import Console, history_file, is_terminal, prepare
from .log_file import log_file, log_to_file
from .names import module, screen
from .pipes import Pipes

USER = "conio"  # the key of the user at the console in ``interloc.users``


@module.rule(
    when=rs.startup.detached(),  # detached, so that other platforms may also write these slots at startup
    writes=(screen, rawio.input, interloc.users),
    emits=rawio.typing,
    detached=True,  # each line is a separate cause
    background=True,
)
async def listen(ctx: rs.RuleContext) -> None:
    """Write each typed line that is not blank to ``rawio.input``; end the agent after the last line."""
    expect_prompt()  # so that models load only after the prompt is on the screen
    try:
        await serve(ctx)
    finally:
        note_prompt()


async def serve(ctx: rs.RuleContext) -> None:
    """Read lines until the input ends, the user interrupts, or the output is gone. Then stop the agent."""
    await asyncio.to_thread(prepare)
    history = history_file() if ctx.settings.history else None

    def tell() -> None:
        ctx.emit(rawio.typing)

    try:
        plain = Pipes(sys.stdin, sys.stdout) if ctx.settings.plain else None
        console = await asyncio.to_thread(
            Console, screen=plain, prompt=ctx.settings.prompt, history=history, on_key=tell
        )
    except PlatformError as error:
        ctx.stop(error)  # otherwise the agent would keep running, although nobody can talk to it
        return
    async with contextlib.AsyncExitStack() as stack:
        stack.enter_context(log_to_file(log_file()))
        await stack.enter_async_context(console)
        ctx[screen] = console
        if is_terminal(sys.stdin, sys.stdout):
            console.utter("Ctrl-D ends the conversation.")
        ctx[interloc.users].add(USER, ctx.settings.name)
        # `note_prompt` runs when `async for` first waits for a line. By then, the prompt is on the screen.
        asyncio.get_running_loop().call_soon(note_prompt)
        try:
            async for line in console:
                if line.strip():
                    ctx[rawio.input] = line
                if not console.interactive:
                    await ctx.quiet()  # wait for this line's answer: through a pipe, all lines may arrive together
            if console.ending == "end of input":
                await ctx.quiet()  # a user who ends the input still gets the last answer
            else:
                ctx.wipe(rawio.input.changed)  # a user who interrupts gets no answer
            ctx[interloc.users].remove(USER)
            await ctx.quiet()  # wait for the farewell
        finally:
            ctx[screen] = None
            ctx.stop(console.failure)


rawio.carry(module, screen)
