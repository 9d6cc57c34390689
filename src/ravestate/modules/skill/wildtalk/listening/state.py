"""The memory of the listener in a conversation."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace

RECENT = 40
"""The number of latest phrases that the agent does not repeat."""
LASTING = 2
"""The number of turns for which a tone lasts."""

_OPEN = frozenset(("who", "what", "what's", "when", "where", "why", "which", "how", "whose", "or"))


@dataclass(frozen=True, slots=True)
class Being:
    """A person or an animal that was mentioned."""

    text: str
    """The words for the being, from the agent's view: ``your mother``, ``Rex``."""
    kind: str = ""
    """``relative``, ``pet`` or ``person``."""
    gender: str = "n"
    """``f``, ``m`` or ``n``."""
    plural: bool = False


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
    """The tone of an utterance, and the person or animal that it mentions, kept even if another module answers."""

    text: str
    being: Being | None = None
    tone: str = ""
    lasts: int = LASTING


@dataclass(frozen=True, slots=True)
class Game:
    """A game in progress."""

    kind: str
    """``riddle``, ``chain``, ``animal``, ``knock`` or ``play``."""
    word: str = ""
    """The riddle's question, the last word of the chain, or the last question about the animal."""
    used: tuple[str, ...] = ()
    turn: int = 0
    asides: int = 0
    """The number of the last answers that did not belong to the game."""

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
    ground: str = ""
    """The user's last statement, from the agent's view. The agent names it as the reason for its advice."""
    moment: str = ""
    """The name of the feeling, or of the *moment* (a situation in a conversation), that the last answer was for."""
    thread: str = ""
    """The bank's entry that gave the last reply from the bank; empty after several answers from elsewhere."""
    away: int = 0
    """The number of answers since the last reply from the bank."""
    pending: Pending | None = None
    being: Being | None = None
    tone: str = ""
    turns: int = 0
    """The number of turns for which the tone still lasts."""
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
        """Return the state after an utterance with this tone. Anger and tiredness do not end sadness."""
        if self.tone == "sad" and tone in ("angry", "tired"):
            tone, lasts = "sad", self.turns
        if tone:
            return replace(self, tone=tone, turns=max(lasts, self.turns - 1) if tone == self.tone else lasts)
        left = max(0, self.turns - 1)
        return replace(self, tone=self.tone if left else "", turns=left)

    def having_said(self, template: str, text: str) -> State:
        """Return the state after the agent's answer."""
        return replace(self, recent=(*self.recent, template)[-RECENT:], said=(*self.said, text)[-RECENT:])
