"""The rules of charades. The agent offers the game, recognises the user's moves, and carries them out."""

from __future__ import annotations

import asyncio
from collections import defaultdict
from collections.abc import Iterable, Mapping
from dataclasses import replace

import ravestate as rs
from ravestate.language.bundled import ModelMissing, warn_once
from ravestate.modules import activity, agenda, emotion, interloc, nlp, rawio, verbaliser
from ravestate.modules.meta.verbaliser.intents import Intent
from ravestate.modules.modality.emotion.feeling import Feeling

from .game import Game, Outcome, World, guessed, moves_of, play
from .names import (
    Settings,
    abandoned,
    begun,
    called,
    counted,
    declined,
    game,
    gestures,
    gone,
    invited,
    module,
    moved,
    perform,
    prompted,
    sightings,
    spoken,
    strayed,
    watched,
)
from .understanding import Move, load, understand

TOPIC = "charades"
FEELINGS: dict[Feeling, rs.Signal[None]] = {
    "shy": emotion.shy,
    "surprised": emotion.surprised,
    "happy": emotion.happy,
    "affectionate": emotion.affectionate,
    "sad": emotion.sad,
}
PRIORITY = 40.0
"""The weight of the answers in a game. These answers outrank all others, such as agentqa's answer to "stop"."""
JUST = 0.1
"""Speech that ended at most this many seconds ago counts as the last word of the countdown."""
SPEAKING = 6.0
"""The agent waits at most this many seconds until the user has heard the last word of the countdown."""


def is_on(now: Game) -> bool:
    """Return whether a game is on, or the agent has offered a game."""
    return now.is_on


def is_empty(users: Mapping[str, object]) -> bool:
    """Return whether no user is left."""
    return not users


def is_waiting(now: Game) -> bool:
    """Return whether a countdown must stop, because the agent waits for a move, or because no game is on."""
    return now.is_waiting or not now.is_on


@module.rule(when=rs.startup, background=True)
def learn(ctx: rs.RuleContext) -> None:
    """Learn the examples. Until that is done, only words that equal an example are recognised."""
    try:
        load()
    except ModelMissing as error:
        warn_once(ctx.log, error)


# ------------------------------------------------------------------------------------- the offer

offer = agenda.goal(
    module,
    "offer",
    intent=Intent("offer", package=__package__),
    unless=game.holds(is_on),
    cooldown=120.0,
    done=begun,
    refused=declined,
)
"""The goal to play: the agent offers the game when it is bored."""


@module.rule(
    when=offer.pursued.max_age(None).detached(),
    writes=(game, agenda.topics),
    emits=prompted,
    detached=True,
)
async def note_offer(ctx: rs.RuleContext) -> rs.Resign | None:
    """Wait for the answer, after the bored agent has offered a game."""
    if ctx[game].is_on:
        return rs.Resign("the user has prompted the offer")  # `propose` waits for the answer
    turn = ctx[game].turn + 1
    ctx[game] = Game("offered", turn=turn)
    ctx[agenda.topics].add(TOPIC, "a game of charades")
    ctx.emit(prompted, turn)
    return None


# ------------------------------------------------------------------------------- the user's moves


@module.rule(when=nlp.analysis.changed, reads=(game, activity.known), writes=strayed, emits=(moved, invited, abandoned))
async def listen(ctx: rs.RuleContext) -> rs.Resign | None:
    """Emit the user's move, if the words are a move. Leave words about something else to the other skills."""
    seen = ctx.payload(nlp.analysis.changed)
    now = ctx[game]
    if seen is None:
        return rs.Resign("nothing was analysed")
    move = await asyncio.to_thread(understand, seen, moves_of(now.step), ctx[activity.known])
    if move is not None and move.kind == "play":
        ctx.emit(invited, move)
    elif move is not None and move.kind != "farewell":
        ctx.emit(moved, move)
    elif not now.is_on:
        return rs.Resign("no game is on")
    elif move is not None or now.step == "offered":
        ctx.emit(abandoned)
    else:
        ctx[strayed] = ctx.now
    return None


# The slots that an answer in the game writes, the signals that it emits, and the slots that it reads.
EFFECTS = (game, verbaliser.intent, rawio.output, agenda.topics)
EMITTED = (prompted, counted, begun, declined, perform, activity.taught, *FEELINGS.values())
SURROUNDINGS = (gestures, activity.in_view)


@module.rule(when=moved, reads=SURROUNDINGS, writes=EFFECTS, emits=EMITTED, detached=True, weight=PRIORITY)
async def answer(ctx: rs.RuleContext) -> None:
    """Answer the user's move."""
    carry_out(ctx, play(ctx[game], ctx.payload(moved), world_of(ctx)))


