"""The rules of Telegram: those of every messenger."""

from __future__ import annotations

from ravestate.modules.platform.chats import carry, obey

from .names import chat, command, module

carry(module, chat)
obey(module, command)
