"""An apprentice that learns new rules at run time.

"When I say ping, answer pong." adds a rule to this context. "Forget ping." makes that rule retire (leave this context).
Other contexts of the policy do not change. A learnt rule competes like any other rule: it is more specific than
`puzzled`, so it wins.

    python examples/apprentice.py          teach it on the console
"""

import re

import ravestate as rs
from ravestate.modules import rawio

LESSON = re.compile(r"when i say (?P<word>\w+), answer (?P<reply>.+)", re.IGNORECASE)

module = rs.Module("apprentice", requires=[rawio])

taught = module.signal("taught", payload=dict)
forgotten = module.signal("forgotten", payload=str)
lessons = module.slot("lessons", 0)


@module.rule(when=rawio.input.changed, emits=(taught, forgotten))
async def attend(ctx: rs.RuleContext) -> None:
    """Notice a lesson, or a request to forget one."""
    text = ctx.payload(rawio.input.changed).rstrip(".")
    if lesson := LESSON.fullmatch(text):
        ctx.emit(taught, lesson.groupdict())
    elif text.lower().startswith("forget "):
        ctx.emit(forgotten, text.split()[1])


@module.rule(when=taught, writes=(rawio.output, lessons))
async def learn(ctx: rs.RuleContext) -> None:
    """Add a rule to this context, and to no other."""
    ctx[lessons] += 1
    ctx.add_rule(answer_to(**ctx.payload(taught), number=ctx[lessons]))
    ctx[rawio.output] = "Understood."


@module.rule(when=rawio.input.changed, writes=rawio.output)
async def puzzled(ctx: rs.RuleContext) -> None:
    """Answer when no other rule does."""
    ctx[rawio.output] = "Nobody has told me what to say to that."


def answer_to(word: str, reply: str, number: int) -> rs.Rule:
    """Return a rule that answers one word until the user asks to forget it.

    All contexts share the apprentice's module, so the rule gets a module of its own.
    """
    lesson = rs.Module(f"lesson-{number}", requires=[module])

    def said(text: str) -> bool:
        return text.lower().strip(" .!?") == word.lower()

    @lesson.rule(when=rawio.input.changed.where(said) | forgotten.where(said), writes=rawio.output)
    async def answer(ctx: rs.RuleContext) -> rs.Retire | None:
        if ctx.payload(forgotten):
            ctx[rawio.output] = f"{word} is forgotten."
            return rs.Retire()
        ctx[rawio.output] = reply
        return None

    return answer


if __name__ == "__main__":
    from ravestate.modules import conio

    rs.run(module, conio)
