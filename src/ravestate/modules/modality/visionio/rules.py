"""The rules that look at pictures and follow faces. They tell other modules who comes and who leaves.

A vector describes a face as 128 numbers. A track follows one face from picture to picture.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import ravestate as rs
from ravestate.errors import RavestateError
from ravestate.modules import activity, interloc, ontology, rawio

from . import people
from .face import FaceVec, Look, Pose, Vector
from .frames import Frames
from .names import (
    Settings,
    camera,
    facevec,
    history,
    left,
    looked,
    met,
    module,
    named,
    pose,
    sighted,
    visitors,
)
from .tracks import Sighting, Tracks
from .visitors import Decision, Visitor, at, decide, gone, of_track, whose

KEY = "visionio-"
"""For people whom no platform has added, the keys in ``interloc.users`` begin with this text."""


# ------------------------------------------------------------------------------------ looking


@module.rule(
    when=rs.startup.detached() | camera.changed.max_age(None).detached(),
    reads=camera,
    emits=(sighted, pose, activity.posed),
    until=camera.changed,
    detached=True,  # each picture is a separate cause
    background=True,
)
async def watch(ctx: rs.RuleContext) -> rs.Resign | None:
    """Open the camera, and raise a signal for each picture. Skip pictures if the machine is too slow."""
    from .watching import Watch

    settings: Settings = ctx.settings
    frames = ctx[camera]
    if frames is None and _is_served(ctx):
        return rs.Resign("the user's platform has no camera in visionio.camera now")
    if frames is not None and ctx.payload(camera.changed) is None:
        return rs.Resign("another run of this rule watches the new camera")
    view = Watch(settings, frames, ctx.log)
    tracks = Tracks(settings.sure)
    want = ["faces", "pose"] if _is_heard(ctx, pose) or _is_heard(ctx, activity.recognised) else ["faces"]
    began = ctx.now
    try:
        if not await view.begin():
            return None
        while (frame := await view.next()) is not None:
            now = ctx.now
            seen = await view.look(want, tracks.request(now), now - began, frame) if frame else None
            if view.blind:
                ctx.emit(sighted, Sighting(Look(now, (0, 0), dropped=view.skipped), ()))  # so that people count as gone
            if seen is not None:
                look = Look(now, tuple(seen["picture"]), seen["dark"], view.skipped)
                ctx.emit(sighted, Sighting(look, tuple(tracks.update(seen["faces"], now))))
                if "pose" in seen:
                    body = seen["pose"]
                    ctx.emit(pose, Pose(None if body is None else tuple(tuple(point) for point in body), now))
                    if body is not None:
                        ctx.emit(activity.posed, activity.pose_of(body, now, *seen["picture"]))
            if not await view.rest(now, ctx.now, ctx.sleep):
                break
    finally:
        view.close()
        if frames is not None:
            frames.close()
    await ctx.sleep(settings.gone_after + 0.1)
    ctx.emit(sighted, Sighting(Look(ctx.now, (0, 0), dropped=view.skipped), ()))  # everybody counts as gone
    return None


def _is_served(ctx: rs.RuleContext) -> bool:
    """Return whether a platform with many users runs this context. If so, the machine's camera does not show the user."""
    return any(each.serve is not None for each in ctx.policy.modules)


def _is_heard(ctx: rs.RuleContext, signal: rs.Signal[Any]) -> bool:
    """Return whether a rule of this agent listens to a signal."""
    plans = (ctx.policy.rule_plan(rule) for rule in ctx.policy.rules)
    return any(need.signal.name == signal.name for plan in plans for clause in plan.clauses for need in clause.needs)


