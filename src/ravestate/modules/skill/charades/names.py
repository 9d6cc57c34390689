"""The names of `charades`: its settings, its module, its signals and slots."""

from __future__ import annotations

from typing import Annotated

from pydantic import Field

import ravestate as rs
from ravestate.modules import activity, agenda, emotion, idle, interloc, nlp, rawio, verbaliser

from .game import Game
from .understanding import Move

Seconds = Annotated[float, Field(gt=0)]


class Settings(rs.Settings):
    """The pace of the game."""

    watch: Seconds = 3.0
    """Seconds for which the agent watches."""
    count: Seconds = 1.0
    """Seconds from one number of the countdown to the next."""
    patience: Seconds = 12.0
    """Seconds of silence after which the agent asks again. After a second silence of this length, it ends the game."""
    aside: Seconds = 4.0
    """Seconds from the user's remark on something else until the agent returns to the game."""


module = rs.Module(
    "charades",
    requires=[rawio, nlp, verbaliser, emotion, activity, agenda, idle, interloc],
    settings=Settings,
)

game: rs.Slot[Game] = module.slot("game", Game(), type=Game)
"""The state of the game, with the score."""

sightings: rs.Slot[tuple[tuple[bool, activity.Activity], ...]] = module.slot("sightings", ())
"""The activities recognised in this round, each with a flag: true while watching, false during the countdown."""

gestures: rs.Slot[frozenset[str]] = module.slot("gestures", frozenset(), type=frozenset, input=True)
"""The activities that the agent's body can perform. A platform with a body writes this slot."""

perform: rs.Signal[str] = module.signal("perform", payload=str)
"""The agent's body must perform an activity for the user to guess. The payload is a name in `gestures`."""

moved: rs.Signal[Move] = module.signal("moved", payload=Move)
"""The user's words are a move in the game."""

invited: rs.Signal[Move] = module.signal("invited", payload=Move)
"""The user wants to play something, or is bored."""

strayed: rs.Slot[float] = module.slot("strayed", 0.0, always=True)
"""The time at which the user last said something other than a move during a game (seconds since the context began)."""

prompted: rs.Signal[int] = module.signal("prompted", payload=int, keep="latest")
"""The agent waits for the user's next move. The payload is `Game.turn`, the number of moves and other transitions so far."""

counted: rs.Signal[None] = module.signal("counted")
"""The countdown may begin."""

called: rs.Signal[int] = module.signal("called", payload=int)
"""The agent says the last word of the countdown by voice. The payload is `Game.turn` at that time."""

spoken: rs.Signal[None] = module.signal("spoken")
"""The user has heard all that the agent has said."""

gone: rs.Signal[int] = module.signal("gone", payload=int)
"""The countdown is over. The payload is `Game.turn` at that time."""

watched: rs.Signal[None] = module.signal("watched")
"""The agent has watched, and may guess."""

abandoned: rs.Signal[None] = module.signal("abandoned")
"""The user says goodbye, or ignores the offer. The game ends without a word."""

begun: rs.Signal[None] = module.signal("begun")
"""A game begins."""

declined: rs.Signal[None] = module.signal("declined")
"""The user does not want to play."""
