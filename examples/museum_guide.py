"""A museum guide that understands words, and words together with a gesture.

"What is this?" alone gets a general answer. The same words and a pointing hand get an answer about the picture. The
camera may report the hand a moment after the words. The rule for words and gesture is more specific, so the rule for
words alone waits. It waits at most until the patience of the other rule is over. Neither rule mentions the other, and
neither counts seconds.

    python examples/museum_guide.py        plays a scene in virtual time
"""

import ravestate as rs
from ravestate.modules import rawio
from ravestate.testing import simulate

PICTURES = {
    "pearl": "That is the Girl with a Pearl Earring, painted about 1665.",
    "delft": "That is the View of Delft. Look at the light on the roofs.",
}

module = rs.Module("museum", requires=[rawio])

pointed = module.signal("pointed", payload=str, input=True)
"""The picture at which a visitor points; a camera raises this."""

gaze = module.slot("gaze", "the visitor")
"""The target of the guide's gaze."""


@module.rule(when=rawio.input.changed, writes=rawio.output)
async def answer(ctx: rs.RuleContext) -> None:
    """Answer words alone."""
    ctx[rawio.output] = "This room shows pictures from Holland. Point at one to hear more."


@module.rule(when=rawio.input.changed & pointed, writes=rawio.output, patience=0.6)
async def answer_about(ctx: rs.RuleContext) -> None:
    """Answer words and a gesture, in either order."""
    ctx[rawio.output] = PICTURES.get(ctx.payload(pointed), "That one I do not know.")


@module.rule(when=pointed, writes=gaze)
async def look(ctx: rs.RuleContext) -> None:
    """Turn the head towards the picture. This rule writes another slot, so it runs beside the answers."""
    ctx[gaze] = ctx.payload(pointed)


def main() -> None:
    """Play a scene: one visitor points, another does not."""
    with simulate(module) as sim:
        sim.say("What is this?")
        sim.advance(0.3)
        sim.emit(pointed, "pearl")
        print(f"{sim.now:.1f} s, looking at {sim.read(gaze)}: {sim.said[-1]}")
        sim.advance(10)
        sim.say("Where am I?")
        sim.advance(0.6)
        print(f"{sim.now:.1f} s, looking at {sim.read(gaze)}: {sim.said[-1]}")


if __name__ == "__main__":
    main()