@module.rule(
    when=rawio.camera.changed.max_age(None).detached(),
    writes=camera,
    detached=True,
    background=True,
)
async def see_user(ctx: rs.RuleContext) -> rs.Resign | None:
    """Pass on pictures from the user's own camera. When the agent has fetched a picture, ask for the next picture."""
    user = ctx.payload(rawio.camera.changed)
    if user is None:
        return rs.Resign("the user has turned their camera off")
    ctx[camera] = frames = Frames()
    try:
        while not frames.closed and (picture := await user.next()) is not None:
            frames.put(picture)
            await frames.taken()
        user.refuse("the agent cannot see at the moment")
    finally:
        frames.close()  # so that all visible people count as gone
    return None


@module.rule(
    when=sighted.max_age(None) & rawio.camera.holds(bool),
    reads=(rawio.camera, visitors),
    detached=True,
    background=True,
)
async def mark_faces(ctx: rs.RuleContext) -> rs.Resign | None:
    """Show the user the faces in their pictures, with the names that the agent knows."""
    if (user := ctx[rawio.camera]) is None:
        return rs.Resign("the user has turned their camera off")
    sighting, all_visitors = ctx.payload(sighted), ctx[visitors]
    width, height = sighting.look.size
    faces: list[rawio.Face] = []
    for track, _ in sighting.faces:
        visitor = of_track(all_visitors, track.number)
        person = track.person if visitor is None else visitor.node
        x, y, w, h = track.box
        name = str(person.get("name") or "") if person is not None else ""
        faces.append(rawio.Face((x / width, y / height, w / width, h / height), name))
    user.mark(faces)
    return None


@module.rule(
    when=sighted.max_age(None),
    reads=ontology.memory,
    emits=(facevec, looked),
    detached=True,  # each face is a separate cause; otherwise, `track` would run for only one face of a picture
    background=True,
)
async def feed(ctx: rs.RuleContext) -> None:
    """Raise `facevec` for each face that has a vector, with the person in memory to whom it belongs. Raise `looked`."""
    settings: Settings = ctx.settings
    sighting = ctx.payload(sighted)
    for track, new in sighting.faces:
        if new and track.vector is not None:
            found = await _nearest(ctx, track.vector)
            track.recognise(found and found.person, found and found.distance, settings.quality)
    for track, new in sighting.faces:
        if track.vector is not None:
            place = track.vector, track.box, track.number
            ctx.emit(facevec, FaceVec(*place, track.person, track.distance, track.quality, new, sighting.look.time))
    ctx.emit(looked, replace(sighting.look, tracks=tuple(track.number for track, _ in sighting.faces)))


async def _nearest(ctx: rs.RuleContext, vector: Vector) -> people.Nearest | None:
    """Return the person in memory with the nearest face; None if nobody is near enough."""
    memory, threshold = ctx[ontology.memory], ctx.settings.threshold
    if memory is None:
        return None
    try:
        return await memory.together(lambda graph: people.nearest(graph, vector, threshold))
    except RavestateError as error:
        ctx.log.debug("memory could not look up a face: %s", error)
        return None


# ------------------------------------------------------------------------------------ visitors


@module.rule(
    when=facevec.max_age(None),
    reads=ontology.memory,
    writes=(history, visitors, met, interloc.users),
    emits=(interloc.recognised, named),
    background=True,
)
async def track(ctx: rs.RuleContext) -> None:
    """Keep a history of faces with new vectors. When enough vectors agree, note the person who has come."""
    settings: Settings = ctx.settings
    face = ctx.payload(facevec)
    face = replace(face, time=ctx.now if face.time is None else min(ctx.now, face.time))
    decision = None
    if face.fresh:
        seen = (*ctx[history], face)[-settings.history :]
        ctx[history] = seen
        decision = decide(seen, face, sure=settings.sure, quality=settings.quality)
    all_visitors = dict(ctx[visitors])
    visitor = of_track(all_visitors, face.track)
    if visitor is not None and decision is not None:
        visitor = _reconsidered(ctx, visitor, face, decision)
    if visitor is None and decision is not None:
        visitor = whose(all_visitors, face, decision, settings.threshold) or await _arrival(ctx, decision)
        if decision.person is not None and not visitor.known:
            visitor = _recognised(ctx, visitor, decision.person)
    if visitor is not None:
        if visitor.linked:
            ctx[met] = ctx[met] | {visitor.key}
        ctx[visitors].add(visitor.key, visitor.met(face, least=settings.quality, threshold=settings.threshold))


