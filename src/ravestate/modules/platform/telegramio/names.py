"""The names of `telegramio`: its settings, its module, its slot and its signal."""

from __future__ import annotations

from pathlib import Path

import pydantic

import ravestate as rs
from ravestate.modules import interloc, rawio
from ravestate.modules.platform.chats import Chat, Command

from .serving import serve


class Settings(rs.Settings):
    """The settings of telegramio: the bot, the people whom it answers, and the way in which messages come."""

    token: pydantic.SecretStr | None = None
    """The bot's token from @BotFather. Set it as ``RAVESTATE_TELEGRAMIO_TOKEN``."""
    base_url: str = "https://api.telegram.org/bot"
    """The address of the Bot API server, up to the token."""
    allow: tuple[int | str, ...] = ()
    """The people whom the bot answers: user ids, names with or without ``@``, or ids of groups. Empty: everybody."""
    webhook: str | None = None
    """The public address, with ``https://``, at which Telegram delivers messages. None: the bot asks for them."""
    host: str = "127.0.0.1"
    """The address to listen on for the webhook."""
    port: int = pydantic.Field(8443, ge=0, le=65535)
    """The port to listen on for the webhook."""
    rest: float = pydantic.Field(600.0, gt=0, allow_inf_nan=False)
    """The seconds of silence after which a chat is put to rest."""
    chats: int = pydantic.Field(1000, ge=1)
    """The maximum number of chats at a time that do not rest."""
    rate: float = pydantic.Field(25.0, gt=0, allow_inf_nan=False)
    """The maximum number of messages per second. Telegram allows a bot 30; a server of your own may allow more."""
    path: Path | None = None
    """The file with unanswered and undelivered messages. Default: one for each bot in the user's data folder."""


module = rs.Module("telegramio", requires=(rawio, interloc), settings=Settings, serve=serve)

chat: rs.Slot[Chat | None] = module.slot("chat", None)
"""The chat that this context belongs to; None for a context without one."""

command: rs.Signal[Command] = module.signal("command", payload=Command, input=True)
"""The user has given the command ``/start`` or ``/help``."""
