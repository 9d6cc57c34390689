"""The names of `matrixio`: its settings, its module, its slot and its signal."""

from __future__ import annotations

import pydantic

import ravestate as rs
from ravestate.modules import interloc, rawio
from ravestate.modules.platform.chats import Address, Chat, ChatSettings, Command


class Settings(ChatSettings):
    """The settings of matrixio: the account, and the people whom the agent answers."""

    homeserver: Address = "https://matrix.org"
    """The address of the account's homeserver."""
    user: str = ""
    """The account's id, such as ``@robin:museum.example``; not needed with a token."""
    password: pydantic.SecretStr | None = None
    """The account's password. Set it as ``RAVESTATE_MATRIXIO_PASSWORD``."""
    token: pydantic.SecretStr | None = None
    """An access token, in place of the password. Set it as ``RAVESTATE_MATRIXIO_TOKEN``."""


module = rs.Module("matrixio", requires=(rawio, interloc), settings=Settings)

chat: rs.Slot[Chat | None] = module.slot("chat", None)
"""The chat of this context."""

command: rs.Signal[Command] = module.signal("command", payload=Command, input=True)
"""A user has given the command ``!start`` or ``!help``."""
