"""Serving an agent on Telegram, from the start of its bot to its end."""

from __future__ import annotations

import asyncio
import importlib
from typing import TYPE_CHECKING, Any

from ravestate.errors import PlatformError
from ravestate.folders import user_folder

if TYPE_CHECKING:
    from ravestate.runtime.agent import Agent

    from .names import Settings


async def serve(agent: Agent) -> None:
    """Serve the agent to the users of its Telegram bot, until cancelled; then end the conversations in order.

    Raises:
        PlatformError: The token is missing or wrong, another program polls the bot, or a package is missing.
    """
    settings: Any = agent.settings["telegramio"]
    token = settings.token.get_secret_value() if settings.token else ""
    if not token:
        raise PlatformError(
            "telegramio needs a bot's token: @BotFather on Telegram makes a bot and shows its token; then "
            "export RAVESTATE_TELEGRAMIO_TOKEN=..."
        )
    try:
        await asyncio.to_thread(importlib.import_module, "telegram")
        if settings.webhook:
            await asyncio.to_thread(importlib.import_module, "uvicorn")
    except ImportError as error:
        raise PlatformError(f"telegramio needs {error.name}: pip install 'ravestate[telegram]'") from error
    from ravestate.modules.platform.chats.secrecy import secret

    from .bot import run

    with secret(token, token.rpartition(":")[2]):
        await run(agent, settings, token)


def store_path(settings: Settings, bot: int) -> Any:
    """Return the path of the file with the messages of a bot."""
    return settings.path or user_folder("data") / "chats" / f"telegramio-{bot}.sqlite"