@module.rule(
    when=invited,
    reads=SURROUNDINGS,
    writes=(*EFFECTS, agenda.goals),
    emits=EMITTED,
    detached=True,
    weight=2.5,  # this rule outranks small talk about boredom
)
async def propose(ctx: rs.RuleContext) -> None:
    """Offer charades to a user who wants to play, or is bored.

    This offer counts as a try of the goal. So if it lapses, the bored agent waits before it offers the game again.
    """
    before = ctx[game]
    carry_out(ctx, play(before, ctx.payload(invited), world_of(ctx)))
    state = ctx[agenda.goals].get(offer.name, agenda.GoalState())
    if not before.is_on and not state.is_over:
        ctx[agenda.goals].add(offer.name, agenda.GoalState("pursued", state.tries + 1, ctx.now))


def carry_out(ctx: rs.RuleContext, out: Outcome) -> None:
    """Write the slots and emit the signals of an outcome."""
    before, after = ctx[game], out.game
    ctx[game] = after
    if out.say:
        ctx[verbaliser.intent] = Intent(out.say, out.words, __package__)
    if out.feeling is not None:
        ctx.emit(FEELINGS[out.feeling])
    if out.lesson:
        ctx.emit(activity.taught, activity.Lesson(out.lesson, before.start, before.end))
    if out.performs:
        ctx.emit(perform, out.performs)
    if after.is_on:
        ctx[agenda.topics].add(TOPIC, "a game of charades")
        if before.step in ("off", "offered") and after.step != "offered":
            ctx.emit(begun)
    elif TOPIC in ctx[agenda.topics]:
        ctx[agenda.topics].remove(TOPIC)
        if out.say == "declined":  # an offer that lapses is no refusal
            ctx.emit(declined)
    if out.counts:
        ctx.emit(counted)
    if after.is_waiting:
        ctx.emit(prompted, after.turn)
    else:
        ctx.wipe(prompted)


def world_of(ctx: rs.RuleContext) -> World:
    """Return the surroundings of the game."""
    return World(ctx.random, ctx[gestures], ctx[activity.in_view])


# ------------------------------------------------------------------- countdown, watching, guessing


@module.rule(
    when=counted.max_age(None),
    reads=rawio.heard,
    writes=(game, sightings, verbaliser.intent, rawio.output),
    emits=(called, gone),
    until=game.changed.where(is_waiting),
    detached=True,
)
async def count_down(ctx: rs.RuleContext) -> None:
    """Count down from three. If the agent speaks by voice, wait for the end of the last word."""
    settings: Settings = ctx.settings
    ctx[sightings] = ()
    heard = ctx[rawio.heard].strip()
    voiced = heard != "" and ctx[rawio.output].strip().startswith(heard)
    for n in (3, 2, 1):
        ctx[verbaliser.intent] = Intent("count", {"n": n}, __package__)
        await ctx.sleep(settings.count)
    ctx[verbaliser.intent] = Intent("go", package=__package__)
    ctx.emit(called if voiced else gone, ctx[game].turn)


@module.rule(
    when=rawio.heard.changed.max_age(None).detached() & game.holds(is_on),
    reads=rawio.output,
    emits=spoken,
    detached=True,
    background=True,
)
async def notice_end_of_speech(ctx: rs.RuleContext) -> rs.Resign | None:
    """Note that the user has heard all that the agent has said."""
    if ctx.payload(rawio.heard.changed).strip() != ctx[rawio.output].strip():
        return rs.Resign("the agent has said more, or was interrupted")
    ctx.emit(spoken)
    return None


@module.rule(
    when=called.max_age(None) & spoken.max_age(JUST) | called.min_age(SPEAKING).max_age(None), emits=gone, detached=True
)
async def hear_out(ctx: rs.RuleContext) -> None:
    """Begin to watch when the user has heard the last word of the countdown."""
    ctx.emit(gone, ctx.payload(called))


@module.rule(when=gone.max_age(None), writes=game, emits=watched, until=game.changed.where(is_waiting), detached=True)
async def watch(ctx: rs.RuleContext) -> rs.Resign | None:
    """Watch for some seconds."""
    settings: Settings = ctx.settings
    now = ctx[game]
    if (now.step, now.turn) != ("counting", ctx.payload(gone)):
        return rs.Resign("the countdown has been called off")
    ctx[game] = replace(now, step="watching", start=ctx.now)
    await ctx.sleep(settings.watch)
    ctx[game] = replace(ctx[game], end=ctx.now)
    ctx.emit(watched)
    return None


