"""Charades: the user acts something out, and the agent guesses. On request, the agent sets a riddle instead."""

from __future__ import annotations

from . import rules as rules
from .game import Game
from .names import (
    Settings,
    abandoned,
    begun,
    declined,
    game,
    gestures,
    module,
    moved,
    perform,
    prompted,
    sightings,
    watched,
)
from .rules import offer
from .understanding import Move

__all__ = [
    "Game",
    "Move",
    "Settings",
    "abandoned",
    "begun",
    "declined",
    "game",
    "gestures",
    "module",
    "moved",
    "offer",
    "perform",
    "prompted",
    "sightings",
    "watched",
]
