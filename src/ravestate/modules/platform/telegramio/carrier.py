"""The carrier: it sends messages to Telegram, and fetches files from it."""

from __future__ import annotations

import asyncio
import contextlib
from collections import defaultdict, deque
from collections.abc import Generator
from typing import Any

import httpx
from telegram import Bot, ReactionTypeEmoji, ReplyParameters
from telegram.constants import ChatAction, MessageLimit, ReactionEmoji
from telegram.error import BadRequest, ChatMigrated, Forbidden, InvalidToken, TelegramError, TimedOut

from ravestate.modules.platform.chats import DeliveryError, Outgoing
from ravestate.modules.platform.chats.sender import SHOWN

from .requests import FloodError

UNSENT = (httpx.ConnectError, httpx.ConnectTimeout, httpx.PoolTimeout)  # errors before a request is sent
AHEAD = 40  # after an attempt without an answer, look for the message among this many ids
KNOWN = 1000  # how many of the newest message ids to remember for each numbering (see `_numbering`)
DRAFT = 1  # the id of every draft, because a chat has at most one draft at a time
BIGGEST = 20 * 1024 * 1024  # the size in bytes of the largest file that the server delivers
REACTIONS = frozenset(str(emoji.value) for emoji in ReactionEmoji)


class TelegramCarrier:
    """Sends messages as a bot; see `Carrier`.

    Telegram cannot recognise a repeated message. So after an attempt without an answer, `send` looks for the message
    under the next ids. It tries to edit the message of each id: Telegram lets a bot edit only its own messages.

    Args:
        bot: The bot.
        rate: The maximum number of messages per second.
        drafts: Whether `show_work` shows the words so far in private chats.
    """

    longest: int = MessageLimit.MAX_TEXT_LENGTH
    longest_caption: int = MessageLimit.CAPTION_LENGTH

    def __init__(self, bot: Bot, rate: float, drafts: bool) -> None:
        self._bot = bot
        self._drafts = drafts
        self.rate = rate
        self.current = asyncio.Event()
        """An event that is set as soon as the bot has the messages that came before its start."""
        # The known message ids. Key: a chat that numbers its messages itself, or "" for the bot's common numbering.
        self._ids: defaultdict[str, deque[int]] = defaultdict(lambda: deque(maxlen=KNOWN))

    def note(self, chat: str, id: str) -> None:
        """Note the id of a message that the bot has received or sent."""
        if id.isdecimal():
            self._ids[_numbering(chat)].append(int(id))

    def trace(self, chat: str) -> str:
        """Return the newest known message id; an empty text if none is known. Call this before an attempt."""
        return str(max(self._ids[_numbering(chat)], default=""))

    def can_react(self, emoji: str) -> bool:
        """Return whether Telegram accepts this emoji as a reaction."""
        return emoji in REACTIONS or emoji.replace("\ufe0f", "") in REACTIONS

    async def send(self, message: Outgoing, again: bool) -> str:
        """Send a message, unless an earlier attempt has sent it; return its id."""
        with _delivery():
            if again and message.kind in ("text", "voice", "picture"):
                found = await self._find(message)
                if found:
                    return found
            id = str(await self._send(message))
        self.note(message.chat, id)
        return id

    async def _send(self, message: Outgoing) -> int:
        bot, chat, text = self._bot, message.chat, message.text
        if message.kind == "reaction":
            emoji = text if text in REACTIONS else text.replace("\ufe0f", "")
            await bot.set_message_reaction(chat, int(message.to), ReactionTypeEmoji(emoji))
            return int(message.to)
        if message.kind == "edit":
            try:
                await bot.edit_message_text(text, chat, int(message.to))
                return int(message.to)
            except BadRequest as error:
                if "not modified" in error.message:
                    return int(message.to)
        if message.kind == "delete":
            try:
                await bot.delete_message(chat, int(message.to))
            except BadRequest as error:
                if "not found" not in error.message:
                    raise
            return int(message.to)
        reply, topic = None, int(message.topic) if message.topic else None
        if message.to and message.kind != "edit":
            reply = ReplyParameters(int(message.to), allow_sending_without_reply=True)
        place: dict[str, Any] = {"reply_parameters": reply, "message_thread_id": topic}
        if message.kind == "picture":
            return (await bot.send_photo(chat, message.data, caption=text, **place)).message_id
        if message.kind == "voice":
            return (await bot.send_voice(chat, message.data, caption=text, **place)).message_id
        return (await bot.send_message(chat, text, **place)).message_id

    async def _find(self, message: Outgoing) -> str | None:
        """Look for a message that an earlier attempt may have sent. Return its id; None if it is not found."""
        if not message.trace:
            return None
        await self.current.wait()
        known = self._ids[_numbering(message.chat)]
        id, left = int(message.trace), AHEAD
        while left > 0:
            id += 1
            if id in known:  # the id of another message
                continue
            left -= 1
            try:
                await self._bot.edit_message_reply_markup(message.chat, id)
            except BadRequest as error:
                if "not modified" in error.message:  # the bot's own message in this chat, newer than the trace
                    return str(id)
            except InvalidToken:  # a server without this method
                return None
        return None

    async def fetch(self, file: str) -> bytes:
        """Return the bytes of a file."""
        with _delivery():
            found = await self._bot.get_file(file)
            if (found.file_size or 0) > BIGGEST:
                raise DeliveryError("the file is too big", final=True)
            return bytes(await found.download_as_bytearray())

    async def show_work(self, chat: str, words: str) -> None:
        """Show in the chat that the agent is writing. In a private chat with drafts, show the words so far instead.

        Telegram removes a draft when the next message comes, or after 30 s.
        """
        with _delivery():
            if words and self._drafts and not chat.startswith("-"):
                try:
                    await self._bot.send_message_draft(int(chat), DRAFT, words[: self.longest], read_timeout=SHOWN)
                    return
                except BadRequest:
                    pass
                except InvalidToken:  # an older server, without this method
                    self._drafts = False
            await self._bot.send_chat_action(chat, ChatAction.TYPING)


def _numbering(chat: str) -> str:
    """Return the key of the numbering of a chat's messages. Each supergroup and channel has its own numbering."""
    return chat if chat.startswith("-100") else ""


@contextlib.contextmanager
def _delivery() -> Generator[None]:
    """Turn the errors of Telegram into a `DeliveryError`."""
    try:
        yield
    except FloodError as error:
        raise DeliveryError(error.message, wait=error.seconds) from None
    except ChatMigrated as error:
        raise DeliveryError("the group has another id", moved=str(error.new_chat_id)) from None
    except Forbidden as error:
        raise DeliveryError(error.message, gone=True) from None
    except BadRequest as error:
        gone = "chat not found" in error.message.casefold()
        raise DeliveryError(error.message, final=True, gone=gone) from None
    except InvalidToken:
        raise DeliveryError("Telegram refuses the token, or does not know the method", wait=30.0) from None
    except TelegramError as error:
        unsure = not isinstance(error.__cause__, UNSENT)
        reason = "no answer in time" if isinstance(error, TimedOut) else error.message
        raise DeliveryError(reason, unsure=unsure) from None
    except (TimeoutError, TypeError, KeyError, ValueError) as error:  # an answer that cannot be read
        raise DeliveryError(f"the answer is malformed: {type(error).__name__}", unsure=True) from None
