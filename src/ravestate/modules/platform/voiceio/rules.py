"""The rules of a spoken conversation: listening, turns, speaking, interruptions."""

from __future__ import annotations

import asyncio
import importlib
from typing import TYPE_CHECKING

import ravestate as rs
from ravestate.errors import PlatformError
from ravestate.modules import rawio, verbaliser
from ravestate.modules.meta.verbaliser.intents import Intent

from .feelings import add_feelings
from .following import follow
from .names import (
    Settings,
    agent_speaking,
    another_speaks,
    back_channel,
    barge_in,
    conversation,
    false_alarm,
    held,
    module,
    prosody,
    speech,
    spoke_up,
    user_speaking,
    utterance,
)
from .utterances import Utterance

if TYPE_CHECKING:
    from .opening import Conversation


# ------------------------------------------------------------------------------------ listening


@module.rule(
    when=rs.startup.detached() | rawio.sound.changed.max_age(None).detached(),
    reads=rawio.sound,
    writes=(conversation, user_speaking),
    emits=(spoke_up, another_speaks),
    until=rawio.sound.changed,
    detached=True,  # each onset is a separate cause
    background=True,
)
async def listen(ctx: rs.RuleContext) -> rs.Resign | None:
    """Open the line. Note when the user begins to speak or pauses, and when another person begins to speak.

    A line is a microphone and a loudspeaker. Raise ``spoke_up`` as soon as the sound is certainly speech, not a hum or
    a cough.
    """
    settings: Settings = ctx.settings
    line = ctx[rawio.sound]
    if line is None and _is_served(ctx):
        return rs.Resign("the user's platform has no line in rawio.sound now")
    if line is not None and ctx.payload(rawio.sound.changed) is None:
        return rs.Resign("another run of this rule listens to the new line")

    def warn(text: str) -> None:
        ctx.log.warning("%s", text)

    try:
        parts = await asyncio.to_thread(importlib.import_module, f"{__package__}.opening")
        talk: Conversation = await parts.open_conversation(line, settings, warn)
    except (PlatformError, ImportError) as error:
        fault = error if isinstance(error, PlatformError) else PlatformError(f"{error}: pip install 'ravestate[voice]'")
        if line is None:
            ctx.stop(fault)  # without speech, nobody could talk to the agent
        else:
            ctx.log.error("%s", fault)
        return None
    add_feelings(ctx)
    ctx[conversation] = talk
    try:
        await follow(ctx, talk)
    finally:
        ctx[user_speaking] = False
        ctx[conversation] = None
        fault = None
        try:
            talk.close(linger=line is not None)  # a page may open its microphone again
        except PlatformError as error:
            fault = error
            ctx.log.error("%s", fault)
        if line is None:
            ctx.stop(fault)
    return None


def _is_served(ctx: rs.RuleContext) -> bool:
    """Return whether a platform with many users runs this context. If so, the user is not at this machine's devices."""
    return any(each.serve is not None for each in ctx.policy.modules)


@module.rule(
    when=user_speaking.true.detached(),
    reads=conversation,
    emits=rawio.hearing,
    until=user_speaking.false,
    detached=True,
    background=True,
)
async def caption(ctx: rs.RuleContext) -> rs.Resign | None:
    """Show the words so far while the user speaks."""
    settings: Settings = ctx.settings
    talk = ctx[conversation]
    if talk is None or not settings.captions:
        return rs.Resign("captions are off, or the line is closed")
    while True:
        await ctx.sleep(settings.captions)
        if (turn := talk.ear.turn) is None or talk.recogniser.busy:
            continue
        try:
            found = await talk.words(turn.sound, partial=True)
        except PlatformError as error:
            if talk.closed:  # the recogniser failed because closing the line has ended its process
                return rs.Resign("the line is closed")
            ctx.log.warning("%s", error)
            continue
        if found.text:
            ctx.emit(rawio.hearing, found.text)


@module.rule(
    when=user_speaking.false.detached(),
    reads=conversation,
    emits=(utterance, back_channel, false_alarm, barge_in, rawio.hearing),
    until=user_speaking.true,
)
async def take_turn(ctx: rs.RuleContext) -> rs.Resign | None:
    """Recognise the words at a pause, and wait until the turn is over. If the user speaks again, the turn continues."""
    talk = ctx[conversation]
    if talk is None or (turn := talk.ear.turn) is None:
        return rs.Resign("the line is closed")
    try:
        found, silence = await talk.judge(turn)
    except PlatformError as error:
        if talk.closed:
            return rs.Resign("the line is closed")
        ctx.log.error("%s", error)
        talk.ear.take()
        ctx.emit(utterance, Utterance("", 0.0, turn.start, turn.end))
        return None
    await ctx.sleep(turn.end + silence - ctx.now)
    talk.ear.take()
    what, text = talk.verdict(turn, found)
    if what == "utterance":
        if talk.mouth.held:
            ctx.emit(barge_in)
        ctx.emit(rawio.hearing, text)
        ctx.emit(utterance, Utterance(text, found.confidence, turn.start, turn.end))
    elif what == "back_channel":
        ctx.emit(back_channel, text)
    else:
        ctx.emit(false_alarm, text)
    return None


