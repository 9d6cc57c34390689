"""Updates: the messages that Telegram reports, as the room takes them."""

from __future__ import annotations

import re
from collections.abc import Mapping
from typing import Any

from telegram import Bot, Message, MessageReactionUpdated, Update, User
from telegram.constants import ChatType, MessageEntityType

from ravestate.modules.platform.chats import COMMANDS, Incoming, Person

KINDS = ["message", "edited_message", "message_reaction", "my_chat_member"]
"""The kinds of updates that the bot asks for."""


def allowed(update: Update, allow: tuple[int | str, ...]) -> bool:
    """Return whether the agent may answer the sender of an update; an empty list allows everybody."""
    if not allow:
        return True
    user, chat = update.effective_user, update.effective_chat
    names = {str(each).removeprefix("@").casefold() for each in allow}
    known = (user and user.id, user and user.username, chat and chat.id, chat and chat.username)
    return any(str(each).casefold() in names for each in known if each)


def parse(data: Mapping[str, Any], bot: Bot) -> Update | None:
    """Return an update from the server's data; None if the data is no update that the agent can use.

    Raises:
        Exception: The data is malformed.
    """
    update = Update.de_json(dict(data), bot)
    used = update and (update.message or update.edited_message or update.message_reaction or update.my_chat_member)
    return update if used else None


def incoming(update: Update, me: User, names: tuple[str, ...]) -> Incoming | None:
    """Return the message in an update; None if it does not concern the agent.

    Args:
        update: The update.
        me: The bot.
        names: The agent's names. In a group, a message that contains one of them is for the agent.
    """
    key = str(update.update_id)
    if update.message_reaction:
        return _reaction(update.message_reaction, key)
    if update.my_chat_member:
        member = update.my_chat_member
        if member.new_chat_member.status not in ("left", "kicked"):
            return None
        return Incoming(
            key=key, chat=str(member.chat.id), id="", kind="left", person=_person(member.from_user), group=True
        )
    message = update.message or update.edited_message
    if message is None or message.from_user is None or message.from_user.is_bot:
        return None
    text = message.text or message.caption or ""
    group = message.chat.type != ChatType.PRIVATE
    name, text = _command(message, text, me)
    if name is None:  # for another bot
        return None
    if group and not name and not _addressed(message, text, me, names):
        return None
    base = {"key": key, "chat": str(message.chat.id), "id": str(message.message_id), "group": group}
    person = _person(message.from_user)
    if update.edited_message:
        return Incoming(**base, person=person, kind="edit", text=text) if message.text else None
    if name:
        return Incoming(**base, person=person, kind="command", text=name)
    if message.photo:
        return Incoming(**base, person=person, kind="picture", text=text, file=message.photo[-1].file_id)
    if message.document and (message.document.mime_type or "").startswith("image/"):
        return Incoming(**base, person=person, kind="picture", text=text, file=message.document.file_id)
    sound = message.voice or message.audio
    if sound:
        return Incoming(**base, person=person, kind="voice", file=sound.file_id)
    if message.sticker and message.sticker.emoji:
        text = message.sticker.emoji
    return Incoming(**base, person=person, text=text) if text.strip() else None


def _person(user: User) -> Person:
    return Person(str(user.id), user.first_name or user.username)


def _reaction(update: MessageReactionUpdated, key: str) -> Incoming | None:
    emoji = [each.emoji for each in update.new_reaction if each.type == "emoji" and each not in update.old_reaction]
    if not emoji or update.user is None:
        return None
    return Incoming(
        key=key, chat=str(update.chat.id), id=str(update.message_id), kind="reaction", text=str(emoji[0]),
        person=_person(update.user), group=update.chat.type != ChatType.PRIVATE,
    )  # fmt: skip


def _command(message: Message, text: str, me: User) -> tuple[str | None, str]:
    """Return the name of a known command, or an empty text; None for a command to another bot; and the words."""
    found = re.match(r"/(\w+)(?:@(\w+))?(?:\s|$)", text)
    if found is None:
        return "", _without_mention(text, me)
    if found[2] and found[2].casefold() != (me.username or "").casefold():
        return None, text
    name = found[1].casefold()
    return (name, "") if name in COMMANDS else ("", _without_mention(text, me))


def _without_mention(text: str, me: User) -> str:
    if not me.username:
        return text
    return re.sub(rf"\s*@{re.escape(me.username)}\b[,:]?", "", text, flags=re.IGNORECASE).strip()


def _addressed(message: Message, text: str, me: User, names: tuple[str, ...]) -> bool:
    """Return whether a message in a group is for the agent: a mention, a reply, or its name."""
    replied = message.reply_to_message
    if replied and replied.from_user and replied.from_user.id == me.id:
        return True
    whole = message.text or message.caption or ""
    if me.username and re.search(rf"@{re.escape(me.username)}\b", whole, re.IGNORECASE):
        return True
    entities = (*message.entities, *message.caption_entities)
    if any(e.type == MessageEntityType.TEXT_MENTION and e.user and e.user.id == me.id for e in entities):
        return True
    return any(name and re.search(rf"(?<!\w){re.escape(name)}(?!\w)", text, re.IGNORECASE) for name in names)
