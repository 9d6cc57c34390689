"""The module persqa: its settings, slots and signals."""

from __future__ import annotations

from typing import Annotated

from pydantic import AfterValidator, Field

import ravestate as rs
from ravestate.errors import nearest
from ravestate.modules import idle, interloc, nlp, ontology, rawio, verbaliser
from ravestate.modules.meta.verbaliser.intents import Intent

from .acquaintance import Noted
from .talk import Talk
from .told import Told
from .topics import ASKED


def _known(topics: tuple[str, ...]) -> tuple[str, ...]:
    for name in topics:
        if name not in ASKED:
            raise ValueError(f"there is no topic {name!r}{nearest(name, ASKED)}; the topics are {', '.join(ASKED)}")
    return topics


class Settings(rs.Settings):
    """The topics and the pace of the agent's questions."""

    topics: Annotated[tuple[str, ...], AfterValidator(_known)] = ASKED
    """Topics to ask about, in this order. If the user mentions other topics, the agent learns about them too."""
    gap: Annotated[float, Field(ge=0)] = 180.0
    """The least number of seconds between two questions that the agent asks in silences."""
    turns: Annotated[int, Field(ge=0)] = 3
    """Until the user has spoken this many times, the agent asks only for their name."""
    within: Annotated[float, Field(gt=0)] = 90.0
    """Seconds for which a question waits for its answer."""
    confirm: bool = True
    """Whether a user who gives a name that memory already knows must answer a question, to prove that they are this
    person."""
    ignored: Annotated[int, Field(ge=1)] = 2
    """After this many unanswered questions in a row, the agent asks nothing until the user speaks."""


module = rs.Module("persqa", requires=[rawio, nlp, ontology, verbaliser, interloc, idle], settings=Settings)

who: rs.Slot[ontology.Node | None] = module.slot("who", None, type=ontology.Node)
"""The user's node in memory; None while their name is not known."""

facts: rs.Collection[tuple[str, ...]] = module.collection("facts")
"""Values by topic (``home``, ``hobby``, ...); an empty tuple means that the user has none."""

told: rs.Collection[Told] = module.collection("told")
"""The user's free statements, which belong to no topic, oldest first: *Jonas plays the violin*."""

talk: rs.Slot[Talk] = module.slot("talk", Talk(), type=Talk)
"""The state of the conversation about the user, such as the open question, and the topics that the user refused."""

reply = module.signal("reply", payload=Intent)
"""The user has told or asked something about themselves; the payload is the reply."""

noted = module.signal("noted", payload=Noted)
"""Memory has looked up the user or saved facts about them, or has failed to."""

forgotten = interloc.forgotten
"""Persqa has forgotten the user, so other modules delete the user's data as well. This is a signal of `interloc`."""
