"""One inspector: a WebSocket over which a browser sees what happens, and asks and does things."""

from __future__ import annotations

import asyncio
import json
from time import perf_counter
from typing import TYPE_CHECKING, Any

from starlette.websockets import WebSocket

from ravestate.board import picture
from ravestate.board.commands import Command, Diagram, Explain, Hello, Look, Ping, Why, parse
from ravestate.board.leisure import Leisure
from ravestate.board.recorder import Gap, Recorders
from ravestate.board.shelf import Shelf
from ravestate.board.subject import Live, Recorded, Subject
from ravestate.board.why_not import why_not
from ravestate.board.wire import VERSION, data_of, whole_data
from ravestate.errors import RavestateError
from ravestate.modules.platform.webio.bucket import Bucket
from ravestate.modules.platform.webio.channel import Channel
from ravestate.modules.platform.webio.protocol import ProtocolError

if TYPE_CHECKING:
    from ravestate.modules.platform.webio.access import Access
    from ravestate.modules.platform.webio.session import Session
    from ravestate.modules.platform.webio.sessions import Sessions

__all__ = ["Inspector"]

FRAME = 0.05
"""Seconds between two frames of records."""

SHARE = 0.015
"""The share of the loop's time that telling one inspector may take: a frame that took long is followed by a long pause."""

OF_SPARE = 0.5
"""Of the time that the process has to spare, the share that it may take besides."""

MOST = 800
"""Records in one frame: more would hold the agent up."""

BACKLOG = 20_000
"""Records of the past that an inspector gets when it comes."""

LAG = 25_000
"""Records by which an inspector may be behind; more are left out, so that it sees what happens now."""

BURST, SPEED = 60, 30.0
"""Commands that are taken at once, and each second after that. Who sends more has to wait."""

LISTED = 1.0
"""Seconds between two looks at which conversations there are."""

LIST = 100
"""Conversations that are listed: the newest, and the one that is looked at."""

WORDS = 48
"""Characters of a visitor's last words, by which a conversation is known."""

REPLIES = 64
"""Answers that may wait for a client."""

HELLO = f'{{"type": "hello", "v": {VERSION}}}'


