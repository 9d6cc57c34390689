"""The records that pass between a messenger and its chats, and the error of a failed delivery."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal, Protocol

from ravestate.errors import PlatformError


@dataclass(frozen=True, slots=True)
class Person:
    """A person on a messenger: their id, and their name (None if they have none)."""

    id: str
    name: str | None = None


Said = Literal["text", "picture", "voice", "command", "edit", "reaction", "left"]
"""The kinds of incoming messages. ``left`` means that the agent is no longer in the chat."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Incoming:
    """A message from a messenger to the agent.

    Attributes:
        key: The id of the event on the messenger. `Room` (all chats of the agent) ignores a message with a known key.
        chat: The id of the chat.
        id: The id of the message; for an ``edit`` or a ``reaction``, the id of the message that it concerns. `Room`
            ignores a reaction to a message that the agent did not write.
        person: The person who sent the message.
        kind: The kind of the message.
        text: The words, the caption of a picture, the emoji of a reaction, or a command's name without a slash.
        file: The reference with which `Carrier.fetch` gets a picture or a voice note.
        group: Whether several people may be in the chat.
        topic: The id of the message's topic, if the messenger divides the chat into topics; else empty.
        aliases: Other names of the sender and of the chat, for the setting `allow`.
    """

    key: str
    chat: str
    id: str
    person: Person
    kind: Said = "text"
    text: str = ""
    file: str = ""
    group: bool = False
    topic: str = ""
    aliases: tuple[str, ...] = ()


Sent = Literal["text", "picture", "voice", "edit", "delete", "reaction"]
"""The kinds of outgoing messages. A `Carrier` gets a ``voice`` message with its sound, or as ``text`` if there is no
sound. A carrier gets an ``edit`` or a ``delete`` only after an incoming ``edit``."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Outgoing:
    """A message from the agent to a messenger.

    Attributes:
        key: An id that survives a restart, for messengers that ignore a repeated id.
        chat: The id of the chat.
        kind: The kind of the message.
        text: The words, the caption of a picture, or the emoji of a reaction.
        to: The id of the message to edit, to delete, to react to or to reply to; empty if there is none.
        topic: The id of the topic of the answered message; empty if that message has no topic.
        data: The bytes of a picture, or of a voice note (Ogg with Opus).
        trace: The text that `Carrier.trace` returned before the first attempt; empty if there is none.
    """

    key: str
    chat: str
    kind: Sent = "text"
    text: str = ""
    to: str = ""
    topic: str = ""
    data: bytes = b""
    trace: str = ""


class DeliveryError(PlatformError):
    """A message could not be delivered.

    Args:
        reason: The reason, for the log.
        wait: The seconds to wait before the next attempt, if the messenger has set a time; 0 otherwise.
        unsure: Whether the message may have arrived nevertheless, for example after a time-out.
        final: Whether every further attempt would fail, too.
        gone: Whether the chat is closed to the agent: the user has blocked the agent, or a group has removed it.
        moved: The chat's new id, if its id has changed; else empty.
    """

    def __init__(
        self,
        reason: str,
        *,
        wait: float = 0.0,
        unsure: bool = False,
        final: bool = False,
        gone: bool = False,
        moved: str = "",
    ) -> None:
        super().__init__(reason)
        self.wait = wait
        self.unsure = unsure
        self.final = final or gone
        self.gone = gone
        self.moved = moved


class Carrier(Protocol):
    """The connection to a messenger, which a platform implements and `Room` uses. All calls come on one event loop."""

    longest: int
    """The maximum number of characters in a message; longer texts are sent as several messages."""
    longest_caption: int
    """The maximum number of characters below a picture or a voice note; the remaining words follow in further messages."""
    rate: float
    """The maximum number of messages per second, over all chats."""

    async def send(self, message: Outgoing, again: bool) -> str:
        """Send a message, and return its id on the messenger. For an ``edit``, return the id to name in the next edit.

        Args:
            message: The message.
            again: Whether an earlier attempt may have delivered the message. If the message has arrived, do not send it
                again.

        Raises:
            DeliveryError: The message was not sent, or the carrier does not know whether it was sent.
        """
        ...

    def trace(self, chat: str) -> str:
        """Return a text to store before the first attempt to send a message to a chat.

        If the messenger does not answer that attempt, the text helps a later `send` to find out whether the message
        arrived.
        """
        ...

    async def fetch(self, file: str) -> bytes:
        """Return the bytes of a picture or a voice note. Raise a `DeliveryError` if that fails."""
        ...

    async def show_work(self, chat: str, words: str) -> None:
        """Show in the chat for some seconds that the agent is writing.

        Args:
            chat: The id of the chat.
            words: The answer so far, or an empty text. A carrier may show the words only if they do not stay in the chat.

        Raises:
            DeliveryError: The request has failed.
        """
        ...

    def can_react(self, emoji: str) -> bool:
        """Return whether the text `emoji` is one emoji that the messenger accepts as a reaction.

        The text may be any answer of the agent.
        """
        ...
