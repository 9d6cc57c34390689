"""Translate the events of a Matrix room into messages for `Room`."""

from __future__ import annotations

import json
import re
from collections.abc import Iterable
from typing import Any

from nio import (  # pyright: ignore[reportMissingTypeStubs]
    Event,
    MatrixRoom,
    ReactionEvent,
    RoomEncryptedAudio,
    RoomEncryptedImage,
    RoomEncryptedMedia,
    RoomMessage,
    RoomMessageAudio,
    RoomMessageImage,
)

from ravestate.modules.platform.chats import Incoming, Person, addressed
from ravestate.modules.platform.chats.addressing import mentions
from ravestate.modules.platform.chats.messages import Said

SPOKEN = ("m.text", "m.emote")
"""The types of text messages that the agent reads. Other bots write notices, which the agent must not answer."""

QUOTE = re.compile(r"\A(?:> .*\n)+\n?")
"""The quotation of another message at the beginning of a reply, as older clients write it."""


def incoming(event: Event, room: MatrixRoom, me: str, names: Iterable[str]) -> Incoming | None:
    """Return the message in an event; None if it does not concern the agent.

    Args:
        event: The event.
        room: The room of the event.
        me: The agent's own id.
        names: The agent's names. In a group, a message with one of them is for the agent.
    """
    if event.sender == me:
        return None
    person = Person(event.sender, room.user_name(event.sender))
    group = room.member_count > 2
    if isinstance(event, ReactionEvent):  # it does not name the author of the message, so `Room` looks for them
        return _made(event, room, event.reacts_to, "reaction", person, event.key, group=group)
    if not isinstance(event, RoomMessage):
        return None
    content: dict[str, Any] = event.source["content"]
    id, kind = event.event_id, "text"
    relation: dict[str, Any] = content.get("m.relates_to") or {}
    if relation.get("rel_type") == "m.replace":
        content, id, kind = content["m.new_content"], str(relation["event_id"]), "edit"
    body = str(content.get("body", ""))
    called: dict[str, Any] = content.get("m.mentions") or {}
    mentioned = me in called.get("user_ids", ()) or mentions(body, (me,))  # also in the quotation of a reply
    handles = (me, f"@{me[1:].partition(':')[0]}")
    found = addressed(QUOTE.sub("", body), handles, names, group=group, called=mentioned)
    if found is None:
        return None
    command, text = found
    if kind == "edit":
        return _made(event, room, id, "edit", person, text, group=group) if content.get("msgtype") in SPOKEN else None
    if isinstance(event, (RoomMessageImage, RoomEncryptedImage)):
        caption = text if content.get("filename", body) != body else ""
        return _made(event, room, id, "picture", person, caption, _file(event), group)
    if isinstance(event, (RoomMessageAudio, RoomEncryptedAudio)):
        return _made(event, room, id, "voice", person, "", _file(event), group)
    if content.get("msgtype") not in SPOKEN or not text.strip():
        return None
    return _made(event, room, id, "command" if command else "text", person, command or text, group=group)


def _file(event: Any) -> str:
    """Return the address of a file, or the JSON that describes an encrypted file, for the carrier."""
    secret = isinstance(event, RoomEncryptedMedia)
    return json.dumps(event.source["content"]["file"]) if secret else str(event.url)


def _made(
    event: Event, room: MatrixRoom, id: str, kind: Said, person: Person, text: str, file: str = "", group: bool = False
) -> Incoming:
    return Incoming(
        key=event.event_id, chat=room.room_id, id=id, kind=kind, person=person, text=text, file=file, group=group
    )