class Inspector:
    """Carries the board's protocol over one WebSocket.

    Args:
        socket: Not accepted yet.
        gate: Knows the token.
        sessions: The conversations.
        recorders: Those of their contexts.
        shelf: The recordings.
        title: What the agent is called; None: what it calls itself.
    """

    def __init__(
        self,
        socket: WebSocket,
        gate: Access,
        sessions: Sessions,
        recorders: Recorders,
        shelf: Shelf,
        title: str | None,
    ) -> None:
        self._channel = Channel(socket, REPLIES)
        self._gate = gate
        self._sessions = sessions
        self._recorders = recorders
        self._shelf = shelf
        self._title = title

    def wake(self) -> None:
        """As an onlooker of a conversation: what it has to tell stands in the records."""

    async def run(self) -> None:
        """Serve the browser until either side closes."""
        await self._channel.carry(self._serve)

    async def _serve(self) -> None:
        hello = await self._hello()
        session: Session | None = None
        recorded = self._recording(hello)
        if recorded is not None:
            subject: Subject = recorded
            title = recorded.title
        else:
            session = await self._session(hello)
            self._sessions.enter(session, self)
            subject = Live(session, self._recorders.of(session.context))
            title = self._title_of(session)
        try:
            if session is not None:
                await asyncio.sleep(0)  # a conversation that is new has begun by now
            seen = max(subject.first - 1, subject.last - BACKLOG)
            await self._send(
                {
                    "type": "welcome",
                    "v": VERSION,
                    "title": title,
                    "live": subject.live,
                    "visitor": None if session is None else session.visitor,
                    "whole": subject.whole and seen == 0,
                    "policy": whole_data(subject.description),
                    **subject.clock(),
                }
            )
            await self._send({"type": "state", **subject.look(), **subject.clock()})
            await self._channel.both(self._read(subject), self._write(subject, session, seen, title))
        finally:
            if session is not None:
                self._sessions.exit(session, self)
                if isinstance(subject, Live) and not any(isinstance(o, Inspector) for o in session.onlookers):
                    subject.leave()

    # ------------------------------------------------------------------------------------ what is looked at

    async def _hello(self) -> Hello:
        text = await self._channel.first(HELLO)
        try:
            command = parse(text)
        except ValueError as error:
            raise ProtocolError("malformed", str(error)) from None
        if not isinstance(command, Hello):
            raise ProtocolError("malformed", f"begin with {HELLO}")
        if command.v != VERSION:
            raise ProtocolError("version", f'"v": {command.v}: this side speaks version {VERSION} only')
        await self._gate.check_token(command.token)
        return command

    def _recording(self, hello: Hello) -> Recorded | None:
        if hello.session is not None or hello.visitor is not None:
            return None
        recording = self._shelf.get(hello.recording)
        if recording is None and hello.recording is not None:
            raise ProtocolError("gone", "this recording is kept no more: open its file again")
        return None if recording is None else Recorded(recording)

    async def _session(self, hello: Hello) -> Session:
        if hello.session is not None:
            session = self._sessions.get(hello.session)
        elif hello.visitor is not None:
            session = next((s for s in self._sessions if s.visitor == hello.visitor), None)
        else:
            going_on = [session for session in self._sessions if not session.leaving]
            return going_on[-1] if going_on else await self._sessions.open()
        if session is None:
            raise ProtocolError("gone", "this conversation has ended")
        return session

    # ------------------------------------------------------------------------------------ from the browser

    async def _read(self, subject: Subject) -> None:
        now = asyncio.get_running_loop().time
        bucket = Bucket(burst=BURST, rate=SPEED, now=now())
        while True:
            text = await self._channel.receive()
            wait = bucket.wait(now())
            if wait:
                await asyncio.sleep(wait)
            try:
                command = parse(text)
            except ValueError as error:
                self._reply({"type": "error", "code": "malformed", "text": str(error)})
                continue
            try:
                await self._take(command, subject)
            except (RavestateError, LookupError, ValueError) as error:
                words = str(error.args[0]) if isinstance(error, LookupError) and error.args else str(error)
                self._reply({"type": "error", "code": "refused", "text": words, "of": command.type})

    async def _take(self, command: Command, subject: Subject) -> None:
        match command:
            case Why():
                records = [
                    r for r in subject.since(subject.first - 1, subject.last) if not isinstance(r, Gap)
                ]
                found = await asyncio.to_thread(
                    why_not,
                    records,
                    subject.description,
                    command.rule,
                    command.spike,
                    subject.opens,
                    subject.whole,
                )
                self._reply({"type": "why", **whole_data(found)})
            case Diagram():
                drawn = await asyncio.to_thread(
                    picture.draw, subject.description.diagram, frozenset(command.unfolded)
                )
                self._reply({"type": "diagram", "unfolded": command.unfolded, **drawn})
            case Explain():
                self._reply({"type": "explained", "rule": command.rule, **subject.explain(command.rule)})
            case Look():
                self._reply({"type": "state", **subject.look(), **subject.clock()})
            case Ping():
                self._reply({"type": "pong"})
            case Hello():
                raise ValueError("hello is said once, at the beginning")
            case _:
                await subject.act(command)

    def _reply(self, frame: dict[str, Any]) -> None:
        self._channel.reply(_json(frame))

    # ------------------------------------------------------------------------------------ to the browser

    async def _write(self, subject: Subject, session: Session | None, seen: int, title: str) -> None:
        """Tell what happens, some twenty times a second at most, and answer."""
        leisure = Leisure()
        clock: dict[str, Any] = {}
        listed: dict[str, Any] = {}
        now, looked = asyncio.get_running_loop().time, -LISTED
        while True:
            began = perf_counter()
            self._channel.woken.clear()
            await self._channel.send_replies()
            if isinstance(subject, Live) and subject.renewed():
                await self._send({"type": "policy", "policy": whole_data(subject.description)})
            if session is not None and self._title_of(session) != title:
                title = self._title_of(session)
                await self._send({"type": "renamed", "title": title})
            if session is not None and now() - looked >= LISTED:
                looked = now()
                if (conversations := self._conversations(session)) != listed:
                    listed = conversations
                    await self._send({"type": "conversations", **listed})
            missed = max(0, subject.first - 1 - seen)
            if subject.live and subject.last - seen > LAG:
                missed = subject.last - seen - MOST
            records = subject.since(seen + missed, MOST)
            paused = subject.clock()["paused"]
            text = ""
            gap = False
            if records or missed or paused != clock.get("paused"):
                seen += missed + len(records)
                clock = subject.clock()
                gap = missed > 0 or any(isinstance(record, Gap) for record in records)
                behind = subject.last - seen
                text = _json(
                    {
                        "type": "records",
                        "records": [data_of(record) for record in records],
                        "missed": missed,
                        "behind": behind,
                        **clock,
                    }
                )
            took = perf_counter() - began
            if text:
                await self._channel.send(text)
            if gap and subject.live:
                await self._send({"type": "state", **subject.look(), **subject.clock()})
            if session is not None and session.ended is not None and seen >= subject.last:
                await self._send({"type": "ended", "text": session.ended})
                await self._channel.end()
                return
            seconds = max(FRAME, took / (SHARE + OF_SPARE * leisure.share())) if text else FRAME
            await self._pause(seconds if subject.live else 0.0, seen < subject.last)

    async def _pause(self, seconds: float, more: bool) -> None:
        """Until the next frame; answers need not wait so long."""
        if seconds == 0.0 and not more:
            await self._channel.woken.wait()
            return
        try:
            async with asyncio.timeout(seconds):
                await self._channel.woken.wait()
        except TimeoutError:
            pass

    def _title_of(self, session: Session) -> str:
        return session.agent if self._title is None else self._title

    def _conversations(self, own: Session) -> dict[str, Any]:
        """Those that go on, the oldest first, and how many more there are."""
        going_on = list(self._sessions)
        listed = going_on[-LIST:]
        if own in going_on[:-LIST]:
            listed[0] = own
        return {
            "conversations": [_conversation(session) for session in listed],
            "more": len(going_on) - len(listed),
        }

    async def _send(self, frame: dict[str, Any]) -> None:
        await self._channel.send(_json(frame))


def _conversation(session: Session) -> dict[str, Any]:
    newest = session.history.newest("user")
    return {
        "visitor": session.visitor,
        "name": session.name,
        "began": session.began,
        "said": None if newest is None else newest.text[:WORDS],
    }


def _json(frame: dict[str, Any]) -> str:
    """In ASCII, as there may be halves of characters in it, which nothing else can be sent with."""
    return json.dumps(frame, separators=(",", ":"))
