"""Questions for advice, a favour or an opinion. The user's own words do not answer them."""

from __future__ import annotations

import re

_ADVICE = re.compile(
    r"\bhow (?:do|can|could|would|might) (?:i|we)\b|\b(?:should|shall|ought|may|might|can|could) (?:i|we)\b(?! not)"
    r"|\b(?:do|would) you think\b",
    re.IGNORECASE,
)
_HELP = re.compile(
    r"\b(?:do|would) (?:i|we)\b(?! not)|\b(?:i|we) (?:should|ought|could)\b"
    r"|\b(?:do|would|are|can|could|will) you\b(?! (?:still )?(?:remember|recall|know|tell))",
    re.IGNORECASE,
)


def asks_for_advice(text: str) -> bool:
    """Return whether a text asks for advice or an opinion: *how do I ask her?*, *what do you think?*.

    A question such as *what may I not eat?* asks for something that the user has told.
    """
    return _ADVICE.search(text) is not None


def may_ask_for_help(question: str) -> bool:
    """Return whether a question may ask for advice, an opinion or a favour: *can you call me?*, *what do I need?*.

    The second example may also ask for a fact that the user has told.
    """
    return asks_for_advice(question) or _HELP.search(question) is not None
