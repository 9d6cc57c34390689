"""The common part of platforms with many chats: a context for each chat, and messages that survive a crash."""

from __future__ import annotations

from .chat import Chat
from .commands import COMMANDS, Command
from .messages import Carrier, DeliveryError, Incoming, Outgoing, Person
from .room import Room
from .rules import Listener, carry, obey
from .store import Store

__all__ = [
    "COMMANDS",
    "Carrier",
    "Chat",
    "Command",
    "DeliveryError",
    "Incoming",
    "Listener",
    "Outgoing",
    "Person",
    "Room",
    "Store",
    "carry",
    "obey",
]
