"""An agent that takes pictures of the visitor's camera, for tests of the camera on a page."""

from __future__ import annotations

import ravestate as rs
from ravestate.modules import rawio

JPEG = b"\xff\xd8\xff\xe0 a picture"
"""The beginning of a JPEG."""

eyes = rs.Module("eyes", requires=(rawio,))
glance = eyes.signal("glance", input=True)
"""Take a picture."""
pictures: rs.Slot[tuple[bytes | None, ...]] = eyes.slot("pictures", ())
"""The pictures that the agent has taken; None for a camera that was off."""


@eyes.rule(when=glance.max_age(None), reads=rawio.camera, writes=pictures, detached=True, background=True)
async def look(ctx: rs.RuleContext) -> rs.Resign | None:
    """Take one picture, and show two faces in it."""
    camera = ctx[rawio.camera]
    if camera is None:
        return rs.Resign("the camera is off")
    ctx[pictures] = (*ctx[pictures], await camera.next())
    camera.mark([rawio.Face((0.25, -0.1, 0.5, 0.5), "Anna"), rawio.Face((0.9, 0.0, 0.2, 0.2))])
    return None
