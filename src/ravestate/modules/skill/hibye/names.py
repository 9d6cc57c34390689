"""The names of `hibye`: its module, its signals and its slots."""

from __future__ import annotations

import ravestate as rs
from ravestate.modules import idle, interloc, rawio, verbaliser

module = rs.Module("hibye", requires=[rawio, idle, interloc, verbaliser])

hello = module.signal("hello")
"""The user greets the agent, and says little else."""

goodbye = module.signal("goodbye")
"""The user says goodbye, and little else."""

parted: rs.Slot[float | None] = module.slot("parted", None)
"""The time when the agent last answered a goodbye, in seconds since the context began; None if it has not."""

greeted: rs.Slot[float | None] = module.slot("greeted", None)
"""The time of the agent's last greeting, in seconds since the context began; None if there was none."""

answered: rs.Slot[tuple[float, frozenset[str]] | None] = module.slot("answered", None)
"""The time of the agent's last answer to a greeting, and the keys of the users who were present then; None if there is
no such answer, or if a user has left since then."""
