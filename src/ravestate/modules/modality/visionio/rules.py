"""The rules: looking, following faces, greeting whom the agent knows, and remembering faces after a yes."""

from __future__ import annotations

import asyncio
from dataclasses import replace
from typing import Any

import ravestate as rs
from ravestate.errors import RavestateError
from ravestate.modules import activity, idle, interloc, ontology, rawio, verbaliser
from ravestate.modules.meta.nlp.answer import yesno_of
from ravestate.modules.meta.verbaliser.intents import Intent

from . import people
from .face import FaceVec, Look, Pose, Vector
from .names import (
    Settings,
    agreed,
    asked_at,
    asking,
    camera,
    facevec,
    history,
    left,
    looked,
    module,
    named,
    pose,
    refused,
    sighted,
    visitors,
    withdrawn,
)
from .tracks import Sighting, Tracks
from .visitors import Decision, Visitor, decide, gone, in_front, of_track, whose
from .wishes import wish_of

KEY = "visionio-"
"""The beginning of the keys in ``interloc.users`` of people whom no platform has added."""
POLITE = 3.0
"""Seconds after a person has told their name until the agent asks whether it may remember their face."""
ANSWERED = 60.0
"""Seconds for which that question waits for its answer."""


# ------------------------------------------------------------------------------------ looking


@module.rule(
    when=rs.startup.detached() | camera.changed.max_age(None).detached(),
    reads=camera,
    emits=(sighted, pose, activity.posed),
    until=camera.changed,
    detached=True,  # each picture is a cause of its own
    background=True,
)
async def watch(ctx: rs.RuleContext) -> rs.Resign | None:
    """Open the camera, and raise a signal for each of its pictures, as many as the machine can look at."""
    from .watching import Watch

    settings: Settings = ctx.settings
    frames = ctx[camera]
    if frames is None and _is_served(ctx):
        return rs.Resign("a platform with many users brings their cameras in visionio.camera")
    if frames is not None and ctx.payload(camera.changed) is None:
        return rs.Resign("another run of this rule looks at the camera that came at once")
    view = Watch(settings, frames, ctx.log)
    if not await view.begin():
        return None
    tracks = Tracks(settings.sure)
    want = ["faces", "pose"] if _is_heard(ctx, pose) or _is_heard(ctx, activity.recognised) else ["faces"]
    began = ctx.now
    try:
        while (frame := await view.next()) is not None:
            now = ctx.now
            seen = await view.look(want, tracks.request(now), now - began, frame) if frame else None
            if view.blind:
                ctx.emit(sighted, Sighting(Look(now, (0, 0), dropped=view.skipped), ()))  # so that people leave
            if seen is not None:
                look = Look(now, tuple(seen["picture"]), seen["dark"], view.skipped)
                ctx.emit(sighted, Sighting(look, tuple(tracks.update(seen["faces"], now))))
                if "pose" in seen:
                    body = seen["pose"]
                    ctx.emit(pose, Pose(None if body is None else tuple(tuple(point) for point in body), now))
                    if body is not None:
                        ctx.emit(activity.posed, activity.pose_of(body, now, *seen["picture"]))
            if not await view.rest(ctx.now - now, ctx.sleep):
                break
    finally:
        view.close()
    await ctx.sleep(settings.gone_after + 0.1)
    ctx.emit(sighted, Sighting(Look(ctx.now, (0, 0), dropped=view.skipped), ()))  # everybody has left
    return None


def _is_served(ctx: rs.RuleContext) -> bool:
    """Return whether a platform with many users runs this context, so that the machine's camera is not for it."""
    return any(each.serve is not None for each in ctx.policy.modules)


def _is_heard(ctx: rs.RuleContext, signal: rs.Signal[Any]) -> bool:
    """Return whether a rule of this agent listens to a signal."""
    plans = (ctx.policy.rule_plan(rule) for rule in ctx.policy.rules)
    return any(need.signal.name == signal.name for plan in plans for clause in plan.clauses for need in clause.needs)