@module.rule(
    when=activity.recognised.max_age(None).detached(),
    reads=game,
    writes=sightings,
    detached=True,
    background=True,
)
async def see(ctx: rs.RuleContext) -> rs.Resign | None:
    """Note an activity during the countdown, or while the agent watches."""
    step = ctx[game].step
    if step not in ("counting", "watching"):
        return rs.Resign("the agent does not watch now")
    ctx[sightings] = (*ctx[sightings], (step == "watching", ctx.payload(activity.recognised)))
    return None


@module.rule(
    when=watched.max_age(None),
    reads=(sightings, activity.in_view),
    writes=(game, verbaliser.intent, rawio.output),
    emits=(prompted, *FEELINGS.values()),
    detached=True,
)
async def guess(ctx: rs.RuleContext) -> rs.Resign | None:
    """Say the first guess."""
    if ctx[game].step != "watching":
        return rs.Resign("the game has been stopped")
    seen = ctx[sightings]
    while_watching = [one for at_work, one in seen if at_work]
    out = guessed(
        ctx[game], ranked(while_watching or [one for _, one in seen]), World(ctx.random, in_view=ctx[activity.in_view])
    )
    ctx[game] = out.game
    ctx[verbaliser.intent] = Intent(out.say, out.words, __package__)
    if out.feeling is not None:
        ctx.emit(FEELINGS[out.feeling])
    ctx.emit(prompted, out.game.turn)
    return None


def ranked(seen: Iterable[activity.Activity]) -> tuple[str, ...]:
    """Return the names of the seen activities, the most probable first."""
    total: defaultdict[str, float] = defaultdict(float)
    for one in seen:
        total[one.name] += one.confidence
        for other, confidence in one.others.items():
            total[other] += confidence
    return tuple(sorted(total, key=total.__getitem__, reverse=True))


# -------------------------------------------------------------------------------- silence, asides


@module.rule(
    when=prompted.min_age(Settings.patience).max_age(None),
    reads=SURROUNDINGS,
    writes=EFFECTS,
    emits=EMITTED,
    detached=True,
)
async def remind(ctx: rs.RuleContext) -> rs.Resign | None:
    """After a silence, ask again. After a second silence, end the game.

    In the step ``choosing``, start the countdown. In the step ``offered``, end the game without a word.
    """
    if ctx[game].turn != ctx.payload(prompted):
        return rs.Resign("the game has gone on")
    carry_out(ctx, play(ctx[game], Move("silence"), world_of(ctx)))
    return None


@module.rule(
    when=(rawio.typing.detached() | rawio.hearing.detached()) & game.holds(is_on),
    reads=game,
    emits=prompted,
    detached=True,
    background=True,
)
async def be_patient(ctx: rs.RuleContext) -> rs.Resign | None:
    """Keep waiting while the user types or speaks."""
    now = ctx[game]
    if not now.is_waiting:
        return rs.Resign("the agent does not wait for the user")
    ctx.emit(prompted, now.turn)
    return None


@module.rule(
    when=strayed.changed.min_age(Settings.aside).max_age(None).detached(),
    reads=strayed,
    writes=(game, verbaliser.intent, rawio.output),
    emits=prompted,
    until=rawio.input.changed,
    detached=True,
    background=True,
)
async def resume(ctx: rs.RuleContext) -> rs.Resign | None:
    """Return to the game `aside` seconds after the user's words on something else.

    Wait until no foreground rule runs or waits.
    """
    turn = ctx[game].turn
    await ctx.quiet()
    now = ctx[game]
    if now.turn != turn or not now.is_waiting or ctx[strayed] != ctx.payload(strayed.changed):
        return rs.Resign("the game has gone on")
    ctx[verbaliser.intent] = Intent(now.question, now.words, __package__)
    ctx.emit(prompted, now.turn)
    return None


@module.rule(
    when=abandoned.max_age(None).detached()
    | (interloc.users.removed.max_age(None).detached() & interloc.users.holds(is_empty)),
    writes=(game, agenda.topics),
    detached=True,
    background=True,
)
async def end(ctx: rs.RuleContext) -> rs.Resign | None:
    """End the game without a word: the user has said goodbye or left, or ignores the offer."""
    now = ctx[game]
    if not now.is_on:
        return rs.Resign("no game is on")
    ctx[game] = Game(turn=now.turn + 1)
    ctx[agenda.topics].remove(TOPIC)
    ctx.wipe(prompted)
    return None
