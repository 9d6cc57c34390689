"""A quiz master that asks, waits for an answer, and asks again if none comes.

`ask` is detached: each `asked` starts a new causal group. So the rule can react to its own signal (a loop).

    python examples/quiz_master.py         play on the console
"""

import ravestate as rs
from ravestate.modules import rawio


class Settings(rs.Settings):
    """The quiz question, its answer, and the time to wait."""

    question: str = "Which planet is nearest to the sun?"
    answer: str = "Mercury"
    again_after: float = 10.0
    """Seconds from the question until `ask` is ready to repeat it. Then `judge` has its patience (1 s) to get an answer."""


module = rs.Module("quiz", requires=[rawio], settings=Settings)

asked = module.signal("asked")
"""A question is open."""


@module.rule(
    when=rs.startup | asked.min_age(Settings.again_after).max_age(None),
    writes=rawio.output,
    emits=asked,
    detached=True,
)
async def ask(ctx: rs.RuleContext) -> None:
    """Ask at the start, and again after too long a silence."""
    ctx[rawio.output] = ctx.settings.question
    ctx.emit(asked)


@module.rule(
    when=asked.max_age(None) & rawio.input.changed,
    writes=rawio.output,
    emits=asked,
    detached=True,
)
async def judge(ctx: rs.RuleContext) -> None:
    """Judge the answer to an open question. After a wrong answer, the question is open again."""
    if ctx.settings.answer.lower() in ctx.payload(rawio.input.changed).lower():
        ctx[rawio.output] = f"{ctx.settings.answer} it is!"
    else:
        ctx[rawio.output] = "No. Try again."
        ctx.emit(asked)


if __name__ == "__main__":
    from ravestate.modules import conio

    rs.run(module, conio)