@module.rule(
    when=sighted.max_age(None),
    reads=ontology.memory,
    emits=(facevec, looked),
    detached=True,  # each face is a cause of its own, else `track` would take only one face of a picture
    background=True,
)
async def feed(ctx: rs.RuleContext) -> None:
    """Raise `facevec` for each face in a picture, with the person in memory to whom it belongs."""
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
    """Return the person in memory whose face is nearest."""
    memory, threshold = ctx[ontology.memory], ctx.settings.threshold
    if memory is None:
        return None
    try:
        return await memory.together(lambda graph: people.nearest(graph, vector, threshold))
    except RavestateError as error:
        ctx.log.debug("memory was not asked about a face: %s", error)
        return None


# ------------------------------------------------------------------------------------ who is there


@module.rule(
    when=facevec.max_age(None),
    writes=(history, visitors, interloc.users),
    emits=interloc.recognised,
    background=True,
)
async def track(ctx: rs.RuleContext) -> None:
    """Keep a history of faces with new vectors, and note who has come once enough of them agree."""
    settings: Settings = ctx.settings
    face = ctx.payload(facevec)
    if face.time is None:
        face = replace(face, time=ctx.now)
    decision = None
    if face.fresh:
        seen = (*ctx[history], face)[-settings.history :]
        ctx[history] = seen
        decision = decide(seen, face, sure=settings.sure, quality=settings.quality)
    here = dict(ctx[visitors])
    one = of_track(here, face.track)
    if one is not None and decision is not None:
        one = _reconsidered(ctx, one, face, decision)
    if one is None and decision is not None:
        one = whose(here, face, decision, settings.threshold) or _arrival(ctx, decision)
        if decision.person is not None and not one.known:
            one = _recognised(ctx, one, decision.person)
    if one is not None:
        ctx[visitors].add(one.key, one.met(face, least=settings.quality, threshold=settings.threshold))


def _reconsidered(ctx: rs.RuleContext, one: Visitor, face: FaceVec, decision: Decision) -> Visitor | None:
    """Return the visitor who has a track, after new vectors; None if the track is somebody else's by now."""
    settings: Settings = ctx.settings
    person = decision.person
    if person is None or person.id == one.node.id or person.id in one.mistaken:
        alike = person is not None or not one.vectors or not decision.vectors
    elif not one.known:
        return _recognised(ctx, one, person)
    else:
        alike = False
    # Memory may know this face under another name than the one that the visitor has told.
    if alike or any(one.resembles(vector, settings.threshold) for vector in decision.vectors):
        return one
    ctx[visitors].add(one.key, replace(one, tracks=one.tracks - {face.track}))
    return None


def _arrival(ctx: rs.RuleContext, decision: Decision) -> Visitor:
    """Return a new visitor, and add them to the present users, unless they are the user whom a platform has added."""
    users, here, now = ctx[interloc.users], ctx[visitors], ctx.now
    person = decision.person
    others = [key for key in users if not key.startswith(KEY)]
    key = next((key for key in others if len(others) == 1 and key not in here), None)
    if key is not None:
        item = users[key]
        name = person.get("name") if person is not None else None
        before = item.node.id if isinstance(item, interloc.Recognised) else None
        if before is not None and (person is None or person.id != before):  # another person sits down
            users.remove(key)
            node = person or ontology.Node("Person")
            known = person is not None
            return Visitor(key, node, known, since=now, seen=now, linked=True, faces=known, moving=True)
        if person is not None and before is None and item not in (None, name):
            key = None  # the platform says that its user is somebody else
    node = person or ontology.Node("Person")
    if key is None:
        key = f"{KEY}{1 + max((int(k[len(KEY) :]) for k in (*users, *here) if k.startswith(KEY)), default=0)}"
        one = Visitor(key, node, person is not None, since=now, seen=now, faces=person is not None)
        users.add(key, one.item)
        return one
    one = Visitor(key, ontology.Node("Person"), since=now, seen=now, linked=True)
    return one if person is None else _recognised(ctx, one, person)


def _recognised(ctx: rs.RuleContext, one: Visitor, person: ontology.Node) -> Visitor:
    """Return a visitor as a person in memory, and tell the other modules."""
    one = replace(one, node=person, known=True, faces=True)
    if one.item is not None and not one.moving:
        ctx[interloc.users].add(one.key, one.item)
        ctx.emit(interloc.recognised, rs.Entry(one.key, one.item))
    return one


