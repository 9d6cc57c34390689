"""Choose the move that a good listener makes next: rejoice, console, advise..."""

from __future__ import annotations

from dataclasses import dataclass

from .classifier import Classifier

UNLIKELY = 0.3
"""The factor of a move that does not suit the form: a move of `TOLD` after a question, of `ASKED` after a statement."""
ASKED = ("fact", "self", "opinion", "recall")
"""Moves that answer a question."""
TOLD = ("interest", "accept", "rejoice", "mourn", "greet", "introduce")
"""Moves that answer no question."""
LISTENING = (*TOLD, "console", "apologise", "farewell", "thank")
"""Moves of a listener after a statement of the user."""
SURE = 0.75
"""The least confidence at which a move is sure."""
_MOVES = Classifier("moves")


@dataclass(frozen=True, slots=True)
class Move:
    """The next move of a listener."""

    name: str
    """One of these names:

    - ``interest``: take up what the user has told
    - ``accept``: nod
    - ``rejoice``, ``console``, ``mourn``, ``greet``, ``farewell``
    - ``apologise``: for a mistake of the agent
    - ``explain``: repeat the agent's last words more simply
    - ``fact``: answer a question about the world
    - ``self``: answer a question about the agent
    - ``opinion``: say what the agent thinks
    - ``advice``: say what the user should do
    - ``recall``: say what the user told the agent before
    - ``test``: answer a trick: a riddle, a false claim, an order to the model
    - ``entertain``: tell a joke or a story, or play a game
    - ``obey``: be quiet, ask no questions, or answer more briefly
    - ``introduce``: answer users who say who they are
    - ``thank``: answer thanks and praise
    """
    score: float
    """The confidence, 0 to 1."""
    second: str = ""
    """The next best move."""

    @property
    def sure(self) -> bool:
        """Whether the move is sure. If it is not, the answer should suit the second move as well."""
        return self.score >= SURE

    @property
    def listens(self) -> bool:
        """Whether the move is sure, and suits a statement. If so, modules should not look for facts."""
        return self.sure and self.name in LISTENING


def move_of(text: str, *, asks: bool) -> Move | None:
    """Return the move that answers an utterance; None until the network is loaded, and for a text without words.

    Args:
        text: The utterance in normal form.
        asks: Whether the utterance asks something.
    """
    if not any(map(str.isalnum, text)):
        return None
    unlikely = TOLD if asks else ASKED
    ranked = [(chance * (UNLIKELY if name in unlikely else 1), name) for name, chance in _MOVES.ranked(text)]
    if not ranked:
        return None
    (score, name), (_, second) = sorted(ranked, reverse=True)[:2]
    return Move(name, score / sum(chance for chance, _ in ranked), second)
