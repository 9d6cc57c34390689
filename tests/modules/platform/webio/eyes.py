"""An agent for tests of the camera on a page. It asks for pictures of the visitor's camera."""

from __future__ import annotations

import ravestate as rs
from ravestate.modules import rawio

JPEG = b"\xff\xd8\xff\xe0 a picture"
"""Data that begins like a JPEG picture."""

eyes = rs.Module("eyes", requires=(rawio,))
glance = eyes.signal("glance", input=True)
"""The signal that makes the agent ask for a picture."""
pictures: rs.Slot[tuple[bytes | None, ...]] = eyes.slot("pictures", ())
"""The pictures that the agent has received; None if the camera went off meanwhile."""


@eyes.rule(when=glance.max_age(None), reads=rawio.camera, writes=pictures, detached=True, background=True)
async def look(ctx: rs.RuleContext) -> rs.Resign | None:
    """Ask for one picture, and mark two faces in it."""
    camera = ctx[rawio.camera]
    if camera is None:
        return rs.Resign("the camera is off")
    ctx[pictures] = (*ctx[pictures], await camera.next())
    camera.mark([rawio.Face((0.25, -0.1, 0.5, 0.5), "Anna"), rawio.Face((0.9, 0.0, 0.2, 0.2))])
    return None