@module.rule(when=another_speaks, reads=conversation, emits=(utterance, false_alarm))
async def take_first_turn(ctx: rs.RuleContext) -> rs.Resign | None:
    """Handle the words of the first person, after two people have spoken in one turn.

    The words of two people are not one sentence, so each person gets a turn.
    """
    talk, turn = ctx[conversation], ctx.payload(another_speaks)
    if talk is None:
        return rs.Resign("the line is closed")
    try:
        found, _ = await talk.judge(turn)
    except PlatformError as error:
        if talk.closed:
            return rs.Resign("the line is closed")
        ctx.log.error("%s", error)
        return None
    what, text = talk.verdict(turn, found)
    if what == "utterance":
        ctx.emit(utterance, Utterance(text, found.confidence, turn.start, turn.end))
    else:
        ctx.emit(false_alarm, text)
    return None


@module.rule(when=utterance, writes=rawio.input)
async def understand(ctx: rs.RuleContext) -> rs.Resign | None:
    """If the recogniser is confident, pass on the user's words."""
    said = ctx.payload(utterance)
    if _is_unclear(said, ctx.settings):
        return rs.Resign(f"the recogniser's confidence is {said.confidence:.2f}")
    ctx[rawio.input] = said.text
    return None


@module.rule(when=utterance, writes=verbaliser.intent)
async def ask_back(ctx: rs.RuleContext) -> rs.Resign | None:
    """If the recogniser is not confident, ask the user to repeat their words."""
    said = ctx.payload(utterance)
    if not _is_unclear(said, ctx.settings):
        return rs.Resign("the words are clear")
    ctx[verbaliser.intent] = Intent("unclear", package=__package__)
    return None


def _is_unclear(said: Utterance, settings: Settings) -> bool:
    """Return whether the agent asks back. After a failure of the recogniser, there are no words at all."""
    return not said.text or said.confidence < settings.ask_back_below


# ------------------------------------------------------------------------------------ speaking


@module.rule(when=rawio.piece.max_age(None).detached(), reads=conversation, emits=speech, background=True)
async def speak_early(ctx: rs.RuleContext) -> rs.Resign | None:
    """Speak an utterance while it grows: each sentence as soon as it is complete."""
    from .mouth import Speech

    if (talk := ctx[conversation]) is None:
        return rs.Resign("the line is closed")
    growing = talk.mouth.growing
    if growing is None:
        growing = talk.mouth.growing = Speech()
        ctx.emit(speech, growing)
    growing.grow(ctx.payload(rawio.piece))
    return None


@module.rule(
    when=rawio.output.changed.max_age(None).detached(),
    reads=(conversation, rawio.speaking),
    writes=rawio.heard,
    emits=speech,
    background=True,
)
async def speak(ctx: rs.RuleContext) -> rs.Resign | None:
    """Speak a complete utterance, or the rest of a growing utterance."""
    from .mouth import Speech
    from .sentences import speakable

    text = ctx.payload(rawio.output.changed)
    if (talk := ctx[conversation]) is None:
        return rs.Resign("the line is closed")
    growing = talk.mouth.growing
    rest = None if growing is None else rawio.rest(text, growing.text)
    # If no rule sets `rawio.speaking`, only a `text` that does not continue `growing` shows that `growing` has ended.
    if growing is not None and (rest is not None or not ctx[rawio.speaking]):
        talk.mouth.growing = None
        growing.grow(rest or "")
        growing.finish()
        if growing.over and rest is not None:  # the utterance was cut off while it grew; note the heard part now
            ctx[rawio.heard] = growing.heard
    if rest is None and speakable(text):
        ctx.emit(speech, Speech(text, whole=True))
    return None


@module.rule(when=rawio.speaking.false.max_age(None).detached(), reads=conversation, background=True)
async def end_growing(ctx: rs.RuleContext) -> rs.Resign | None:
    """End a growing utterance when no rule continues it."""
    talk = ctx[conversation]
    if talk is None or talk.mouth.growing is None:
        return rs.Resign("no utterance grows")
    talk.mouth.growing.finish()
    talk.mouth.growing = None
    return None


