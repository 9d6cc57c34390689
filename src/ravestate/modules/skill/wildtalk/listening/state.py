"""The memory of the listener in a conversation."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace

RECENT = 40
"""The number of latest phrases that are not said again."""
LASTING = 2
"""The number of turns for which a tone lasts."""

_OPEN = frozenset(("who", "what", "what's", "when", "where", "why", "which", "how", "whose", "or"))


@dataclass(frozen=True, slots=True)
class Being:
    """A person or an animal that was mentioned."""

    text: str
    """From the agent's view: ``your mother``, ``Rex``."""
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
    """By ``yes``, ``no``, ``unsure`` and ``any``."""
    start: str = ""
    """The joke, riddle... that a *yes* begins."""

    @property
    def closed(self) -> bool:
        """Whether the question can be answered with yes or no."""
        words = self.text.replace(",", " ").split(". ")[-1].split("! ")[-1].split("? ")[-1].lower().split()
        return not any(word in _OPEN for word in words[:3])


@dataclass(frozen=True, slots=True)
class Overheard:
    """The traces of an utterance, kept even if another module answers it."""

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


@dataclass(frozen=True, slots=True)
class State:
    """The state of the listener. Immutable; each answer makes a new one."""

    recent: tuple[str, ...] = ()
    """The last phrases, before their roles were filled, oldest first."""
    said: tuple[str, ...] = ()
    """The last answers, oldest first."""
    before: str = ""
    """The user's previous utterance."""
    moment: str = ""
    """The feeling or moment of the last answer."""
    pending: Pending | None = None
    being: Being | None = None
    tone: str = ""
    turns: int = 0
    """The number of turns for which the tone still lasts."""
    stances: Mapping[str, str] = field(default_factory=dict[str, str])
    """The agent's opinions, each chosen once."""
    game: Game | None = None
    shown: tuple[str, ...] = ()
    """The jokes, songs, stories and riddles of this talk."""
    show: str = ""
    """The kind of the latest performance."""
    asks: bool = True
    """Whether the listener may ask questions. It may not once the user wants none."""

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
