"""A connection: one WebSocket between a client and a conversation."""

from __future__ import annotations

import asyncio
from typing import TYPE_CHECKING

from starlette.websockets import WebSocket

from ravestate.runtime.run import until_first_ends

from . import frames
from .channel import Bucket, Channel
from .fields import VERSION, ProtocolError
from .frames import CLIENT
from .protocol import parse, picture_of, serialise, sound_of
from .session import Ending, Session

if TYPE_CHECKING:
    from .access import Access
    from .sessions import Sessions

BURST, RATE = 20, 5.0
"""A client may send a burst of `BURST` frames, and then `RATE` frames per second. The server delays further frames, but
drops none. `Writing` frames have a separate limit of the same size; beyond it, the server ignores them."""

SOUND_BURST, SOUND_RATE = 2 * 32_000, 1.25 * 32_000
"""A client may send a burst of `SOUND_BURST` bytes of sound (2 s), and then `SOUND_RATE` bytes per second. The server
ignores the rest."""

REPORTS_BURST, REPORTS_RATE = 40, 20.0
"""A client may send a burst of `REPORTS_BURST` `Played` frames, and then `REPORTS_RATE` per second. The server ignores
the rest."""

PICTURES_BURST, PICTURES_RATE = 20, 20.0
"""A client may send a burst of `PICTURES_BURST` pictures, and then `PICTURES_RATE` per second. The server delays
further pictures."""

REPLIES = 32  # the maximum number of unsent replies to a client

HELLO = f'{{"type": "hello", "v": {VERSION}}}'


