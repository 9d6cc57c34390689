"""A game character with three slots: her words, her face and her hands.

Rules that write different slots run in parallel: an insult makes her frown while she answers. Rules that write the
same slot exclude each other, and the more specific rule wins. No rule mentions another, so a new mood is just a new
rule.

    python examples/innkeeper.py           meet her on the console
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
    """Notice insults, praise and orders. One utterance may be all three."""
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
    """Show anger. The face is a slot of its own, so any rule may speak meanwhile."""
    ctx[face] = "frowning"


@module.rule(when=praised, writes=face)
async def smile(ctx: rs.RuleContext) -> None:
    """Show pleasure."""
    ctx[face] = "smiling"


@module.rule(when=order, writes=(hands, rawio.output))
async def serve(ctx: rs.RuleContext) -> None:
    """Serve an order."""
    ctx[hands] = f"pour {ctx.payload(order)}"
    ctx[rawio.output] = "Here you are."


@module.rule(when=order & insulted, writes=(hands, rawio.output))
async def refuse(ctx: rs.RuleContext) -> None:
    """Refuse a rude order. This rule is more specific than `serve`, so it wins."""
    ctx[hands] = "cross her arms"
    ctx[rawio.output] = "Say that again and you drink from the trough."


@module.rule(when=rawio.input.changed, writes=rawio.output)
async def chat(ctx: rs.RuleContext) -> None:
    """Answer everything else."""
    ctx[rawio.output] = "If you say so. Ale, mead or water?"


@module.rule(when=idle.bored, writes=(face, hands))
async def calm_down(ctx: rs.RuleContext) -> None:
    """Return to the usual mood after some silence."""
    ctx[face] = "neutral"
    ctx[hands] = "wipe the counter"


if __name__ == "__main__":
    from ravestate.modules import conio

    rs.run(module, conio)
