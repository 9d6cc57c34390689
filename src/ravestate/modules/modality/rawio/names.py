"""The names of `rawio`: its module, its slots and signals."""

from __future__ import annotations

from typing import Any

import ravestate as rs

from .camera import Camera
from .line import Line

module = rs.Module("rawio")

input = module.slot("input", "", type=str, always=True, input=True)
"""The user's last utterance. Each utterance raises `input.changed`, even if it repeats the last one."""

output = module.slot("output", "", type=str, always=True)
"""The agent's last utterance. Each write is one whole utterance."""

piece = module.signal("piece", payload=str)
"""A piece of an unfinished utterance of the agent, for platforms that show the utterance while it grows. At the end,
the rule that produces the pieces writes the whole utterance to `output`."""

speaking = module.flag("speaking")
"""True while the agent is producing an utterance piece by piece."""

typing = module.signal("typing", input=True, keep="latest")
"""The user is typing. A platform that notices this emits the signal at each key press, or every few seconds."""

reaction: rs.Signal[str] = module.signal("reaction", payload=str, input=True)
"""The user has reacted to the agent's words with an emoji, on a messenger that allows this. The payload is the
emoji."""

picture: rs.Slot[Any] = module.slot("picture", None, always=True, input=True)
"""The last picture that the user showed: the bytes of an encoded picture (JPEG, PNG), or a path; None at first."""

sound: rs.Slot[Line | None] = module.slot("sound", None, input=True)
"""The line to the user's microphone and loudspeaker, from a platform that carries sound; None on other platforms."""

camera: rs.Slot[Camera | None] = module.slot("camera", None, input=True)
"""The user's camera, from a platform that has cameras; None while the camera is off."""

hearing: rs.Signal[str] = module.signal("hearing", payload=str, input=True, keep="latest")
"""The words so far of an utterance that the user is still speaking, for platforms that show captions."""

hush: rs.Signal[None] = module.signal("hush", input=True, keep="latest")
"""The user asks the agent to stop speaking, for example with a button."""

heard: rs.Slot[str] = module.slot("heard", "", type=str, always=True, input=True)
"""The part of the agent's last utterance that the user heard. A platform that speaks writes this part for each
utterance, when the sound ends or is cut off."""
