"""The rules that notice silence, delay and the wish for quiet."""

from __future__ import annotations

import asyncio

import ravestate as rs
from ravestate.language.acts import acts, heard
from ravestate.language.feelings import SORROW_LASTS, SORROWS, feelings
from ravestate.language.sentences import sentences
from ravestate.modules import rawio

from .names import Settings, asked, bored, dismissed, hushed, impatient, module, remarked, sorrow, unanswered

QUIET = (rs.activity, dismissed, sorrow, unanswered)
"""The slots that `_reason_for_quiet` reads."""
LONGEST = 1000
"""`notice_question` reads only this many characters, at the end of the agent's words."""


@module.rule(
    when=rs.activity.false.max_age(None) | rs.startup.detached(),
    reads=(*QUIET, asked),
    writes=remarked,
    emits=bored,
    until=rs.activity.true | rawio.typing,
    detached=True,
    background=True,
)
async def notice_silence(ctx: rs.RuleContext) -> rs.Resign | None:
    """Emit `bored` after a long silence, unless the user wants quiet, is sad, or has ignored the last remarks."""
    settings: Settings = ctx.settings
    if reason := _reason_for_quiet(ctx):
        return rs.Resign(reason)
    await ctx.sleep(max(settings.bored_after, settings.answer_time if ctx[asked] else 0.0))
    ctx[remarked] = False
    ctx.emit(bored)
    return None


@module.rule(
    when=rawio.input.changed.detached() | rawio.typing.detached() | rawio.picture.changed.detached(),
    writes=(remarked, unanswered),
    detached=True,
    background=True,
)
async def notice_user(ctx: rs.RuleContext) -> None:
    """Reset the count of remarks, because the user is there."""
    ctx[remarked] = True
    ctx[unanswered] = 0


@module.rule(
    when=rawio.typing.max_age(None),
    reads=QUIET,
    writes=remarked,
    emits=bored,
    until=rs.activity.true | rawio.typing | rawio.input.changed,
    detached=True,
    background=True,
)
async def notice_unfinished_line(ctx: rs.RuleContext) -> rs.Resign | None:
    """Emit `bored` if the user stops in the middle of a line, unless the user wants quiet or is sad."""
    if reason := _reason_for_quiet(ctx):
        return rs.Resign(reason)
    await ctx.sleep(max(ctx.settings.bored_after, ctx.settings.writing_time))
    ctx[remarked] = False
    ctx.emit(bored)
    return None


def _reason_for_quiet(ctx: rs.RuleContext) -> str:
    """Return why the agent may not be bored; an empty text if the agent may be bored."""
    if ctx[rs.activity]:
        return "there is something to do"
    if ctx[dismissed]:
        return "the user wants quiet"
    if ctx[sorrow]:
        return "the user is sad"
    if ctx[unanswered] >= ctx.settings.remarks:
        return "the user has not answered the last remarks"
    return ""


@module.rule(
    when=rs.pressure.true.min_age(Settings.impatient_after).max_age(None),
    emits=impatient,
    detached=True,
    background=True,
)
async def notice_delay(ctx: rs.RuleContext) -> None:
    """Emit `impatient` when ready rules wait too long."""
    ctx.emit(impatient)


@module.rule(when=rawio.input.changed, reads=sorrow, writes=(dismissed, sorrow), emits=hushed)
async def notice_dismissal(ctx: rs.RuleContext) -> None:
    """Note whether the user asks for quiet, says goodbye or is sad. If the user asks for quiet, emit `hushed`.

    The sentence model, which compares meanings, may take a few milliseconds, so it runs in a thread. This is a
    foreground rule, so the silence begins only when the rule ends.
    """
    meant, felt = await asyncio.to_thread(_understood, ctx.payload(rawio.input.changed))
    ctx[dismissed] = bool(meant & {"quiet", "farewell"})
    ctx[sorrow] = SORROW_LASTS if felt & SORROWS else max(0, ctx[sorrow] - 1)
    if "quiet" in meant:
        ctx.emit(hushed)


def _understood(text: str) -> tuple[frozenset[str], frozenset[str]]:
    """Return the conversational acts (such as a goodbye) and the feelings in a text."""
    sentences = heard(text)
    return frozenset(acts(sentences)), frozenset(feelings(sentences))


def _has_words(text: str) -> bool:
    return any(map(str.isalpha, text))


@module.rule(
    when=rawio.output.changed.where(_has_words).max_age(None).detached(),
    writes=(asked, remarked, unanswered),
    detached=True,
    background=True,
)
async def notice_question(ctx: rs.RuleContext) -> None:
    """Note the agent's question, because the user gets more time to answer it.

    If these are the agent's first words since it was bored, count them as a remark.
    """
    said = sentences(ctx.payload(rawio.output.changed)[-LONGEST:])
    ctx[asked] = said[-1] if said and "?" in said[-1] else ""
    if not ctx[remarked]:
        ctx[remarked] = True
        ctx[unanswered] += 1
