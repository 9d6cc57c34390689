"""The shape of a sentence: the persons that it mentions, and whether it asks. Only pronouns, question words and
auxiliary verbs count.

The sentences *what are my hobbies* and *what are your hobbies* have almost the same vector and spelling. Their shapes
differ.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from .contractions import word_set

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

WEIGHTS = (0.4, 0.4, 0.1, 0.1)
"""The weights of the features, which add up to 1: the agent, the user, other persons, the order of the words."""

_AGENT = word_set("you your yours yourself")
_USER = word_set("i me my mine myself we us our ours")
_OTHERS = word_set("he him his she her hers it its they them their theirs")
_QUESTION_WORDS = word_set("who whom whose what which where when why how")
_AUXILIARIES = word_set("do does did am is are was were have has had can could will would may might shall should must")


def shape(text: str) -> tuple[bool, bool, bool, int]:
    """Return features of a plain text: whether it mentions the agent, the user, others; and its word order.

    The first question word or auxiliary verb decides the word order: 2 for a question word, 1 for a verb without a
    pronoun directly before it, or else 0.

    Example:
        >>> shape("what are my hobbies"), shape("you have a father")
        ((False, True, False, 2), (True, False, False, 0))
    """
    words = text.split()
    known = set(words)
    mentioned = (not _AGENT.isdisjoint(known), not _USER.isdisjoint(known), not _OTHERS.isdisjoint(known))
    for index, word in enumerate(words):
        if word in _QUESTION_WORDS:
            return *mentioned, 2
        if word in _AUXILIARIES:
            inverted = index == 0 or words[index - 1] not in _AGENT | _USER | _OTHERS
            return *mentioned, 1 if inverted else 0
    return *mentioned, 0


def likeness(texts: NDArray[np.int8], others: NDArray[np.int8]) -> NDArray[np.float32]:
    """Compare the shapes of n texts, (n, 4), with the shapes of m other texts, (m, 4).

    Return an array (n, m): for each pair, the sum of the weights of the features that are equal.
    """
    import numpy as np

    likeness = np.zeros((len(texts), len(others)), dtype=np.float32)
    for feature, weight in enumerate(WEIGHTS):
        likeness += np.float32(weight) * (texts[:, None, feature] == others[None, :, feature])
    return likeness
