"""Translate the updates of Telegram into messages for `Room`."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace

from telegram import Chat as TelegramChat
from telegram import Message, MessageReactionUpdated, ReactionTypeEmoji, Update, User

from ravestate.modules.platform.chats import Incoming, Person, addressed
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
        return _reaction(update, reaction)
    if (member := update.my_chat_member) is not None:
        if member.new_chat_member.status not in ("left", "kicked"):
            return None
        return _made(update, member.chat, "", "left", member.from_user)
    message = update.message or update.edited_message
    if message is None or message.from_user is None or message.from_user.is_bot:
        return None
    whole, group = message.text or message.caption or "", message.chat.type != "private"
    found = addressed(whole, (f"@{me.username}",), names, group=group, called=_replies(message, me))
    if found is None:
        return None
    command, words = found
    content = ("command", command, "") if command else _content(message, words)
    if update.edited_message and content:
        content = ("edit", content[1], "") if content[0] == "text" else None
    if content is None:
        return None
    kind, text, file = content
    made = _made(update, message.chat, message.message_id, kind, message.from_user, text, file)
    return replace(made, topic=str(message.message_thread_id)) if message.is_topic_message else made


def _content(message: Message, text: str) -> tuple[Said, str, str] | None:
    """Return the kind, the words and the file of a message; None if the message has no content that the agent knows."""
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
    update: Update, chat: TelegramChat, id: int | str, kind: Said, user: User, text: str = "", file: str = ""
) -> Incoming:
    aliases = tuple(name for name in (user.username, chat.username) if name)
    return Incoming(
        key=str(update.update_id), chat=str(chat.id), id=str(id), kind=kind, text=text, file=file,
        person=Person(str(user.id), user.first_name or user.username), group=chat.type != "private", aliases=aliases,
    )  # fmt: skip


def _reaction(update: Update, reaction: MessageReactionUpdated) -> Incoming | None:
    """Return the new emoji of a reaction to any message, whose author the update does not name; None if none is new."""
    emoji = [each.emoji for each in reaction.new_reaction if isinstance(each, ReactionTypeEmoji)]
    old = {each.emoji for each in reaction.old_reaction if isinstance(each, ReactionTypeEmoji)}
    new = next((str(each) for each in emoji if each not in old), None)
    if new is None or reaction.user is None:
        return None
    return _made(update, reaction.chat, reaction.message_id, "reaction", reaction.user, new)


def _replies(message: Message, me: User) -> bool:
    """Return whether a message is a reply to the bot."""
    replied = message.reply_to_message
    return bool(replied and replied.from_user and replied.from_user.id == me.id)