@module.rule(
    when=interloc.users.removed.min_age(0.5).max_age(None).detached(),
    writes=(visitors, interloc.users),
    detached=True,
    background=True,
)
async def move_up(ctx: rs.RuleContext) -> rs.Resign | None:
    """Give a platform's user back, who is another person now. Until then, the other modules end with the person before."""
    key = ctx.payload(interloc.users.removed).key
    one = ctx[visitors].get(key)
    if one is None or not one.moving:
        return rs.Resign("nobody takes the place of this user")
    ctx[visitors].add(key, replace(one, moving=False))
    ctx[interloc.users].add(key, one.item)
    return None


@module.rule(when=looked.max_age(None), writes=(visitors, interloc.users), emits=left, background=True)
async def leave(ctx: rs.RuleContext) -> rs.Resign | None:
    """Note who has left."""
    settings: Settings = ctx.settings
    absent = gone(ctx[visitors], ctx.payload(looked).time, settings.gone_after)
    if not absent:
        return rs.Resign("nobody has left")
    for one in absent:
        ctx[visitors].remove(one.key)
        if not one.linked:
            ctx[interloc.users].remove(one.key)
        ctx.emit(left, one)
    return None


# ------------------------------------------------------------------------------------ names


@module.rule(
    when=interloc.users.changed.max_age(None).detached(),
    reads=interloc.users,
    writes=(visitors, history),
    emits=named,
    detached=True,
    background=True,
)
async def learn_name(ctx: rs.RuleContext) -> rs.Resign | None:
    """Keep the node of a visitor whose name another module has learnt, and raise `named`."""
    key = ctx.payload(interloc.users.changed).key
    here = ctx[visitors]
    one, item = here.get(key), ctx[interloc.users].get(key)
    if one is None:
        return rs.Resign("the agent does not see this user")
    if not item:
        if one.known:  # they are not the person whom the agent took them for
            ctx[history] = ()
            mistaken = one.mistaken | {one.node.id}
            ctx[visitors].add(
                key, replace(one, node=ontology.Node("Person"), known=False, faces=False, mistaken=mistaken)
            )
        return None
    node = item.node if isinstance(item, interloc.Recognised) else one.node.with_properties(name=str(item))
    if one.known and node.id == one.node.id:
        return rs.Resign("the agent knows this person")
    if one.faces and one.known:
        strangers = [other for other in here.values() if not other.known]
        if len(strangers) == 1:  # of two people, the one whom the agent does not know has told their name
            one = strangers[0]
        else:
            one = replace(one, mistaken=one.mistaken | {one.node.id})
    ctx[visitors].add(one.key, replace(one, node=node, known=True, faces=False))
    ctx.emit(named, node)
    return None


@module.rule(
    when=named.min_age(POLITE).max_age(None).detached() | idle.bored,
    reads=(visitors, ontology.memory, asking),
    writes=(verbaliser.intent, rawio.output, visitors, asking, asked_at),
    weight=1.3,  # outranks the other questions out of boredom
    cooldown=20.0,
    detached=True,
    background=True,
)
async def ask_leave(ctx: rs.RuleContext) -> rs.Resign | None:
    """Ask a person who has told their name whether the agent may remember their face."""
    if not ctx.settings.ask:
        return rs.Resign("visionio.ask is off")
    memory = ctx[ontology.memory]
    one = next(
        (one for one in ctx[visitors].values() if one.item and not one.faces and one.good(ctx.settings.quality)), None
    )
    if one is None or memory is None:
        return rs.Resign("there is nobody to ask, or no memory")
    if ctx[asking]:
        return rs.Resign("the agent has asked somebody else")
    ctx[visitors].add(one.key, replace(one, faces=True))
    try:
        present = await memory.together(lambda graph: _has_faces(graph, one.node))
    except RavestateError as error:
        return rs.Resign(f"memory failed: {error}")
    if present:
        return rs.Resign("memory has their face")
    ctx[asking], ctx[asked_at] = one.key, ctx.now
    ctx[verbaliser.intent] = Intent("ask_leave", {"name": one.name}, __package__)
    return None


def _has_faces(graph: ontology.Graph, person: ontology.Node) -> bool:
    return graph.get(person.id) is not None and bool(people.faces_of(graph, person))


