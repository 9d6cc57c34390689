"""A storyteller that listeners can interrupt.

`until` ends a running rule, here at any input. The runtime cancels the function where it waits. The function can clean
up (here it closes the book). The slot `told` keeps the place in the story. The interrupting words are an ordinary
input, with their own answer.

    python examples/storyteller.py         listen on the console, and interrupt
"""

import ravestate as rs
from ravestate.modules import rawio

STORY = (
    "Once there was a lighthouse keeper.",
    "Every night he counted the ships.",
    "One night there was one too many.",
    "He lit the second lamp, and waited.",
)

module = rs.Module("storyteller", requires=[rawio])

told = module.slot("told", 0)
"""The number of sentences told so far."""

book = module.flag("book")
"""Whether the book is open."""


@module.rule(
    when=rawio.input.changed.where(lambda text: "story" in text.lower()),
    writes=(rawio.output, told, book),
    until=rawio.input.changed,
)
async def tell(ctx: rs.RuleContext) -> None:
    """Continue the story."""
    ctx[book] = True
    try:
        while ctx[told] < len(STORY):
            ctx[rawio.output] = STORY[ctx[told]]
            ctx[told] += 1
            await ctx.sleep(3.0)
        ctx[told] = 0
    finally:
        ctx[book] = False


@module.rule(when=rawio.input.changed, writes=rawio.output)
async def listen(ctx: rs.RuleContext) -> None:
    """Answer everything but a request for a story."""
    ctx[rawio.output] = "Say 'story', and I go on."


if __name__ == "__main__":
    from ravestate.modules import conio

    rs.run(module, conio)
