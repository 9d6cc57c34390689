"""A character of a game: what she says, how she looks and what she does are three slots.

Rules that write different slots run side by side: an insult makes her frown while she answers. Rules that write
the same slot exclude each other, and the more specific one goes first. None of them knows of the others, so a
new mood is a new rule, and nothing else changes.

    python examples/innkeeper.py           to meet her on the console
"""

import re

import ravestate as rs
from ravestate.modules import idle, rawio

RUDE = ("stupid", "ugly", "awful")
KIND = ("lovely", "thank", "delicious")

module = rs.Module("innkeeper", requires=[rawio, idle])

insulted = module.signal("insulted")
praised = module.signal("praised")
order = module.signal("order", payload=str)
face = module.slot("face", "neutral")
hands = module.slot("hands", "wipe the counter")


@module.rule(when=rawio.input.changed, emits=(insulted, praised, order))
async def understand(ctx: rs.RuleContext) -> None:
    """One utterance may be an insult and an order at once."""
    text = ctx.payload(rawio.input.changed).lower()
    if any(word in text for word in RUDE):
        ctx.emit(insulted)
    if any(word in text for word in KIND):
        ctx.emit(praised)
    for drink in ("ale", "mead", "water"):
        if re.search(rf"\b{drink}\b", text):
            ctx.emit(order, drink)


@module.rule(when=insulted, writes=face)
async def frown(ctx: rs.RuleContext) -> None:
    """A face needs no words."""
    ctx[face] = "frowning"


@module.rule(when=praised, writes=face)
async def smile(ctx: rs.RuleContext) -> None:
    """Nor does this one."""
    ctx[face] = "smiling"


@module.rule(when=order, writes=(hands, rawio.output))
async def serve(ctx: rs.RuleContext) -> None:
    """An order is served."""
    ctx[hands] = f"pour {ctx.payload(order)}"
    ctx[rawio.output] = "Here you are."


@module.rule(when=order & insulted, writes=(hands, rawio.output))
async def refuse(ctx: rs.RuleContext) -> None:
    """An order with an insult is not: more specific than `serve`, so it goes first."""
    ctx[hands] = "cross her arms"
    ctx[rawio.output] = "Say that again and you drink from the trough."


@module.rule(when=rawio.input.changed, writes=rawio.output)
async def chat(ctx: rs.RuleContext) -> None:
    """Whatever else is said."""
    ctx[rawio.output] = "If you say so. Ale, mead or water?"


@module.rule(when=idle.bored, writes=(face, hands))
async def calm_down(ctx: rs.RuleContext) -> None:
    """Moods pass."""
    ctx[face] = "neutral"
    ctx[hands] = "wipe the counter"


if __name__ == "__main__":
    from ravestate.modules import conio

    rs.run(module, conio)