@module.rule(
    when=rawio.input.changed,
    reads=(asked_at, visitors, history),
    writes=asking,
    emits=(agreed, refused, withdrawn),
)
async def listen(ctx: rs.RuleContext) -> None:
    """Notice the answer to the question, and the wish that the agent remember or forget a face."""
    text = ctx.payload(rawio.input.changed)
    key = ctx[asking] if ctx.now - ctx[asked_at] <= ANSWERED else ""
    wish = await asyncio.to_thread(wish_of, text)
    answer = yesno_of(text)
    front = in_front(ctx[visitors], ctx[history])
    if wish:
        ctx.emit(withdrawn if wish == "forget" else agreed, front.key if front else "")
    elif key and answer and not answer.unsure:
        ctx.emit(agreed if answer.yes and not answer.no else refused, key)
    else:
        return
    ctx[asking] = ""


@module.rule(when=agreed, reads=ontology.memory, writes=(verbaliser.intent, visitors, interloc.users), weight=2.0)
async def store(ctx: rs.RuleContext) -> None:
    """File the vectors of a person who agrees."""
    settings: Settings = ctx.settings
    one, memory = ctx[visitors].get(ctx.payload(agreed)), ctx[ontology.memory]
    meant, name = "no_memory", one.name if one else None
    vectors = one.good(settings.quality) if one else ()
    if one is None or not vectors:
        meant = "not_seen"
    elif name is None:
        meant = "no_name"
    elif memory is not None:
        try:
            node, _ = await memory.together(lambda graph: people.keep(graph, one.node, vectors, settings.most))
        except RavestateError as error:
            ctx.log.error("%s", error)
        else:
            ctx[visitors].add(one.key, replace(one, node=node, known=True, faces=True))
            meant = "kept"
    ctx[verbaliser.intent] = Intent(meant, {"name": name}, __package__)


@module.rule(when=refused, reads=visitors, writes=verbaliser.intent, weight=1.9)
async def respect(ctx: rs.RuleContext) -> None:
    """Accept that a person does not want the agent to remember their face."""
    one = ctx[visitors].get(ctx.payload(refused))
    ctx[verbaliser.intent] = Intent("not_kept", {"name": one.name if one else None}, __package__)


@module.rule(when=withdrawn, reads=ontology.memory, writes=(verbaliser.intent, visitors, history), weight=4.0)
async def forget(ctx: rs.RuleContext) -> None:
    """Remove a person's faces from memory."""
    one, memory = ctx[visitors].get(ctx.payload(withdrawn)), ctx[ontology.memory]
    meant = "not_seen"
    if one is not None:
        try:
            removed = 0 if memory is None else await memory.together(lambda graph: people.forget_faces(graph, one.node))
            meant = "forgotten" if removed else "had_none"
        except RavestateError as error:
            ctx.log.error("%s", error)
            meant = "no_memory"
        else:
            ctx[history] = ()
            ctx[visitors].add(one.key, replace(one, faces=True, vectors=()))  # do not ask again
    ctx[verbaliser.intent] = Intent(meant, {"name": one.name if one else None}, __package__)


@module.rule(
    when=interloc.forgotten.max_age(None).detached(), reads=ontology.memory, writes=(visitors, history), background=True
)
async def forget_person(ctx: rs.RuleContext) -> None:
    """Take visitors for strangers whom memory has forgotten."""
    memory = ctx[ontology.memory]
    ctx[history] = ()
    for one in ctx[visitors].values():
        if one.known and (memory is None or await memory.get(one.node.id) is None):
            stranger = replace(one, node=ontology.Node("Person"), known=False, faces=True, vectors=())
            ctx[visitors].add(one.key, stranger)


@module.rule(when=left.max_age(None).detached(), reads=ontology.memory, background=True)
async def refresh(ctx: rs.RuleContext) -> rs.Resign | None:
    """After a visit, file a vector of a person who has agreed before, because people change."""
    settings: Settings = ctx.settings
    one, memory = ctx.payload(left), ctx[ontology.memory]
    vectors = one.good(max(0.7, settings.quality))[:1]
    if memory is None or not one.known or one.mistaken or not vectors:
        return rs.Resign("there is nothing to file")

    def file(graph: ontology.Graph) -> None:
        if _has_faces(graph, one.node):
            people.keep(graph, one.node.with_properties(), vectors, settings.most)

    try:
        await memory.together(file)
    except RavestateError as error:
        ctx.log.warning("%s", error)
    return None
