"""The history of a conversation: its last messages, and how much of them the visitor heard."""

from __future__ import annotations

import itertools
from collections import deque
from collections.abc import Iterator
from dataclasses import replace
from typing import Literal

from .frames import Heard, Message

Speaker = Literal["user", "agent"]

MESSAGES = 500  # the maximum number of messages that a history keeps
CHARACTERS = 200_000  # the maximum number of characters that a history keeps
# A mark says how much of a message the visitor heard. Windows that lag behind get the marks that they missed.
MARKS = 32  # the maximum number of marks that a history keeps


class History:
    """The last messages of a conversation, bounded in number and in size."""

    def __init__(self, *, messages: int = MESSAGES, characters: int = CHARACTERS) -> None:
        self._messages: deque[Message] = deque()
        self._most = messages
        self._characters = characters
        self._size = 0
        self._marks: deque[Heard] = deque(maxlen=MARKS)
        self.marked = 0
        """How many marks there have been so far."""
        self.last = 0
        """The number of the newest message; 0 before the first message."""

    @property
    def first(self) -> int:
        """The number of the oldest message. If there are no messages, the number that the next message will get."""
        return self.last - len(self._messages) + 1

    def newest(self, speaker: Speaker) -> Message | None:
        """Return the newest message of a speaker, or None."""
        return next((message for message in reversed(self._messages) if message.speaker == speaker), None)

    def add(self, speaker: Speaker, text: str, time: int, id: str | None = None) -> Message:
        """Add a message, and return it. Cut a text that is longer than `characters`.

        `time` is in milliseconds since 1970.
        """
        text = text[: self._characters]
        self.last += 1
        message = Message(self.last, speaker, text, time, id)
        self._messages.append(message)
        self._size += len(text)
        while len(self._messages) > self._most or self._size > self._characters:
            self._size -= len(self._messages.popleft().text)
        return message

    def mark(self, message: Message, heard: str) -> None:
        """Note which part of a kept message the visitor heard."""
        place = message.n - self.first
        if 0 <= place < len(self._messages):
            self._messages[place] = replace(message, heard=None if heard == message.text else heard)
            self._marks.append(Heard(message.n, heard))
            self.marked += 1

    def marks_since(self, number: int) -> list[Heard]:
        """Return the marks that came after the first `number` marks and are still kept."""
        new = self.marked - number
        return list(self._marks)[-new:] if new > 0 else []

    def recent(self, speaker: Speaker, most: int) -> list[Message]:
        """Return the newest messages of a speaker (at most `most`), the newest first."""
        said = (message for message in reversed(self._messages) if message.speaker == speaker)
        return list(itertools.islice(said, most))

    def since(self, number: int) -> Iterator[Message]:
        """Yield the kept messages with numbers greater than `number`, in order, even those added during the iteration."""
        while number < self.last:
            number = max(number + 1, self.first)
            yield self._messages[number - self.first]
