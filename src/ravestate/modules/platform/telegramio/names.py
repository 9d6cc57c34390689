"""The names of `telegramio`: its settings, its module, its slot and its signal."""

from __future__ import annotations

import pydantic

import ravestate as rs
from ravestate.modules import interloc, rawio
from ravestate.modules.platform.chats import Address, Chat, ChatSettings, Command


class Settings(ChatSettings):
    """The settings of telegramio: the bot, the people whom it answers, and the way to get messages."""

    token: pydantic.SecretStr | None = None
    """The bot's token from @BotFather. Set it as ``RAVESTATE_TELEGRAMIO_TOKEN``."""
    base_url: Address = "https://api.telegram.org/bot"
    """The address of the Bot API server, up to the token."""
    webhook: Address | None = None
    """The public address, with ``https://``, to which Telegram delivers messages. If None, the bot asks Telegram."""
    host: str = "127.0.0.1"
    """The address to listen on for the webhook."""
    port: int = pydantic.Field(8443, ge=0, le=65535)
    """The port to listen on for the webhook."""
    rate: float = pydantic.Field(25.0, gt=0, allow_inf_nan=False)
    """The maximum number of messages per second. Telegram allows 30 for a bot; a server of your own may allow more."""
    drafts: bool = True
    """Whether a private chat shows an answer while it grows."""


module = rs.Module("telegramio", requires=(rawio, interloc), settings=Settings)

chat: rs.Slot[Chat | None] = module.slot("chat", None)
"""The chat of this context."""

command: rs.Signal[Command] = module.signal("command", payload=Command, input=True)
"""A user has given the command ``/start`` or ``/help``."""
