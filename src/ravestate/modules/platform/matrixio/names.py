"""The names of `matrixio`: its settings, its module, its slot and its signal."""

from __future__ import annotations

import pydantic

import ravestate as rs
from ravestate.modules import interloc, rawio
from ravestate.modules.platform.chats import ChatSettings, connect


class Settings(ChatSettings):
    """The settings of matrixio: the account, and the people whom the agent answers."""

    homeserver: str = "https://matrix.org"
    """The address of the account's homeserver."""
    user: str = ""
    """The account's id, such as ``@robin:museum.example``; not needed with a token."""
    password: pydantic.SecretStr | None = None
    """The account's password. Set it as ``RAVESTATE_MATRIXIO_PASSWORD``."""
    token: pydantic.SecretStr | None = None
    """An access token, in place of the password. Set it as ``RAVESTATE_MATRIXIO_TOKEN``."""


module = rs.Module("matrixio", requires=(rawio, interloc), settings=Settings)

chat, command = connect(module)
"""The slot with the chat of this context, and the signal for the commands ``!start`` and ``!help``."""
