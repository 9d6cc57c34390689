"""Carry text between the user and the agent, on any platform."""

from __future__ import annotations

from typing import TYPE_CHECKING

from .camera import Camera, Face
from .line import IN_RATE, OUT_RATE, Line
from .listener import Listener, carry, rest
from .names import (
    camera,
    heard,
    hearing,
    hush,
    input,
    module,
    output,
    picture,
    piece,
    reaction,
    sound,
    speaking,
    typing,
)

if TYPE_CHECKING:
    from ravestate.runtime.context import Context

__all__ = [
    "IN_RATE",
    "OUT_RATE",
    "Camera",
    "Face",
    "Line",
    "Listener",
    "camera",
    "carry",
    "heard",
    "hearing",
    "hush",
    "input",
    "module",
    "output",
    "picture",
    "piece",
    "reaction",
    "rest",
    "say",
    "sound",
    "speaking",
    "typing",
]


def say(context: Context, text: str) -> None:
    """Say something to an agent from outside, as if its user had typed `text`. Any thread may call this."""
    context.put(input, text)
