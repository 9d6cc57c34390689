"""A quiz master who asks, waits for an answer, and asks again when there is none.

`asked` is raised detached: it begins a causal group of its own. So the question may be asked again for its own
sake (a loop), and an answer is an answer to the question, not a part of what made the guide ask it.

    python examples/quiz_master.py         to play on the console
"""

import ravestate as rs
from ravestate.modules import rawio


class Settings(rs.Settings):
    """What the quiz is about, and how long it waits."""

    question: str = "Which planet is nearest to the sun?"
    answer: str = "Mercury"
    again_after: float = 10.0
    """Seconds of silence after which the question is asked again."""


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
    """At the beginning, and whenever a question has been open for too long."""
    ctx[rawio.output] = ctx.settings.question
    ctx.emit(asked)


@module.rule(
    when=asked.max_age(None) & rawio.input.changed,
    writes=rawio.output,
    emits=asked,
    detached=True,
)
async def judge(ctx: rs.RuleContext) -> None:
    """Something was said while a question was open. A wrong answer opens it once more."""
    if ctx.settings.answer.lower() in ctx.payload(rawio.input.changed).lower():
        ctx[rawio.output] = f"{ctx.settings.answer} it is!"
    else:
        ctx[rawio.output] = "No. Try again."
        ctx.emit(asked)


if __name__ == "__main__":
    from ravestate.modules import conio

    rs.run(module, conio)
