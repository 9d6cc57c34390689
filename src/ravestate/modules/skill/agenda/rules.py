"""The rules of agenda: when the agent may pursue a goal (say the goal's words), and the goals in the settings."""

from __future__ import annotations

import ravestate as rs
from ravestate.modules import idle, rawio

from .goal import goal
from .names import Settings, goals, module, opportunity, topics


@module.rule(when=idle.bored, reads=(goals, topics), emits=opportunity)
async def take_initiative(ctx: rs.RuleContext) -> rs.Resign | None:
    """Allow the pursuit of one goal, unless a goal was pursued in the last `gap` seconds, or there is a topic."""
    if ctx[topics]:
        return rs.Resign(f"the conversation is about {', '.join(ctx[topics])}")
    for name, state in ctx[goals].items():
        past = ctx.now - state.since
        if state.tries and past < ctx.settings.gap:
            return rs.Resign(f"{name} was pursued {past:.0f} s ago; agenda.gap is {ctx.settings.gap:g} s")
    ctx.emit(opportunity, ctx.now)
    return None


@module.rule(when=rawio.input.changed.max_age(None).detached(), background=True)
async def yield_to_the_user(ctx: rs.RuleContext) -> None:
    """When the user speaks, withdraw the opportunity to pursue a goal."""
    ctx.wipe(opportunity)


@module.rule(when=rs.startup.detached(), background=True)
def adopt_wishes(ctx: rs.RuleContext) -> None:
    """Add the goals in the settings to this context only. Other contexts of the same policy do not get these goals.

    This function runs in a thread, because adding a rule takes a few milliseconds and would hold up the event loop.
    """
    settings: Settings = ctx.settings
    own = rs.Module(module.name)
    for wish in settings.goals:
        goal(own, **wish.model_dump())
    for rule in own.rules:
        ctx.add_rule(rule)
