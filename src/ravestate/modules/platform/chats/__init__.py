"""The common part of platforms with many chats: a context for each chat, and messages that survive a crash."""

from __future__ import annotations

from .addressing import addressed, command_in, mentions, without_mention
from .attempts import Attempts
from .chat import Chat
from .commands import COMMANDS, Command
from .emoji import is_emoji
from .library import library
from .messages import Carrier, DeliveryError, Incoming, Outgoing, Person
from .room import Room
from .rules import connect
from .secrecy import secret
from .settings import Address, ChatSettings
from .store import Store

__all__ = [
    "COMMANDS",
    "Address",
    "Attempts",
    "Carrier",
    "Chat",
    "ChatSettings",
    "Command",
    "DeliveryError",
    "Incoming",
    "Outgoing",
    "Person",
    "Room",
    "Store",
    "addressed",
    "command_in",
    "connect",
    "library",
    "is_emoji",
    "mentions",
    "secret",
    "without_mention",
]
