"""Serve an agent on Matrix, from its login to its end."""

from __future__ import annotations

from typing import TYPE_CHECKING, cast

from ravestate.errors import PlatformError
from ravestate.modules.platform.chats import library, secret

from .names import Settings, module

if TYPE_CHECKING:
    from ravestate.runtime.agent import Agent


@module.server
async def serve(agent: Agent) -> None:
    """Serve the agent in the rooms of its Matrix account, until cancelled; then end the conversations cleanly.

    Raises:
        PlatformError: The account is missing or refused, or a package is missing.
    """
    settings = cast(Settings, agent.settings["matrixio"])
    secrets = [each.get_secret_value() for each in (settings.token, settings.password) if each]
    if not any(secrets) or not (settings.token or settings.user):
        raise PlatformError(
            "matrixio needs an account: --set matrixio.homeserver=https://... --set matrixio.user=@robin:museum.example, "
            "and export RAVESTATE_MATRIXIO_PASSWORD=... (or RAVESTATE_MATRIXIO_TOKEN=... alone)"
        )
    await library("matrixio", "nio", "matrix")
    from .account import run

    with secret(*secrets):
        await run(agent, settings)
