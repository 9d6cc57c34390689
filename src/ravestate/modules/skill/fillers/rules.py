"""The rules that fill a pause while the user waits for an answer, with a filler such as "Let me think…"."""

from __future__ import annotations

import ravestate as rs
from ravestate.modules import idle, rawio, verbaliser
from ravestate.modules.meta.verbaliser.intents import Intent

from .names import filled, late, lost, module, promised, waiting

ENOUGH = 5.0
"""The minimum number of seconds between two fillers."""
REMEMBERED = 120.0
"""An output within this many seconds of the words that led to it counts as an answer to those words. A later output
counts as an answer to the user's latest words."""


@module.rule(
    when=rawio.input.changed.detached(),
    reads=filled,
    writes=promised,
    emits=idle.impatient,
    until=rawio.input.changed | waiting.false | rawio.speaking.true | rs.activity.false | idle.impatient,
    detached=True,
    background=True,
)
async def notice_no_answer(ctx: rs.RuleContext) -> None:
    """Raise `impatient` when a rule has run for a while without output.

    This covers a rule that is running. `idle` raises the same signal when a ready rule waits for other rules.
    """
    await ctx.sleep(ctx.settings.unanswered_after)
    last = ctx[filled]
    if last is not None and ctx.now - last < ENOUGH:
        # Too soon for another filler, but the agent still owes an answer: `admit_delay` and `admit_loss` need this flag.
        ctx[promised] = True
    ctx.emit(idle.impatient)


def _silent(speaking: bool) -> bool:
    return not speaking


@module.rule(
    when=idle.impatient.max_age(0.0) & rawio.speaking.holds(_silent),  # not later: the answer may have come by then
    reads=(filled, waiting),
    writes=(verbaliser.intent, filled, promised),
)
async def fill_the_pause(ctx: rs.RuleContext) -> rs.Resign | None:
    """Say a filler if the user waits for an answer, and the agent has not said a filler lately."""
    if not ctx[waiting]:
        return rs.Resign("the user is not waiting for an answer")
    last = ctx[filled]
    if last is not None and ctx.now - last < ENOUGH:
        return rs.Resign(f"a pause was filled {ctx.now - last:.1f} s ago")
    ctx[filled] = ctx.now
    ctx[promised] = True
    ctx[verbaliser.intent] = Intent("filler", package=__package__)
    return None


@module.rule(
    when=rawio.input.changed.max_age(REMEMBERED)
    & rawio.output.changed.max_age(None)  # the user's words, and the agent's answer to them
    | rawio.output.changed.max_age(None)
    | rawio.input.changed.detached()
    | rawio.speaking.true.detached(),
    reads=(rawio.input, rawio.output, rawio.speaking, verbaliser.last, promised),
    writes=(promised, waiting),
    patience=0.0,
    detached=True,
    background=True,
)
async def notice_answer(ctx: rs.RuleContext) -> rs.Resign | None:
    """Record in `promised` and `waiting` that the answer has come or has begun.

    Also record there that the user has said something else.
    """
    said = ctx.payload(rawio.output.changed)
    if said is not None and said in (ctx[verbaliser.last].get("filler"), ctx[verbaliser.last].get("late")):
        return rs.Resign("this is a filler, or the notice of a delay")
    if said is not None and not said.strip():
        return rs.Resign("an empty text is not an answer")
    if said is not None and ctx.payload(rawio.input.changed) not in (None, ctx[rawio.input]):
        return rs.Resign("this answers earlier words of the user")
    ctx[promised] = False
    ctx[waiting] = said is None and bool((ctx.payload(rawio.input.changed) or "").strip())
    return None


@module.rule(when=promised.true.max_age(None), emits=late, until=promised.false, detached=True, background=True)
async def notice_late_answer(ctx: rs.RuleContext) -> None:
    """Raise `late` when the answer takes too long."""
    await ctx.sleep(ctx.settings.answer_within)
    ctx.emit(late)


@module.rule(when=late.max_age(0.0) & promised.holds(bool) & rawio.speaking.holds(_silent), writes=verbaliser.intent)
async def admit_delay(ctx: rs.RuleContext) -> None:
    """Say that the answer takes longer, while a rule that may answer still runs or waits."""
    ctx[verbaliser.intent] = Intent("late", package=__package__)


@module.rule(when=rs.activity.false.max_age(None) & promised.holds(bool), emits=lost, detached=True, background=True)
async def notice_no_rule_left(ctx: rs.RuleContext) -> None:
    """Raise `lost` when no rule is left that could answer."""
    ctx.emit(lost)


@module.rule(when=lost.max_age(0.0) & promised.holds(bool), writes=(verbaliser.intent, promised))
async def admit_loss(ctx: rs.RuleContext) -> None:
    """Say that there is no answer."""
    ctx[promised] = False
    ctx[verbaliser.intent] = Intent("lost", package=__package__)
