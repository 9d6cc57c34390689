"""The history of a conversation: its last messages, with their numbers."""

from __future__ import annotations

from collections import deque
from collections.abc import Iterator
from typing import Literal

from .protocol import Message

Speaker = Literal["user", "agent"]

MESSAGES = 500  # the maximum number of messages that a history keeps
CHARACTERS = 200_000  # the maximum number of characters that a history keeps


class History:
    """The last messages of a conversation, bounded in number and in size.

    Example:
        >>> history = History(messages=2)
        >>> for text in ("one", "two", "three"):
        ...     _ = history.add("user", text, 0)
        >>> [message.n for message in history.since(0)]
        [2, 3]
    """

    def __init__(self, *, messages: int = MESSAGES, characters: int = CHARACTERS) -> None:
        self._messages: deque[Message] = deque()
        self._most = messages
        self._characters = characters
        self._size = 0
        self.last = 0
        """The number of the newest message; 0 before the first."""

    @property
    def first(self) -> int:
        """The number of the oldest message. While there is none, the number that the next message will get."""
        return self.last - len(self._messages) + 1

    def newest(self, speaker: Speaker) -> Message | None:
        """Return the newest message of a speaker, or None."""
        return next((message for message in reversed(self._messages) if message.speaker == speaker), None)

    def add(self, speaker: Speaker, text: str, time: int, id: str | None = None) -> Message:
        """Add a message, and return it; `time` is in milliseconds since 1970. A text longer than a history is cut."""
        text = text[: self._characters]
        self.last += 1
        message = Message(self.last, speaker, text, time, id)
        self._messages.append(message)
        self._size += len(text)
        while len(self._messages) > self._most or self._size > self._characters:
            self._size -= len(self._messages.popleft().text)
        return message

    def since(self, number: int) -> Iterator[Message]:
        """Yield the messages with numbers greater than `number`, in order, including those added meanwhile."""
        while number < self.last:
            number = max(number + 1, self.first)
            yield self._messages[number - self.first]
