"""The rules that follow a body, recognise its movement, and learn from users."""

from __future__ import annotations

from math import isinf

import ravestate as rs
from ravestate.errors import PlatformError

from .files import clean, folder_of, keep, taught_in
from .names import (
    Activity,
    Settings,
    due,
    in_view,
    known,
    label,
    looked,
    model,
    module,
    movement,
    posed,
    recognised,
    taught,
)
from .recogniser import Recogniser

GONE = 2.0
"""After this many seconds without a pose, the agent assumes that nobody is in view."""
BEGINNING = 0.6
"""The first recognition needs only this share of the setting `window`."""


@module.rule(when=rs.startup, writes=(model, known), background=True)
def load(ctx: rs.RuleContext) -> rs.Resign | None:
    """Load the starter set and the taught activities in the background."""
    try:
        found = Recogniser()
    except PlatformError as error:
        ctx.log.warning("%s", error)  # labels of an external recogniser work without numpy
        return rs.Resign(str(error))
    for file, fault in taught_in(folder_of(ctx.settings.folder), found):
        ctx.log.warning("%s is left out: %s", file, fault)
    ctx[model] = found
    ctx[known] = found.names
    return None


@module.rule(
    when=posed.max_age(None).detached(),
    reads=in_view,
    writes=(movement, in_view),
    emits=(due, looked),
    detached=True,
    background=True,
)
async def follow(ctx: rs.RuleContext) -> None:
    """Add a pose to the film (the poses of the last seconds). Ask for a recognition every `step` seconds."""
    settings: Settings = ctx.settings
    pose = ctx.payload(posed)
    before = ctx[movement]
    now = ctx[movement] = before.with_pose(pose)
    ctx[in_view] = True
    ctx.emit(looked)
    began = now.part(pose.at - settings.window, pose.at)[0].at
    step = settings.step
    last = before.poses[-1].at if before.poses else pose.at
    if pose.at - began >= BEGINNING * settings.window and int(pose.at / step) != int(last / step):
        ctx.emit(due, pose.at)


@module.rule(when=looked.min_age(GONE).max_age(None), writes=in_view, detached=True, background=True)
async def lose_sight(ctx: rs.RuleContext) -> None:
    """Note that nobody is in view any longer."""
    ctx[in_view] = False


@module.rule(when=due, reads=(movement, model), emits=recognised, detached=True, background=True)
def recognise(ctx: rs.RuleContext) -> rs.Resign | None:
    """Recognise the movement of the last seconds. This takes some milliseconds, so the rule runs in a thread."""
    settings: Settings = ctx.settings
    found = ctx[model]
    if found is None:
        return rs.Resign("the recogniser is not loaded")
    poses = ctx[movement].part(ctx.payload(due) - settings.window, ctx.payload(due))
    seen = found.recognise(poses)
    if isinf(seen.distance):
        return rs.Resign(f"the {len(poses)} poses of this time show too little of a body")
    if not seen.name:
        return rs.Resign(f"the movement is unknown; it is nearest to {seen.nearest or 'other movements'}")
    ctx.emit(recognised, Activity(seen.name, seen.confidence, poses[0].at, poses[-1].at, dict(seen.others)))
    return None


@module.rule(when=label.max_age(None).detached(), emits=recognised, detached=True, background=True)
async def take_over(ctx: rs.RuleContext) -> rs.Resign | None:
    """Pass on the label of an external recogniser as a recognised activity."""
    name = clean(ctx.payload(label))
    if not name:
        return rs.Resign("the label is empty")
    ctx.emit(recognised, Activity(name, 1.0, max(0.0, ctx.now - ctx.settings.window), ctx.now))
    return None


@module.rule(
    when=taught.max_age(None).detached(),
    reads=movement,
    writes=(model, known),
    detached=True,
    background=True,
)
def learn(ctx: rs.RuleContext) -> rs.Resign | None:
    """Learn the movement that a user has named, and keep it in the folder."""
    lesson, found = ctx.payload(taught), ctx[model]
    name, poses = clean(lesson.name), ctx[movement].part(lesson.start, lesson.end)
    if found is None or not name:
        return rs.Resign("there is no recogniser, or no name")
    if not found.teach(name, poses):
        return rs.Resign(f"the {len(poses)} poses between these times show too little of a body")
    ctx[known] = found.names
    try:
        ctx.log.info("learnt %s: %s", name, keep(folder_of(ctx.settings.folder), name, poses))
    except PlatformError as error:
        ctx.log.error("%s", error)  # without a file, the movement is forgotten when the process ends
    return None