class Connection:
    """Carries the protocol over one WebSocket that is not accepted yet.

    A *line* carries sound between the visitor's browser and the agent (see `PageLine`). `inside` is the path of the
    board (Raveboard). For `title`, `suggestions`, `note` and `privacy`, see `Settings`.
    """

    def __init__(
        self,
        socket: WebSocket,
        sessions: Sessions,
        access: Access,
        title: str | None = None,
        inside: str | None = None,
        suggestions: tuple[str, ...] = (),
        note: str | None = None,
        privacy: str = "",
    ) -> None:
        self._socket = socket
        self._sessions = sessions
        self._access = access
        self._title = title
        self._inside = inside
        self._suggestions = suggestions
        self._note = note
        self._privacy = privacy
        self._channel = Channel(socket, REPLIES)
        self._stream: object = None  # the line, and the number of its stream, at the last `Flush` to the client
        self._listens: object = None  # the line at the last `Listening` to the client
        self._taken: str | None = None  # why this window has lost the line, if the client does not know it yet
        self._announced: int | None = None  # the number of the last `Picture`, if its binary frame is still to come
        self._look: object = None  # the camera, and the number of the last `Look` to the client
        self._faces: tuple[frames.Face, ...] = ()  # the faces of the last `Faces` to the client
        self._unseen: str | None = None  # why this window has lost the camera, if the client does not know it yet

    async def run(self) -> None:
        """Serve the client until either side closes."""
        await self._channel.carry(self._serve)

    def wake(self) -> None:
        """Wake the task that sends changes in the conversation to the client."""
        self._channel.woken.set()

    def lose_sound(self, why: str) -> None:
        """Tell the client that its window has lost the line."""
        self._taken = why
        self.wake()

    def lose_camera(self, why: str) -> None:
        """Tell the client that its window has lost the camera."""
        self._unseen = why
        self.wake()

    async def _serve(self) -> None:
        hello = await self._hello()
        session = self._sessions.get(hello.session) if hello.session else None
        resumed = session is not None
        if session is None:
            session = await self._sessions.open(hello.name)
        self._sessions.enter(session, self)
        try:
            last = hello.last if resumed and hello.last <= session.history.last else 0
            first, newest = session.history.first, session.history.last
            agent = self._name_of(session)
            begin = (VERSION, session.id, resumed, first, agent, self._inside, newest, True)
            sight = self._privacy if session.sees else None
            await self._send(frames.Welcome(*begin, self._suggestions, self._note, session.hears or None, sight))
            await until_first_ends(self._read(session), self._write(session, max(last, first - 1), agent))
        finally:
            if session.line is not None:
                session.line.leave(self)
            session.leave_camera(self)
            self._sessions.exit(session, self)

    async def _hello(self) -> frames.Hello:
        frame = parse(await self._channel.first(HELLO), CLIENT)
        if not isinstance(frame, frames.Hello):
            raise ProtocolError("malformed", f"begin with {HELLO}")
        bearer = self._socket.headers.get("authorization", "").removeprefix("Bearer ")
        await self._access.check_token(frame.token or bearer)
        return frame

    async def _read(self, session: Session) -> None:
        now = asyncio.get_running_loop().time
        writing, others = (Bucket(burst=BURST, rate=RATE, now=now()) for _ in range(2))
        sound = Bucket(burst=SOUND_BURST, rate=SOUND_RATE, now=now())
        reports = Bucket(burst=REPORTS_BURST, rate=REPORTS_RATE, now=now())
        pictures = Bucket(burst=PICTURES_BURST, rate=PICTURES_RATE, now=now())
        while True:
            text = await self._channel.receive()
            try:
                if isinstance(text, bytes) and self._announced is not None:
                    self._take_picture(text, session)
                    await asyncio.sleep(0)
                    continue
                if isinstance(text, bytes) and session.hears:
                    block = sound_of(text)
                    if sound.take(now(), len(block)) and session.line is not None:
                        session.line.hear(self, block)
                    await asyncio.sleep(0)
                    continue
                frame = parse(text, CLIENT)
                if isinstance(frame, frames.Played) and session.hears:
                    if reports.take(now()) and session.line is not None:
                        session.line.report(self, frame.n, frame.samples)
                    await asyncio.sleep(0)
                    continue
                if isinstance(frame, frames.Picture) and session.sees:
                    self._announced = frame.n
                    await asyncio.sleep(pictures.wait(now()))
                    continue
                if isinstance(frame, frames.Writing):
                    if writing.take(now()):
                        session.notice_writing()
                    await asyncio.sleep(0)  # let other tasks run between many such frames
                    continue
                self._take(frame, session)
            except ProtocolError as error:
                self._reply(frames.Error(error.code, str(error), error.id))
            await asyncio.sleep(others.wait(now()))

    def _take(self, frame: frames.ClientFrame, session: Session) -> None:
        if isinstance(frame, frames.Say):
            if not session.hear(frame.id, frame.text):
                raise ProtocolError("over", "the conversation is ending, so it takes no more words", frame.id)
        elif isinstance(frame, frames.Ping):
            self._reply(frames.Pong())
        elif isinstance(frame, frames.Microphone | frames.Played | frames.Hush):
            self._take_sound(frame, session)
        elif isinstance(frame, frames.Camera | frames.Picture):
            self._take_camera(frame, session)
        elif isinstance(frame, frames.Bye):
            self._sessions.leave(session, Ending.BYE)
        else:
            raise ProtocolError("malformed", "send hello only once, at the beginning")

    def _take_sound(self, frame: frames.Microphone | frames.Played | frames.Hush, session: Session) -> None:
        if not session.hears:
            raise ProtocolError("deaf", "this agent neither hears nor speaks: it needs a module such as voiceio")
        if isinstance(frame, frames.Hush):
            session.hush()
        elif isinstance(frame, frames.Microphone) and frame.on:
            self._taken = self._listens = None
            session.take_line(self)
        elif isinstance(frame, frames.Microphone) and session.line is not None:
            session.line.leave(self)

    def _take_camera(self, frame: frames.Camera | frames.Picture, session: Session) -> None:
        if not session.sees:
            raise ProtocolError("blind", "this agent does not see: it needs a module such as visionio")
        if isinstance(frame, frames.Camera) and frame.on:
            self._unseen = self._look = None
            self._faces = ()
            session.take_camera(self)
        elif isinstance(frame, frames.Camera):
            session.leave_camera(self)

    def _take_picture(self, data: bytes, session: Session) -> None:
        number, self._announced = self._announced, None
        picture = picture_of(data)
        if number is not None and session.camera is not None and session.camera.window is self:
            session.camera.take(number, picture)

    def _reply(self, frame: frames.ServerFrame) -> None:
        self._channel.reply(serialise(frame))

    async def _write(self, session: Session, last: int, agent: str) -> None:
        """Send each change. The client has the messages up to number `last`, and shows the agent's name as `agent`."""
        shown, typing, paused, caption, marked = "", False, False, "", 0
        woken = self._channel.woken
        while True:
            woken.clear()
            await self._channel.send_replies()
            if (name := self._name_of(session)) != agent:
                agent = name
                await self._send(frames.Renamed(agent))
            for message in session.history.since(last):
                if message.n != last + 1:
                    raise ProtocolError("behind", f"message {last + 1} is no longer kept: connect again")
                await self._send(message)
                last = message.n
                shown = "" if message.speaker == "agent" else shown
            if session.partial != shown and last == session.history.last:
                same = _common(shown, session.partial)
                shown = session.partial
                await self._send(frames.Piece(_units(shown[:same]), shown[same:]))
            if session.typing != typing:
                typing = session.typing
                await self._send(frames.Typing(typing))
            if session.paused != paused:
                paused = session.paused
                await self._send(frames.Paused(paused))
            if session.caption != caption:
                caption = session.caption
                await self._send(frames.Caption(caption))
            marks, marked = session.history.marks_since(marked), session.history.marked
            for mark in marks:
                if mark.n <= last:  # a message that is sent later says itself how much was heard
                    await self._send(mark)
            await self._write_sound(session)
            await self._write_sight(session)
            if session.ended is not None and last == session.history.last:
                await self._send(frames.Ended(session.ended.for_visitor))
                await self._channel.end()
                return
            await woken.wait()

    async def _write_sound(self, session: Session) -> None:
        """Send the agent's sound if this window has the line. If it has just lost the line, tell the client."""
        if self._taken is not None:
            why, self._taken = self._taken, None
            await self._send(frames.Taken(why))
        line = session.line
        while line is not None and line.window is self:
            if (line, line.stream) != self._stream:
                self._stream = line, line.stream
                await self._send(frames.Flush(line.stream))
            elif line.listens and self._listens is not line:
                self._listens = line
                await self._send(frames.Listening())
            elif (sound := line.fetch(self)) is not None:
                await self._channel.send_sound(sound)
            else:
                return

    async def _write_sight(self, session: Session) -> None:
        """If this window has the camera, ask for a picture, and send the faces that the agent sees."""
        if self._unseen is not None:
            why, self._unseen = self._unseen, None
            await self._send(frames.Unseen(why))
        camera = session.camera
        if camera is None or camera.window is not self:
            return
        if camera.waits and self._look != (camera, camera.asked):
            self._look = camera, camera.asked
            await self._send(frames.Look(camera.asked))
        if camera.faces != self._faces:
            self._faces = camera.faces
            await self._send(frames.Faces(camera.faces))

    def _name_of(self, session: Session) -> str:
        """Return the agent's name for the page of a conversation."""
        return session.agent if self._title is None else self._title

    async def _send(self, frame: frames.ServerFrame) -> None:
        await self._channel.send(serialise(frame))


def _common(one: str, other: str) -> int:
    """Return the length of the common prefix of two texts."""
    if other.startswith(one):  # the usual case: the text grows
        return len(one)
    return next((n for n, (a, b) in enumerate(zip(one, other, strict=False)) if a != b), min(len(one), len(other)))


def _units(text: str) -> int:
    """Return the length of a text in UTF-16 units, as JavaScript counts."""
    return len(text) + sum(character > "\uffff" for character in text)
