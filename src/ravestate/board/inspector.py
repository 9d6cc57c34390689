"""An inspector: one WebSocket between the board's page and a running conversation or a recording."""

from __future__ import annotations

import asyncio
import contextlib
from collections.abc import Sequence
from dataclasses import astuple
from time import perf_counter
from typing import TYPE_CHECKING

from starlette.websockets import WebSocket

from ravestate.board import protocol
from ravestate.board.recorder import Gap, IdleShare, Recorders
from ravestate.board.source import LiveSource, RecordedSource, Source
from ravestate.board.trace_file import Recordings
from ravestate.board.why_not import why_not
from ravestate.board.wire import data_of
from ravestate.draw.fold import fold
from ravestate.draw.graph import Diagram
from ravestate.draw.layout import lay_out
from ravestate.draw.text import label_size, node_size
from ravestate.errors import RavestateError
from ravestate.modules.platform.webio.channel import Bucket, Channel
from ravestate.modules.platform.webio.fields import ProtocolError
from ravestate.runtime.run import until_first_ends

if TYPE_CHECKING:
    from ravestate.modules.platform.webio.access import Access
    from ravestate.modules.platform.webio.session import Session
    from ravestate.modules.platform.webio.sessions import Sessions

# Seconds between two frames (messages) of records of a running conversation. An answer brings the next frame forward.
FRAME = 0.05

SHARE = 0.015
"""The share of the event loop's time that one inspector may use. After a slow frame, the inspector waits longer, to
keep to its share."""

OF_SPARE = 0.5  # the share of the process's idle time that one inspector may use in addition to `SHARE`
MOST = 800  # the maximum number of records in a frame; a longer frame would delay the agent
BACKLOG = 20_000  # the maximum number of past records that a new inspector gets

LAG = 25_000
"""An inspector may lag behind by this many records. If it lags further behind, the server skips to the newest
records."""

BURST, SPEED = 60, 30.0
"""The rate limit for a page's commands: `BURST` commands at once, and then `SPEED` commands per second."""

LISTED = 1.0  # check the list of conversations once in this many seconds
LIST = 100  # the maximum number of conversations in the list: the newest ones, and the one that the page shows
WORDS = 48  # the maximum number of characters of a visitor's last words in the list of conversations
REPLIES = 64  # the maximum number of answers that wait to be sent to one page

HELLO = f'{{"type": "hello", "v": {protocol.VERSION}}}'