@module.rule(
    when=speech.max_age(None).detached(),
    reads=(conversation, prosody),
    writes=(agent_speaking, held, rawio.heard),
    until=barge_in | utterance | rawio.hush | conversation.changed | rs.shutdown,
)
async def voice_it(ctx: rs.RuleContext) -> rs.Resign | None:
    """Speak an utterance sentence by sentence. At the end, note what the user heard of it, unless it is a filler."""
    talk, saying, manner = ctx[conversation], ctx.payload(speech), ctx[prosody]
    if talk is None:
        return rs.Resign("the line is closed")
    mouth, failed = talk.mouth, False
    try:
        async with mouth.turn:
            try:
                mouth.begin()
                async for place, sentence in saying.sentences():
                    if failed or not (words := mouth.words(sentence)):
                        continue
                    try:
                        spoken = await asyncio.to_thread(mouth.voice.speak, words, manner)
                    except PlatformError as error:
                        ctx.log.error("%s", error)
                        failed = True  # from now on, the user only reads the text
                        continue
                    mouth.queue(spoken, place)
                    if not mouth.speaking:
                        mouth.speaking, saying.start = True, ctx.now
                        if talk.ear.speaking:  # the user has begun to speak before the agent
                            mouth.hold(ctx.now)
                            ctx[held] = True
                        else:
                            ctx[agent_speaking] = True
                    await mouth.room()
                await mouth.played_out()
                saying.heard = saying.text.strip()
            except asyncio.CancelledError:
                saying.heard = saying.text.strip() if failed else mouth.heard(saying.text)
                raise
            finally:
                saying.end = ctx.now if mouth.silent_since is None else mouth.silent_since
                if saying.start is None:
                    saying.start = saying.end
                mouth.stop()
                ctx[agent_speaking] = False
                ctx[held] = False
    finally:
        saying.over = True
        if saying.counts:
            ctx[rawio.heard] = saying.heard
    return None


# ------------------------------------------------------------------------------------ interruptions


@module.rule(
    when=spoke_up.max_age(0.0).detached() & agent_speaking.holds(bool),
    reads=conversation,
    writes=(held, agent_speaking),
    background=True,
)
async def hold(ctx: rs.RuleContext) -> rs.Resign | None:
    """Pause the agent's speech when the user speaks up."""
    talk = ctx[conversation]
    if talk is None or not talk.mouth.speaking:
        return rs.Resign("the agent does not speak")
    talk.mouth.hold(ctx.now)
    ctx[agent_speaking] = False
    ctx[held] = True
    return None


@module.rule(
    when=held.true.max_age(None).detached() | spoke_up.max_age(0.0).detached() & held.holds(bool),
    emits=barge_in,
    until=held.false | user_speaking.false,
    background=True,
)
async def give_way(ctx: rs.RuleContext) -> None:
    """End the agent's utterance if the user keeps speaking for the seconds in the setting `back_channel`.

    An "mhm" is shorter than that.
    """
    await ctx.sleep(ctx.settings.back_channel)
    ctx.emit(barge_in)


@module.rule(
    when=(back_channel.max_age(0.0).detached() | false_alarm.max_age(0.0).detached()) & held.holds(bool),
    reads=conversation,
    writes=(held, agent_speaking),
    background=True,
)
async def resume(ctx: rs.RuleContext) -> rs.Resign | None:
    """Continue the paused speech, because the user did not interrupt."""
    talk = ctx[conversation]
    if talk is None or not talk.mouth.held:
        return rs.Resign("nothing is held")
    talk.mouth.release()
    ctx[held] = False
    ctx[agent_speaking] = True
    return None


@module.rule(
    when=utterance.max_age(0.0).detached(),
    reads=conversation,
    emits=speech,
    until=speech | user_speaking.true | rs.activity.false,
    background=True,
)
async def fill_pause(ctx: rs.RuleContext) -> rs.Resign | None:
    """Say a filler when the answer is slow."""
    settings: Settings = ctx.settings
    if not settings.filler_after or not settings.fillers or (talk := ctx[conversation]) is None:
        return rs.Resign("fillers are off, or the line is closed")
    from .mouth import Speech

    await ctx.sleep(settings.filler_after)
    if not talk.mouth.speaking:
        ctx.emit(speech, Speech(ctx.random.choice(settings.fillers), whole=True, counts=False))
    return None
