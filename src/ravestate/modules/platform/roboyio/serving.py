"""Serve a robot in an agent with many users: the robot has one context of its own."""

from __future__ import annotations

from typing import TYPE_CHECKING

from .names import here, module

if TYPE_CHECKING:
    from ravestate.runtime.agent import Agent


@module.server
async def serve(agent: Agent) -> None:
    """Run the context of the robot until a rule stops it or the task is cancelled."""
    async with agent.context() as context:
        context.put(here, True)
        await context.until_stopped()