def _reconsidered(ctx: rs.RuleContext, visitor: Visitor, face: FaceVec, decision: Decision) -> Visitor | None:
    """Return the visitor of a track; None if new vectors show that the track now belongs to another person."""
    settings: Settings = ctx.settings
    person = decision.person
    if person is None or person.id == visitor.node.id or person.id in visitor.mistaken:
        alike = person is not None or not visitor.vectors or not decision.vectors
    elif not visitor.known:
        return _recognised(ctx, visitor, person)
    else:
        alike = False
    # Even if memory knows this face under another name, it may be the visitor's face.
    if alike or any(visitor.resembles(vector, settings.threshold) for vector in decision.vectors):
        return visitor
    ctx[visitors].add(visitor.key, replace(visitor, tracks=visitor.tracks - {face.track}))
    return None


async def _arrival(ctx: rs.RuleContext, decision: Decision) -> Visitor:
    """Return a new visitor. Add the visitor to the present users, unless a platform has already added them."""
    users, all_visitors, now = ctx[interloc.users], ctx[visitors], ctx.now
    person = decision.person
    others = [key for key in users if not key.startswith(KEY)]
    key = next((key for key in others if len(others) == 1 and key not in all_visitors), None)
    if key is not None:
        item = users[key]
        name = person.get("name") if person is not None else None
        before = item.node.id if isinstance(item, interloc.Recognised) else None
        if item and person is None:
            user = item.node if before is not None else ontology.Node("Person", {"name": str(item)})
            if await _is_new_face(ctx, key, user):
                ctx.emit(named, user)
                return Visitor(key, user, known=True, since=now, seen=now, linked=True)
        if before is not None and (person is None or person.id != before):  # another person has taken this user's place
            users.remove(key)
            node = person or ontology.Node("Person")
            known = person is not None
            return Visitor(key, node, known, since=now, seen=now, linked=True, faces=known, moving=True)
        if person is not None and before is None and item not in (None, name):
            key = None  # the platform says that its user is another person
    node = person or ontology.Node("Person")
    if key is None:
        key = f"{KEY}{1 + max((int(k[len(KEY) :]) for k in (*users, *all_visitors) if k.startswith(KEY)), default=0)}"
        visitor = Visitor(key, node, person is not None, since=now, seen=now, faces=person is not None)
        users.add(key, visitor.item)
        return visitor
    visitor = Visitor(key, ontology.Node("Person"), since=now, seen=now, linked=True)
    return visitor if person is None else _recognised(ctx, visitor, person)


async def _is_new_face(ctx: rs.RuleContext, key: str, node: ontology.Node) -> bool:
    """Return whether a user with a name shows their face for the first time, and memory has no face of them."""
    memory = ctx[ontology.memory]
    if key in ctx[met] or memory is None:
        return False
    try:
        return not await memory.together(lambda graph: people.has_faces(graph, node))
    except RavestateError as error:
        ctx.log.debug("memory could not look up a person: %s", error)
        return False


def _recognised(ctx: rs.RuleContext, visitor: Visitor, person: ontology.Node) -> Visitor:
    """Return the visitor with the node of a recognised person, and report the person to the other modules."""
    visitor = replace(visitor, node=person, known=True, faces=True)
    if visitor.item is not None and not visitor.moving:
        ctx[interloc.users].add(visitor.key, visitor.item)
        ctx.emit(interloc.recognised, rs.Entry(visitor.key, visitor.item))
    return visitor


