"""The names of `activity`: its records, its settings, its module, its signals and slots."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Annotated

from pydantic import Field

import ravestate as rs

from .film import Film
from .pose import Pose
from .recogniser import Recogniser


@dataclass(frozen=True, slots=True)
class Activity:
    """An activity that a person performed in front of the camera."""

    name: str
    """The spoken name, for example ``waving`` or ``playing the guitar``."""
    confidence: float
    """The probability of the name, from 0 to 1."""
    start: float
    """Seconds on the context's clock, like `end`."""
    end: float
    others: Mapping[str, float] = field(default_factory=dict[str, float])
    """The next most likely names, with their confidence."""


@dataclass(frozen=True, slots=True)
class Lesson:
    """A user's name for the movement that the agent saw between two times."""

    name: str
    start: float
    """Seconds on the context's clock, like `end`."""
    end: float


class Settings(rs.Settings):
    """The settings of activity: how long and how often the recogniser looks, and the folder of taught activities."""

    window: Annotated[float, Field(ge=1.0, le=10.0)] = 3.0
    """The length of the movement for one recognition, in seconds."""
    step: Annotated[float, Field(gt=0)] = 0.5
    """The seconds from one recognition to the next."""
    folder: Path | None = None
    """The folder of taught activities; by default ``activities`` in your data folder."""


module = rs.Module("activity", settings=Settings)

posed: rs.Signal[Pose] = module.signal("posed", payload=Pose, input=True)
"""A camera sees a body. A platform or `visionio` emits this signal for each frame with a body."""

label: rs.Signal[str] = module.signal("label", payload=str, input=True)
"""An external recogniser has named an activity. The name may have the form ``playing_guitar``."""

recognised: rs.Signal[Activity] = module.signal("recognised", payload=Activity, input=True)
"""A person is performing an activity that the agent knows. Until they stop, the signal is raised every `step` seconds.
An unknown movement does not raise it. Each `label` raises it, too."""

taught: rs.Signal[Lesson] = module.signal("taught", payload=Lesson, input=True)
"""A user has named the movement between two times. The recogniser learns this movement from the poses
between these times."""

in_view: rs.Slot[bool] = module.flag("in_view", input=True)
"""Whether the camera sees a body."""

known: rs.Slot[tuple[str, ...]] = module.slot("known", ())
"""The names of all activities that the recogniser knows, in alphabetical order."""

movement: rs.Slot[Film] = module.slot("movement", Film(), always=True)
"""The poses of the last thirty seconds."""

model: rs.Slot[Recogniser | None] = module.slot("model", None, type=Recogniser, input=True)
"""The recogniser; None until it is loaded."""

due: rs.Signal[float] = module.signal("due", payload=float, keep="latest")
"""It is time for a recognition. The payload is the time of the newest pose."""

looked: rs.Signal[None] = module.signal("looked", keep="latest")
"""A new pose has come."""
