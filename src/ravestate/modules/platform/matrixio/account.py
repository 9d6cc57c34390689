"""The account: it logs in, joins the Matrix rooms whose invitations `allow` permits, and passes on their messages.

The messages go to the class `Room` of `chats`, which has a chat for each Matrix room.
"""

from __future__ import annotations

import asyncio
import json
import logging
import sqlite3
import sys
from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING, Any

from nio import (  # pyright: ignore[reportMissingTypeStubs]
    AsyncClient,
    AsyncClientConfig,
    ErrorResponse,
    Event,
    InviteMemberEvent,
    MatrixRoom,
    MegolmEvent,
    RoomMemberEvent,
    SyncResponse,
)
from nio.crypto import ENCRYPTION_ENABLED  # pyright: ignore[reportMissingTypeStubs]

from ravestate.errors import PlatformError
from ravestate.folders import user_folder
from ravestate.modules.platform.chats import Attempts, Incoming, Person, Room

from .carrier import GONE, LOST, MatrixCarrier
from .events import incoming

if TYPE_CHECKING:
    from ravestate.runtime.agent import Agent

    from .names import Settings

POLL = 30_000  # if there are no events, the server waits this many milliseconds before it answers
ANSWER = 20.0  # the maximum number of seconds to wait for the answer to a request
PAGE = 100  # the maximum number of events of a room in one answer
DEVICE = "RAVESTATE"  # always the same, so that the server recognises a message that is repeated after a restart
JOINS = 12  # after this many refusals (four to five minutes), the agent stops trying to join a room
REFUSED = ("M_UNKNOWN_TOKEN", "M_MISSING_TOKEN", "M_FORBIDDEN", "M_USER_DEACTIVATED")
FILTER: dict[str, Any] = {"presence": {"types": []}, "room": {"timeline": {"limit": PAGE}, "ephemeral": {"types": []}}}

log = logging.getLogger("ravestate.matrixio")


async def run(agent: Agent, settings: Settings) -> None:
    """Serve the account's rooms until cancelled."""
    config = AsyncClientConfig(max_limit_exceeded=0, max_timeouts=0, request_timeout=ANSWER)
    client = AsyncClient(settings.homeserver.rstrip("/"), settings.user, DEVICE, _key_folder(settings), config)
    try:
        await _log_in(client, settings)
        async with Room(agent, "matrixio", MatrixCarrier(client), client.user_id) as room:
            sys.stdout.write(f"{client.user_id} is on Matrix (Ctrl-C ends it)\n")
            sys.stdout.flush()
            await Inlet(client, room, settings).run()
    finally:
        await client.close()


def _key_folder(settings: Settings) -> str:
    """Make and return the folder for the keys of encrypted rooms; if encryption is not installed, return an empty text."""
    if not ENCRYPTION_ENABLED:
        return ""
    folder = (settings.path.parent if settings.path else user_folder("data") / "chats") / "matrix-keys"
    folder.mkdir(mode=0o700, parents=True, exist_ok=True)
    return str(folder)


async def _log_in(client: AsyncClient, settings: Settings) -> None:
    """Log in. After any failure except a refused account, try again."""
    attempts = Attempts(log, f"{settings.homeserver} does not answer")
    while True:
        try:
            if settings.token:
                client.access_token = settings.token.get_secret_value()
                answer: Any = await client.whoami()
            else:
                assert settings.password is not None  # `serve` has checked it
                answer = await client.login(settings.password.get_secret_value(), device_name="Ravestate")
        except LOST as error:
            why: object = type(error).__name__
        else:
            if not isinstance(answer, ErrorResponse):
                if settings.token:
                    client.restore_login(answer.user_id, answer.device_id or DEVICE, client.access_token)
                return
            if answer.status_code in REFUSED:
                raise PlatformError(
                    f"matrixio: {settings.homeserver} refuses the account: check matrixio.user with "
                    f"RAVESTATE_MATRIXIO_PASSWORD, or RAVESTATE_MATRIXIO_TOKEN ({answer.message})"
                )
            why = answer.message
        await attempts.fail(why)


