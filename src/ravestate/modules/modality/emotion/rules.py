"""The rules that raise feelings and show them as emoji."""

from __future__ import annotations

import contextlib

import ravestate as rs
from ravestate.language.acts import heard, is_playful
from ravestate.language.addressing import addressed
from ravestate.language.bundled import ModelMissing, warn_once
from ravestate.language.feelings import SORROW_LASTS
from ravestate.language.loading import wait_for_prompt
from ravestate.language.matcher import bundled_matcher
from ravestate.modules import interloc, rawio

from .chance import OCCASIONS, by_chance
from .feeling import EMOJI, Feeling
from .names import Settings, affectionate, felt, happy, module, sad, shy, sorrow, surprised
from .recogniser import recognise, sorrowful

CHEERFUL: frozenset[Feeling] = frozenset({"happy", "surprised"})
"""Feelings that are not raised while the user is sad, because they would hurt the user."""

SIGNALS: dict[Feeling, rs.Signal[None]] = {
    "shy": shy, "surprised": surprised, "happy": happy, "affectionate": affectionate, "sad": sad,
}  # fmt: skip


@module.rule(when=rs.startup, background=True)
def learn(ctx: rs.RuleContext) -> None:
    """Load the matchers, which compare sentences with examples, in the background, before the first words."""
    wait_for_prompt()
    try:
        for name in ("acts", "feelings"):
            bundled_matcher(name).load()
    except ModelMissing as error:
        warn_once(ctx.log, error)


@module.rule(when=rawio.input.changed, reads=(interloc.agent, sorrow), writes=sorrow, emits=SIGNALS.values())
def be_moved(ctx: rs.RuleContext) -> None:
    """Raise the feeling that fits the user's words, or a spontaneous feeling.

    After words of sorrow, the next few utterances raise neither a cheerful nor a spontaneous feeling. The sentence
    model takes a few milliseconds, so this rule runs in a thread. Without the model, only sentences that equal an
    example raise a feeling that fits them.
    """
    settings: Settings = ctx.settings
    text = ctx.payload(rawio.input.changed)
    names = settings.names or (ctx[interloc.agent],)
    feeling: Feeling | None = None
    left = max(0, ctx[sorrow] - 1)
    with contextlib.suppress(ModelMissing):  # `learn` reports the missing model
        feeling = recognise(text, names)
        left = SORROW_LASTS if sorrowful(text, names) else left
    if feeling is None and not left:
        likely: dict[Feeling, float] = {name: getattr(settings, name) for name in OCCASIONS}
        said = [addressed(sentence, names) for sentence in heard(text, names)]
        feeling = by_chance(said, likely, ctx.random)
    if feeling == "sad" and is_playful(text):
        feeling = None  # "you are hopeless lol" hurts nobody
    ctx[sorrow] = left
    if feeling is not None and not (left and feeling in CHEERFUL):
        ctx.emit(SIGNALS[feeling])


def note(feeling: Feeling) -> None:
    """Declare the rule that writes a feeling to `felt` when any rule has raised its signal."""

    @module.rule(
        when=SIGNALS[feeling].max_age(None).detached(),
        writes=felt,
        detached=True,
        background=True,
        name=f"feel_{feeling}",
    )
    async def feel(ctx: rs.RuleContext) -> None:
        ctx[felt] = feeling


for each in SIGNALS:
    note(each)


@module.rule(
    when=felt.changed.max_age(None).detached(),  # detached, so that the emoji does not exclude an answer (law L10)
    writes=rawio.output,
    until=rawio.input.changed | felt.changed,  # the user speaks, or a later feeling shows
    detached=True,
    background=True,
)
async def show(ctx: rs.RuleContext) -> rs.Resign | None:
    """Show the feeling as an emoji after the answer."""
    if not ctx.settings.emoji:
        return rs.Resign("emotion.emoji is off")
    feeling = ctx.payload(felt.changed)
    await ctx.quiet()
    ctx[rawio.output] = ctx.random.choice(EMOJI[feeling])
    return None
