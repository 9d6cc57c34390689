"""Serve an agent on Telegram, from the start of its bot to its end."""

from __future__ import annotations

from typing import TYPE_CHECKING, cast

from ravestate.errors import PlatformError
from ravestate.modules.platform.chats import library, secret

from .names import Settings, module

if TYPE_CHECKING:
    from ravestate.runtime.agent import Agent


@module.server
async def serve(agent: Agent) -> None:
    """Serve the agent to the users of its Telegram bot, until cancelled; then end the conversations cleanly.

    Raises:
        PlatformError: The token is missing or wrong, another program polls the bot, or a package is missing. Or the webhook
            or the file with the messages cannot be used.
    """
    settings = cast(Settings, agent.settings["telegramio"])
    token = settings.token.get_secret_value() if settings.token else ""
    if not token:
        raise PlatformError(
            "telegramio needs a bot's token: @BotFather on Telegram makes a bot and shows its token; then "
            "export RAVESTATE_TELEGRAMIO_TOKEN=..."
        )
    await library("telegramio", "telegram", "telegram")
    from .bot import run

    with secret(token, token.rpartition(":")[2]):
        await run(agent, settings, token)
