"""A storyteller who can be interrupted.

`until` ends a rule that runs: here, when anything is said. The function is cancelled where it waits, may clean
up (here it closes the book), and what it has said so far stands. The words that interrupted it are an input like
any other, and get an answer of their own.

    python examples/storyteller.py         to listen on the console, and interrupt
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
"""How many sentences of the story have been told."""

book = module.flag("book")
"""Whether the book is open."""


@module.rule(
    when=rawio.input.changed.where(lambda text: "story" in text.lower()),
    writes=(rawio.output, told, book),
    until=rawio.input.changed,
)
async def tell(ctx: rs.RuleContext) -> None:
    """Tell the story from where it was left."""
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
    """Answer anything that is no wish for a story."""
    ctx[rawio.output] = "Say 'story', and I go on."


if __name__ == "__main__":
    from ravestate.modules import conio

    rs.run(module, conio)