@module.rule(
    when=interloc.users.removed.min_age(0.5).max_age(None).detached(),
    writes=(visitors, interloc.users),
    detached=True,
    background=True,
)
async def move_up(ctx: rs.RuleContext) -> rs.Resign | None:
    """Add a platform's user again, as another person, half a second after the removal.

    By then, other modules have finished with the previous person.
    """
    key = ctx.payload(interloc.users.removed).key
    visitor = ctx[visitors].get(key)
    if visitor is None or not visitor.moving:
        return rs.Resign("nobody takes the place of this user")
    ctx[visitors].add(key, replace(visitor, moving=False))
    ctx[interloc.users].add(key, visitor.item)
    return None


@module.rule(when=looked.max_age(None), writes=(visitors, history, interloc.users), emits=left, background=True)
async def leave(ctx: rs.RuleContext) -> rs.Resign | None:
    """Note people who have left, and drop the vectors of their faces."""
    settings: Settings = ctx.settings
    now, all_visitors = min(ctx.now, ctx.payload(looked).time), dict(ctx[visitors])
    absent = gone(all_visitors, now, settings.gone_after)
    present = {number for visitor in all_visitors.values() if visitor not in absent for number in visitor.tracks}
    before = ctx[history]
    kept = tuple(face for face in before if face.track in present or now - at(face) <= settings.gone_after)
    if len(kept) < len(before):
        ctx[history] = kept
    elif not absent:
        return rs.Resign("nobody has left")
    for visitor in absent:
        ctx[visitors].remove(visitor.key)
        if not visitor.linked:
            ctx[interloc.users].remove(visitor.key)
        ctx.emit(left, visitor)
    return None


# ------------------------------------------------------------------------------------ names


@module.rule(
    when=interloc.users.changed.max_age(None).detached(),
    reads=(interloc.users, ontology.memory),
    writes=(visitors, history),
    emits=named,
    detached=True,
    background=True,
)
async def learn_name(ctx: rs.RuleContext) -> rs.Resign | None:
    """Keep the node of a visitor whose name another module has learnt, and raise `named`."""
    key = ctx.payload(interloc.users.changed).key
    all_visitors = ctx[visitors]
    visitor, item = all_visitors.get(key), ctx[interloc.users].get(key)
    if visitor is None:
        return rs.Resign("the agent does not see this user")
    if not item:
        if visitor.known:  # the visitor is not the person whom the agent recognised
            ctx[history] = ()
            mistaken = visitor.mistaken | {visitor.node.id}
            stranger = replace(visitor, node=ontology.Node("Person"), known=False, faces=False, mistaken=mistaken)
            ctx[visitors].add(key, stranger)
            await _take_away(ctx, visitor)
        return None
    node = item.node if isinstance(item, interloc.Recognised) else visitor.node.with_properties(name=str(item))
    if visitor.known and node.id == visitor.node.id:
        return rs.Resign("the agent knows this person")
    wrong = None
    if visitor.faces and visitor.known:
        strangers = [other for other in all_visitors.values() if not other.known]
        if len(strangers) == 1:  # the name must belong to the only person whom the agent does not know
            visitor = strangers[0]
        else:
            wrong, visitor = visitor, replace(visitor, mistaken=visitor.mistaken | {visitor.node.id})
    ctx[visitors].add(visitor.key, replace(visitor, node=node, known=True, faces=False))
    if wrong is not None:
        await _take_away(ctx, wrong)
    ctx.emit(named, node)
    return None


async def _take_away(ctx: rs.RuleContext, visitor: Visitor) -> None:
    """Remove a visitor's face from the person with whom the agent confused them. This prevents the same mistake."""
    memory, vectors = ctx[ontology.memory], [vector for _, vector in visitor.vectors]
    if memory is None:
        return
    try:
        await memory.together(lambda graph: people.take_away(graph, visitor.node, vectors))
    except RavestateError as error:
        ctx.log.error("%s", error)