class Inspector:
    """The server's side of the board's protocol, for one WebSocket that is not accepted yet.

    Without a `title`, the page shows the name that the agent gives itself.
    """

    def __init__(
        self,
        socket: WebSocket,
        access: Access,
        sessions: Sessions,
        recorders: Recorders,
        recordings: Recordings,
        title: str | None,
    ) -> None:
        self._channel = Channel(socket, REPLIES)
        self._access = access
        self._sessions = sessions
        self._recorders = recorders
        self._recordings = recordings
        self._title = title

    def wake(self) -> None:
        """Do nothing when the conversation changes, because the records show the change."""

    async def run(self) -> None:
        """Serve the page until either side closes the connection."""
        await self._channel.carry(self._serve)

    async def _serve(self) -> None:
        hello = await self._hello()
        session: Session | None = None
        recorded = self._recording(hello)
        if recorded is not None:
            source: Source = recorded
            title = recorded.title
        else:
            session = await self._session(hello)
            self._sessions.enter(session, self)
            source = LiveSource(session, self._recorders.of(session.context))
            title = self._title_of(session)
        try:
            if session is not None:
                await asyncio.sleep(0)  # let a new conversation begin
            seen = max(source.first - 1, source.last - BACKLOG)
            visitor = None if session is None else session.visitor
            whole = source.whole and seen == 0
            state = source.description, *source.clock()
            await self._send(protocol.Welcome(protocol.VERSION, title, source.live, visitor, whole, *state))
            await self._send(source.look())
            await until_first_ends(self._read(source), self._write(source, session, seen, title))
        finally:
            if session is not None:
                self._sessions.exit(session, self)
                if isinstance(source, LiveSource) and not any(isinstance(o, Inspector) for o in session.onlookers):
                    source.leave()

    async def _hello(self) -> protocol.Hello:
        text = await self._channel.first(HELLO)
        try:
            command = protocol.parse(text)
        except ValueError as error:
            raise ProtocolError("malformed", str(error)) from None
        if not isinstance(command, protocol.Hello):
            raise ProtocolError("malformed", f"begin with {HELLO}")
        if command.v != protocol.VERSION:
            raise ProtocolError("version", f'"v": {command.v}: this side speaks version {protocol.VERSION} only')
        await self._access.check_token(command.token)
        return command

    def _recording(self, hello: protocol.Hello) -> RecordedSource | None:
        if hello.session is not None or hello.visitor is not None:
            return None
        recording = self._recordings.get(hello.recording)
        if recording is None and hello.recording is not None:
            raise ProtocolError("gone", "the server no longer keeps this recording: open its file again")
        return None if recording is None else RecordedSource(recording)

    async def _session(self, hello: protocol.Hello) -> Session:
        if hello.session is not None:
            session = self._sessions.get(hello.session)
        elif hello.visitor is not None:
            session = next((s for s in self._sessions if s.visitor == hello.visitor), None)
        else:
            running = [session for session in self._sessions if not session.leaving]
            return running[-1] if running else await self._sessions.open()
        if session is None:
            raise ProtocolError("gone", "this conversation has ended")
        return session

    async def _read(self, source: Source) -> None:
        now = asyncio.get_running_loop().time
        bucket = Bucket(burst=BURST, rate=SPEED, now=now())
        while True:
            text = await self._channel.receive()
            wait = bucket.wait(now())
            if wait:
                await asyncio.sleep(wait)
            try:
                command = protocol.parse(text)
            except ValueError as error:
                self._reply(protocol.Error("malformed", str(error)))
                continue
            try:
                await self._take(command, source)
            except (RavestateError, LookupError, ValueError) as error:
                words = str(error.args[0]) if isinstance(error, LookupError) and error.args else str(error)
                self._reply(protocol.Error("refused", words, command.type))

    async def _take(self, command: protocol.ClientFrame, source: Source) -> None:
        match command:
            case protocol.Why():
                records = [r for r in source.since(source.first - 1, source.last) if not isinstance(r, Gap)]
                question = records, source.description, command.rule, command.spike, source.opens, source.whole
                found = await asyncio.to_thread(why_not, *question)
                self._reply(protocol.Answer(**protocol.fields_of(found)))
            case protocol.Unfold():
                diagram = source.description.diagram
                self._reply(await asyncio.to_thread(drawing, diagram, command.unfolded))
            case protocol.Explain():
                self._reply(source.explain(command.rule))
            case protocol.Look():
                self._reply(source.look())
            case protocol.Ping():
                self._reply(protocol.Pong())
            case protocol.Hello():
                raise ValueError("hello comes first, and only once")
            case _:
                await source.act(command)

    def _reply(self, frame: protocol.ServerFrame) -> None:
        self._channel.reply(protocol.serialise(frame))

    async def _write(self, source: Source, session: Session | None, seen: int, title: str) -> None:
        """Send answers to the page immediately. Send new records of a conversation about twenty times per second."""
        idle = IdleShare()
        stopped: bool | None = None  # whether the last frame said that the clock was stopped
        listed: protocol.Conversations | None = None
        now, listed_at = asyncio.get_running_loop().time, -LISTED
        while True:
            began = perf_counter()
            self._channel.woken.clear()
            await self._channel.send_replies()
            if isinstance(source, LiveSource) and source.renewed():
                await self._send(protocol.Changed(source.description))
            if session is not None and self._title_of(session) != title:
                title = self._title_of(session)
                await self._send(protocol.Renamed(title))
            if session is not None and now() - listed_at >= LISTED:
                listed_at = now()
                if (conversations := self._conversations(session)) != listed:
                    listed = conversations
                    await self._send(listed)
            missed = max(0, source.first - 1 - seen)
            if source.live and source.last - seen > LAG:
                missed = source.last - seen - MOST
            records = source.since(seen + missed, MOST)
            clock = source.clock()
            text = ""
            gap = False
            if records or missed or clock[1] != stopped:
                stopped = clock[1]
                seen += missed + len(records)
                gap = missed > 0 or any(isinstance(record, Gap) for record in records)
                data = [data_of(record) for record in records]
                text = protocol.serialise(protocol.Records(data, missed, source.last - seen, *clock))
            took = perf_counter() - began
            if text:
                await self._channel.send(text)
            if gap and source.live:
                await self._send(source.look())
            if session is not None and session.ended is not None and seen >= source.last:
                await self._send(protocol.Ended(session.ended))
                await self._channel.end()
                return
            seconds = max(FRAME, took / (SHARE + OF_SPARE * idle.share())) if text else FRAME
            await self._pause(seconds if source.live else 0.0, seen < source.last)

    async def _pause(self, seconds: float, more: bool) -> None:
        """Wait until the next frame is due, or until there is an answer to send."""
        if seconds == 0.0 and not more:
            await self._channel.woken.wait()
            return
        with contextlib.suppress(TimeoutError):
            async with asyncio.timeout(seconds):
                await self._channel.woken.wait()

    def _title_of(self, session: Session) -> str:
        return session.agent if self._title is None else self._title

    def _conversations(self, own: Session) -> protocol.Conversations:
        """Return the list of the newest conversations. The conversation that the page shows is always in it."""
        running = list(self._sessions)
        listed = running[-LIST:]
        if own in running[:-LIST]:
            listed[0] = own
        shown: list[protocol.Conversation] = []
        for session in listed:
            newest = session.history.newest("user")
            said = None if newest is None else newest.text[:WORDS]
            shown.append(protocol.Conversation(session.visitor, session.name, session.began, said))
        return protocol.Conversations(shown, len(running) - len(listed))

    async def _send(self, frame: protocol.ServerFrame) -> None:
        await self._channel.send(protocol.serialise(frame))


def drawing(diagram: Diagram, unfolded: Sequence[str]) -> protocol.Drawing:
    """Return the diagram with its layout. Only the modules `unfolded` show their rules. 500 nodes need about 1 s."""
    folded = fold(diagram, frozenset(unfolded))
    sizes = {node.id: node_size(node) for node in folded.nodes}
    layout = lay_out(folded, sizes, [label_size(edge.label) for edge in folded.edges])
    nodes = [
        protocol.DrawnNode(**protocol.fields_of(node), box=astuple(layout.boxes[node.id])) for node in folded.nodes
    ]
    edges = [
        protocol.DrawnEdge(**protocol.fields_of(edge), points=list(points), box=None if box is None else astuple(box))
        for edge, points, box in zip(folded.edges, layout.lines, layout.labels, strict=True)
    ]
    return protocol.Drawing(list(unfolded), layout.width, layout.height, nodes, edges)
