"""The conversation so far, and the prompt that is made from it."""

from __future__ import annotations

import re
from collections import deque
from collections.abc import Iterable

from ravestate.language.chat import Message
from ravestate.modules._text import printable

PERSONA = (
    "You are {name}, a friendly robot. You make small talk in short, simple sentences. You never state facts about the "
    "world; if you are asked for one, you say that you do not know."
)
"""The default of the setting `persona`; ``{name}`` stands for the setting `name`."""

EXAMPLES = (
    ("Hello!", "Hello! It is nice to see you. How are you?"),
    ("I'm fine, and you?", "I'm doing well, thank you! What would you like to talk about?"),
)
"""The default of the setting `examples`."""

# The strings that mark the speaker in chat templates. A user who types them could pretend to be the system.
_MARKERS = re.compile(
    r"<\|[^|<>\n]{0,40}\|>|</?s>|\[/?INST\]|<</?SYS>>|</?(?:start|end)_of_turn>|</?think>", re.IGNORECASE
)
_CUT = "…"

NOTES = 1000
"""The maximum number of characters of notes in a prompt."""


class History:
    """The last turns of one conversation, up to a maximum length.

    A turn is an utterance of the user with its answer.

    Example:
        >>> history = History()
        >>> for role, text in ("user", "Hello!"), ("assistant", "Hi, how are you?"), ("user", "Fine."):
        ...     history.add(Message(role, text))
        >>> [message.text for message in history.prompt("You are {name}.", "Rosie")]
        ['You are Rosie.', 'Hello!', 'Hi, how are you?', 'Fine.']
    """

    def __init__(self, *, turns: int = 6, characters: int = 4000) -> None:
        """Make an empty history.

        Args:
            turns: The maximum number of turns, including the turn to be answered; at least 1.
            characters: The maximum number of characters (about 4 make a token). If there are more, the oldest utterances
                are left out. If the newest utterance alone is too long, it is cut.
        """
        if turns < 1 or characters < 1:
            raise ValueError(f"turns and characters must be at least 1, not {turns} and {characters}")
        self._turns = turns
        self._characters = characters
        self._messages: deque[Message] = deque()

    def add(self, message: Message) -> None:
        """Add a message."""
        message = Message(message.role, self._clean(message.text))
        if not message.text:
            return
        if self._messages and self._messages[-1].role == message.role:
            # Two messages of one speaker in a row become one message.
            last = self._messages.pop()
            message = Message(message.role, f"{last.text} {message.text}"[-2 * self._characters :])
        self._messages.append(message)
        while sum(m.role == "user" for m in self._messages) > self._turns:
            self._messages.popleft()
            while self._messages and self._messages[0].role != "user":
                self._messages.popleft()

    def prompt(
        self,
        persona: str = PERSONA,
        name: str = "Ravestate",
        examples: Iterable[tuple[str, str]] = (),
        notes: Iterable[str] = (),
    ) -> tuple[Message, ...]:
        """Return the prompt: the persona with the notes, the examples, and the history, oldest first.

        `notes` are sentences about the user and the situation. Notes that do not fit into `NOTES` characters are left
        out. The user begins, and the speakers alternate strictly, because several templates demand this.
        """
        left = self._characters
        kept: list[Message] = []
        for message in reversed(self._messages):
            if len(message.text) > left:
                break
            left -= len(message.text)
            kept.append(message)
        if not kept and self._messages:
            newest = self._messages[-1]
            kept = [Message(newest.role, newest.text[: self._characters - 1] + _CUT)]
        kept.reverse()
        if kept and kept[0].role == "assistant":
            kept.insert(0, Message("user", "Hello."))
        shown: list[Message] = []
        for utterance, answer in examples:
            shown += Message("user", utterance), Message("assistant", answer)
        system = persona.replace("{name}", name)
        left = NOTES
        for note in map(self._clean, notes):
            if len(note) <= left:
                left -= len(note)
                system += f"\n{note}"
        return (Message("system", system), *shown, *kept)

    def _clean(self, text: str) -> str:
        # A user may paste a book, so drop most of an overlong text before the slow steps.
        text = text[: max(1000, 4 * self._characters)]
        return " ".join(_MARKERS.sub(" ", printable(text)).split())
