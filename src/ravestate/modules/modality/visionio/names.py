"""The names of `visionio`: its settings, its module, its signals and slots."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, cast

from pydantic import Field

import ravestate as rs
from ravestate.modules import activity, idle, interloc, ontology, rawio, verbaliser
from ravestate.settings import NameOrPath

from .face import FaceVec, Look, Pose
from .tracks import Sighting
from .visitors import Question, Visitor

if TYPE_CHECKING:
    from .frames import Frames

Seconds = Annotated[float, Field(gt=0)]
Share = Annotated[float, Field(ge=0, le=1)]


class Settings(rs.Settings):
    """The settings of visionio: the camera, and the limits for recognising faces."""

    source: NameOrPath = "default"
    """The camera: ``default``, a device (``/dev/video0``), a video file, or a folder of pictures. Empty means no
    camera. A platform's camera in ``visionio.camera`` takes priority."""
    loop: bool = False
    """Whether a video file or a folder begins again at its end."""
    python: Path | None = None
    """The Python interpreter of the vision worker; by default the interpreter of ``make eyes``, or the current one."""
    fps: Annotated[float, Field(gt=0, le=60)] = 10.0
    """The agent looks at no more than this many pictures per second."""
    load: Annotated[float, Field(gt=0, le=1)] = 0.6
    """The share of the time that looking may take. So on a slow machine, the agent looks at fewer pictures."""

    threshold: Annotated[float, Field(gt=0, le=2)] = 0.55
    """The maximum Euclidean distance of two vectors of the same person. A vector describes a face as 128 numbers."""
    sure: Annotated[int, Field(ge=1, le=20)] = 3
    """The agent decides whose face it sees when this many vectors in a row agree."""
    quality: Share = 0.3
    """The minimum visibility of a face (0 to 1) for its vector to count."""
    gone_after: Seconds = 4.0
    """A person counts as gone if the agent has not seen their face for this many seconds."""
    history: Annotated[int, Field(ge=10)] = 100
    """The maximum number of faces that ``visionio.history`` keeps."""
    most: Annotated[int, Field(ge=1)] = 8
    """The maximum number of vectors that memory keeps for each person."""
    ask: bool = True
    """Whether the agent asks people who give their names if it may remember their faces. It keeps a face only after a
    yes, or after *remember my face*."""


module = rs.Module("visionio", requires=[rawio, interloc, ontology, verbaliser, idle, activity], settings=Settings)

facevec: rs.Signal[FaceVec] = module.signal("facevec", payload=FaceVec, input=True, limit=1000)
"""A face in a picture, with its vector. The signal is raised for each picture and each face that has a vector."""

sighted: rs.Signal[Sighting] = module.signal("sighted", payload=Sighting, limit=100)
"""The faces in a new picture. The agent does not know yet to whom they belong."""

looked: rs.Signal[Look] = module.signal("looked", payload=Look, input=True, keep="latest")
"""The agent has looked at a picture, with or without faces."""

pose: rs.Signal[Pose] = module.signal("pose", payload=Pose, input=True, limit=1000)
"""The body in a picture. The signal is raised for each picture if a rule of the agent listens to this signal or to
`activity.recognised`."""

camera: rs.Slot[Frames | None] = module.slot("camera", None, type=cast("type[Frames]", object), input=True)
"""The camera into which a platform puts pictures, for example a web page or a robot; None if there is none."""

history: rs.Slot[tuple[FaceVec, ...]] = module.slot("history", ())
"""A ring buffer of the last faces with new vectors, oldest first."""

visitors: rs.Collection[Visitor] = module.collection("visitors")
"""The people whom the agent sees, by their keys in `interloc.users`."""

met: rs.Slot[frozenset[str]] = module.slot("met", frozenset())
"""The keys of the platform's users whose faces the agent has seen in this conversation."""

left: rs.Signal[Visitor] = module.signal("left", payload=Visitor)
"""A person has left. The payload is the visitor's last record."""

named: rs.Signal[ontology.Node] = module.signal("named", payload=ontology.Node)
"""A person whom the agent sees has given their name. The payload is their node, with the name."""

asking: rs.Slot[Question | None] = module.slot("asking", None, type=cast("type[Question]", object))
"""The agent's open question whether it may remember a face; None if there is none."""

agreed: rs.Signal[str] = module.signal("agreed", payload=str)
"""A visitor allows or asks the agent to remember their face. The payload is their key; empty if the agent sees
nobody."""

refused: rs.Signal[str] = module.signal("refused", payload=str)
"""A visitor does not want the agent to remember their face. The payload is their key."""

withdrawn: rs.Signal[str] = module.signal("withdrawn", payload=str)
"""A visitor asks the agent to forget their face. The payload is their key; empty if the agent sees nobody."""
