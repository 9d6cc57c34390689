"""The common part of platforms with many chats: a context for each chat, and messages that survive a crash."""

from __future__ import annotations

from .addressing import command_in, for_another, is_emoji, mentions, without_mention
from .chat import Chat
from .commands import COMMANDS, Command
from .messages import Carrier, DeliveryError, Incoming, Outgoing, Person
from .room import Room
from .rules import connect
from .secrecy import secret
from .sender import back_off
from .settings import ChatSettings
from .store import Store

__all__ = [
    "COMMANDS",
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
    "back_off",
    "command_in",
    "connect",
    "for_another",
    "is_emoji",
    "mentions",
    "secret",
    "without_mention",
]
