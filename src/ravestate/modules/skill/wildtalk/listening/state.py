"""The memory of the listener (the part that chooses the agent's reply) in a conversation."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace

from .grave import is_crisis

RECENT = 40
"""The number of latest phrases that the agent does not repeat."""
DANGER = 5
"""The number of turns, after words of danger, for which the user counts as in danger."""
LASTING = 2
"""The number of turns for which a tone usually lasts; `tones` has longer times for feelings."""

_OPEN = frozenset(("who", "what", "what's", "when", "where", "why", "which", "how", "whose", "or"))


@dataclass(frozen=True, slots=True)
class Pending:
    """An open question of the agent, with the reactions to the user's answer."""

    text: str
    then: Mapping[str, tuple[str, ...]] = field(default_factory=dict[str, tuple[str, ...]])
    """The kind of the user's answer (``yes``, ``no``, ``unsure`` or ``any``) → the agent's reactions to it."""
    start: str = ""
    """The kind of performance that begins if the user answers yes."""

    @property
    def closed(self) -> bool:
        """Whether the question can be answered with yes or no."""
        words = self.text.replace(",", " ").split(". ")[-1].split("! ")[-1].split("? ")[-1].lower().split()
        return not any(word in _OPEN for word in words[:3])


@dataclass(frozen=True, slots=True)
class Overheard:
    """The tone of an utterance, kept even if another module answers."""

    text: str
    tone: str = ""
    lasts: int = LASTING


@dataclass(frozen=True, slots=True)
class Game:
    """A game in progress."""

    kind: str
    """``riddle``, ``chain``, ``animal``, ``holder``, ``knock`` or ``play``; `wishes.Wish` explains them."""
    word: str = ""
    """The riddle's question, the last word of the chain, the last question about the user's animal, or the agent's animal.
    In a knock-knock joke, it is the name at the door."""
    used: tuple[str, ...] = ()
    turn: int = 0
    asides: int = 0
    """The number of the latest answers in a row that did not belong to the game."""

    def beside(self, answer: str) -> Game | None:
        """Return the game after an answer that does not belong to it; None if the game ends.

        A second such answer in a row ends the game, and so does an answer that is a question.
        """
        return None if self.asides or answer.endswith("?") else replace(self, asides=1)


@dataclass(frozen=True, slots=True)
class State:
    """The state of the listener. Immutable; each answer makes a new one."""

    recent: tuple[str, ...] = ()
    """The templates of the last phrases, with their placeholders not filled, oldest first."""
    said: tuple[str, ...] = ()
    """The last answers, oldest first."""
    before: str = ""
    """The user's previous utterance."""
    pending: Pending | None = None
    tone: str = ""
    turns: int = 0
    """The number of turns for which the tone still lasts."""
    danger: int = 0
    """The number of turns for which the user may still be in danger."""
    stances: Mapping[str, str] = field(default_factory=dict[str, str])
    """The agent's opinions. It chooses each opinion once, and then keeps it."""
    game: Game | None = None
    shown: tuple[str, ...] = ()
    """The jokes, songs, stories and riddles that the agent has performed in this conversation."""
    options: tuple[str, str] | None = None
    """The options that the user named last."""
    show: str = ""
    """The kind of the latest performance."""
    asked: tuple[str, str] | None = None
    """The kind and the area of the user's last question that was answered by kind and area. If the user then asks for
    *something else*, the answer has the same kind and area."""
    asks: bool = True
    """Whether the listener may ask questions. False after the user has asked for no more questions."""

    def toned(self, tone: str, lasts: int = LASTING) -> State:
        """Return the state after an utterance with this tone. While sadness lasts, no other tone replaces it."""
        left = max(0, self.turns - 1)
        if tone and (self.tone != "sad" or tone == "sad" or not left):
            return replace(self, tone=tone, turns=max(lasts, left) if tone == self.tone else lasts)
        return replace(self, tone=self.tone if left else "", turns=left)

    def warned(self, text: str) -> State:
        """Return the state after an utterance, which may have words of danger."""
        return replace(self, danger=DANGER if is_crisis(text) else max(0, self.danger - 1))

    def having_said(self, template: str, text: str) -> State:
        """Return the state after the agent's answer."""
        return replace(self, recent=(*self.recent, template)[-RECENT:], said=(*self.said, text)[-RECENT:])