class Inlet:
    """Gets events from the server, and passes their messages to `room` (all chats of the account)."""

    def __init__(self, client: AsyncClient, room: Room, settings: Settings) -> None:
        self._client, self._room, self._settings = client, room, settings
        self._joining: dict[str, asyncio.Task[None]] = {}

    async def run(self) -> None:
        """Get events until cancelled."""
        for room in json.loads(self._room.store.noted("invited") or "[]"):
            self._accept(room)
        try:
            await self._sync()
        finally:
            for task in self._joining.values():
                task.cancel()

    async def _sync(self) -> None:
        attempts, first = Attempts(log, "no events"), True
        while True:
            try:
                await self._exchange_keys()
                since = self._room.store.noted("since")
                async with asyncio.timeout(POLL / 1000 + ANSWER):  # nio would wait forever for the first answer
                    answer: Any = await self._client.sync(
                        timeout=0 if first else POLL, sync_filter=FILTER, since=since, full_state=first
                    )
                if isinstance(answer, SyncResponse):
                    await self._take(answer, since)
                    attempts.succeed()
                    first = False
                    continue
                why: object = answer
                if answer.status_code in REFUSED:
                    raise PlatformError("matrixio: the server has ended the login: start again, or renew the token")
            except (*LOST, sqlite3.Error) as error:
                why = repr(error)
            await attempts.fail(why)

    async def _exchange_keys(self) -> None:
        """Send and get the keys that encrypted rooms need."""
        client: Any = self._client
        if client.olm is None:
            return
        await client.send_to_device_messages()
        if client.should_upload_keys:
            await client.keys_upload()
        if client.should_query_keys:
            await client.keys_query()
        if client.should_claim_keys:
            await client.keys_claim(client.get_users_for_key_claiming())

    async def _take(self, answer: SyncResponse, since: str | None) -> None:
        """Store the messages in an answer's events. In the same transaction, note the position after these events."""
        messages: list[Incoming] = []
        rooms: Any = answer.rooms  # nio's types are not complete
        for id, info in rooms.join.items():
            events: list[Event] = info.timeline.events
            if info.timeline.limited and since is not None:
                events = [*await self._missed(id, info.timeline.prev_batch, since), *events]
            room = self._client.rooms.get(id)
            if room is not None and (since is not None or self._invited(events)):
                messages += self._read(room, events)
        agent = Person(self._client.user_id)
        for id in rooms.leave:
            messages.append(Incoming(key=f"left {answer.next_batch} {id}", chat=id, id="", kind="left", person=agent))
        for id, invitation in rooms.invite.items():
            self._invite(id, invitation.invite_state)
        self._room.receive(messages, ("since", answer.next_batch))

    async def _missed(self, room: str, start: str | None, end: str) -> list[Event]:
        """Return the events that the server left out of an answer because there were too many.

        Raises:
            OSError: The server does not send these events now. The caller must keep its position, and ask again.
        """
        found: list[Event] = []
        while start:
            page: Any = await self._client.room_messages(room, start, end, limit=PAGE)
            if isinstance(page, ErrorResponse) and page.status_code not in GONE:
                raise ConnectionError(f"older messages of {room} are missing: {page}")
            if isinstance(page, ErrorResponse) or not page.chunk:
                break
            found += page.chunk
            start = page.end
        return found[::-1]

    def _invited(self, events: Iterable[Event]) -> bool:
        return any(self._is_invitation(event) for event in events)

    def _is_invitation(self, event: Event) -> bool:
        me = self._client.user_id
        return isinstance(event, RoomMemberEvent) and event.state_key == me and event.membership == "invite"

    def _read(self, room: MatrixRoom, events: Sequence[Event]) -> list[Incoming]:
        """Return the messages in a room's events. Leave out the events before the agent's invitation."""
        me = self._client.user_id
        names = {room.user_name(me) or "", *self._room.called}
        invited = max((at for at, event in enumerate(events) if self._is_invitation(event)), default=0)
        if any(isinstance(event, MegolmEvent) for event in events[invited:]):
            why = "the agent has no key for some of its messages"
            if self._client.olm is None:
                why = "its messages cannot be read without pip install 'ravestate[matrix-encrypted]'"
            self._room.warn(room.room_id, f"is encrypted: {why}")
        return self._room.read(events[invited:], lambda event: incoming(event, room, me, names))

    def _invite(self, room: str, state: Iterable[Any]) -> None:
        me = self._client.user_id
        inviters = [e.sender for e in state if isinstance(e, InviteMemberEvent) and e.state_key == me]
        if self._settings.allows(room, *inviters):
            self._accept(room)
        else:
            self._room.warn(room, f"is not joined: {', '.join(inviters)} is not in matrixio.allow")

    def _accept(self, room: str) -> None:
        """Join a room in a task. The server reports an invitation only once, so store it until the agent joins or gives up."""
        if room not in self._joining:
            self._room.store.note("invited", json.dumps([*self._joining, room]))
            self._joining[room] = asyncio.create_task(self._join(room))

    async def _join(self, room: str) -> None:
        refusals, attempts = 0, Attempts(log, f"room {room} is not joined yet")
        answer: Any
        while True:
            try:
                answer = await self._client.join(room)
                if not isinstance(answer, ErrorResponse):
                    break
                refusals += answer.status_code not in (None, "M_LIMIT_EXCEEDED")
                if refusals == JOINS or answer.status_code in GONE:
                    log.warning("room %s cannot be joined: %s", room, answer)
                    break
            except LOST as error:
                answer = repr(error)
            await attempts.fail(answer)
        del self._joining[room]
        await self._room.persist(lambda: self._room.store.note("invited", json.dumps(list(self._joining))))
