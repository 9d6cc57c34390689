"""``ravestate board``: an agent on a web page beside its debugger, or a recorded trace without an agent."""

from __future__ import annotations

import argparse
import asyncio
from pathlib import Path
from typing import TYPE_CHECKING

from ravestate.cli import agent as agents
from ravestate.cli import browser, complete
from ravestate.errors import PlatformError, UsageError

if TYPE_CHECKING:
    from starlette.routing import BaseRoute

    from ravestate.runtime.agent import Agent


def add_arguments(parser: argparse.ArgumentParser) -> None:
    agents.add_arguments(parser)
    complete.add_arguments(parser)
    complete.explain_memory(parser)
    parser.add_argument(
        "--open", dest="recording", metavar="TRACE.json", help="look at a recorded trace instead of an agent"
    )
    browser.add_argument(parser)


def run(options: argparse.Namespace) -> int:
    from ravestate.modules import webio

    named = bool(options.modules or options.file)
    if options.without and (named or options.recording):
        raise UsageError("--without works only on the complete agent: name no MODULE or file with it")
    if options.recording and named:
        raise UsageError("--open shows a recording, which has no agent: leave the modules out")
    try:
        from ravestate.board.application import INSIDE, RecordedAgent, routes
        from ravestate.board.trace_file import open_trace
    except ModuleNotFoundError as error:
        raise PlatformError(f"the board needs {error.name}: pip install 'ravestate[web]'") from error
    recording = open_trace(Path(options.recording)) if options.recording else None
    talks = recording is None
    chosen = agents.load_agent(options, ["webio", *(complete.names(options, page=True) if talks and not named else ())])
    if talks and not named:
        complete.leave_out_absent(chosen, options.command)
    if talks and (offer := complete.choose_small_talk(chosen, options.command)):
        chosen.settings.setdefault("webio", {}).setdefault("note", offer)
    made = RecordedAgent(*chosen.modules, **chosen.options())
    title = getattr(made.settings[webio.module.name], "title", None)
    beside = routes(made.recorders, recording, title)
    asyncio.run(_serve(made, beside, INSIDE, talks, options.browser))
    return 0


async def _serve(made: Agent, beside: list[BaseRoute], inside: str, talks: bool, opens: bool | None) -> None:
    from ravestate.modules.platform.webio.server import Server
    from ravestate.runtime.run import asked_by_signals, until_first_ends

    stopped = asyncio.Event()
    with asked_by_signals(stopped.set):
        async with Server(made, beside, inside) as server:
            server.announce({"agent": "", "board": inside} if talks else {"board": inside})
            await browser.open_page(server.link("" if talks else inside), opens)
            await until_first_ends(stopped.wait(), server.until_failed())
