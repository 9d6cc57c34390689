"""Updates: the messages that Telegram reports, as the room takes them."""

from __future__ import annotations

from collections.abc import Iterable

from telegram import Message, MessageReactionUpdated, ReactionTypeEmoji, Update, User

from ravestate.modules.platform.chats import Incoming, Person, command_in, for_another, mentions, without_mention
from ravestate.modules.platform.chats.messages import Said

KINDS = ["message", "edited_message", "message_reaction", "my_chat_member"]
"""The kinds of updates that the bot asks for."""


def incoming(update: Update, me: User, names: Iterable[str]) -> Incoming | None:
    """Return the message in an update; None if it does not concern the agent.

    Args:
        update: The update.
        me: The bot.
        names: The agent's names. In a group, a message that contains one of them is for the agent.
    """
    if (reaction := update.message_reaction) is not None:
        return _reaction(reaction, str(update.update_id))
    if (member := update.my_chat_member) is not None:
        if member.new_chat_member.status not in ("left", "kicked"):
            return None
        return _made(update, member.chat.id, "", "left", _person(member.from_user), group=True)
    message = update.message or update.edited_message
    if message is None or message.from_user is None or message.from_user.is_bot:
        return None
    mention = f"@{me.username}"
    whole = message.text or message.caption or ""
    group = message.chat.type != "private"
    if for_another(whole, me.username or ""):
        return None
    command = command_in(whole)
    if group and not (command or _replies(message, me) or mentions(whole, (mention, *names))):
        return None
    found = _content(message, without_mention(whole, mention))
    if command:
        found = ("command", command, "")
    if update.edited_message:
        found = ("edit", found[1], "") if found and found[0] == "text" else None
    if found is None:
        return None
    kind, text, file = found
    return _made(update, message.chat.id, message.message_id, kind, _person(message.from_user), text, file, group)


def _content(message: Message, text: str) -> tuple[Said, str, str] | None:
    """Return the kind, the words and the file of a message."""
    if message.photo:
        return "picture", text, message.photo[-1].file_id
    if message.document and (message.document.mime_type or "").startswith("image/"):
        return "picture", text, message.document.file_id
    if sound := message.voice or message.audio:
        return "voice", "", sound.file_id
    if message.sticker and message.sticker.emoji:
        text = message.sticker.emoji
    return ("text", text, "") if text.strip() else None


def _made(
    update: Update, chat: int, id: int | str, kind: Said, person: Person,
    text: str = "", file: str = "", group: bool = False,
) -> Incoming:  # fmt: skip
    key = str(update.update_id)
    return Incoming(key=key, chat=str(chat), id=str(id), kind=kind, person=person, text=text, file=file, group=group)


def _person(user: User) -> Person:
    return Person(str(user.id), user.first_name or user.username)


def _reaction(update: MessageReactionUpdated, key: str) -> Incoming | None:
    emoji = [each.emoji for each in update.new_reaction if isinstance(each, ReactionTypeEmoji)]
    old = {each.emoji for each in update.old_reaction if isinstance(each, ReactionTypeEmoji)}
    new = next((str(each) for each in emoji if each not in old), None)
    if new is None or update.user is None:
        return None
    person, chat = _person(update.user), str(update.chat.id)
    return Incoming(key=key, chat=chat, id=str(update.message_id), kind="reaction", text=new, person=person)


def _replies(message: Message, me: User) -> bool:
    """Return whether a message is a reply to the bot."""
    replied = message.reply_to_message
    return bool(replied and replied.from_user and replied.from_user.id == me.id)
