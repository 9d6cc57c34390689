"""Small talk about the user: asks who he is, remembers it, and knows it when he comes back."""

from __future__ import annotations

from typing import Annotated

from pydantic import AfterValidator, Field

import ravestate as rs
from ravestate.errors import nearest
from ravestate.modules import idle, interloc, nlp, ontology, rawio, verbaliser
from ravestate.modules.meta.verbaliser.intents import Intent

from .acquaintance import Noted
from .talk import Talk
from .topics import ASKED


def _known(topics: tuple[str, ...]) -> tuple[str, ...]:
    for name in topics:
        if name not in ASKED:
            raise ValueError(
                f"there is no topic {name!r}{nearest(name, ASKED)}; there are {', '.join(ASKED)}"
            )
    return topics


class Settings(rs.Settings):
    """What is asked, and how insistently."""

    topics: Annotated[tuple[str, ...], AfterValidator(_known)] = ASKED
    """What to ask about, in this order. What the user tells of his own accord is learnt in any case."""
    gap: Annotated[float, Field(ge=0)] = 30.0
    """Seconds that a question is left to the user before the next one."""
    within: Annotated[float, Field(gt=0)] = 90.0
    """Seconds for which a question waits for its answer."""
    ignored: Annotated[int, Field(ge=1)] = 2
    """After so many questions that the user has left without a word, none is asked until he speaks."""


module = rs.Module("persqa", requires=[rawio, nlp, ontology, verbaliser, interloc, idle], settings=Settings)

who: rs.Slot[ontology.Node | None] = module.slot("who", None, type=ontology.Node)
"""The user, as memory has him; None as long as his name is not known."""

facts: rs.Collection[tuple[str, ...]] = module.collection("facts")
"""What is known of him: values by topic (``home``, ``hobby``, ...); an empty tuple means that there are none."""

talk: rs.Slot[Talk] = module.slot("talk", Talk(), type=Talk)
"""How the talk about him stands: what was asked, and what he would rather not say."""

reply = module.signal("reply", payload=Intent)
"""The user has told or asked something about himself; with what to say to it."""

noted = module.signal("noted", payload=Noted)
"""Memory has been asked about the user, or has written down what he told."""
