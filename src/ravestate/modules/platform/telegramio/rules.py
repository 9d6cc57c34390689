"""The rules of `telegramio`: they carry the agent's words to the chat, and explain the commands."""

from __future__ import annotations

from ravestate.modules.platform.chats import connect

from .names import chat, command, module

connect(module, chat, command)
