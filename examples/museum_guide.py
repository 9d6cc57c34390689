"""A museum guide who understands words, and words together with a gesture.

"What is this?" alone gets a general answer. The same words and a hand that points at a picture get an answer
about that picture, also when the camera reports the hand a moment after the microphone has reported the words.
No rule knows of the other, and nothing here counts seconds: the rule for both is worth more, as it is more
specific, and so the rule for words alone waits until its patience is over.

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

pointed = module.signal("pointed", payload=str)
"""From the camera: the picture at which a visitor points."""

gaze = module.slot("gaze", "the visitor")
"""Where the guide looks."""


@module.rule(when=rawio.input.changed, writes=rawio.output)
async def answer(ctx: rs.RuleContext) -> None:
    """Words alone."""
    ctx[rawio.output] = "This room shows pictures from Holland. Point at one to hear more."


@module.rule(when=rawio.input.changed & pointed, writes=rawio.output, patience=0.6)
async def answer_about(ctx: rs.RuleContext) -> None:
    """Words and a gesture, in either order."""
    ctx[rawio.output] = PICTURES.get(ctx.payload(pointed), "That one I do not know.")


@module.rule(when=pointed, writes=gaze)
async def look(ctx: rs.RuleContext) -> None:
    """A gesture alone turns the head. It writes another slot, so it excludes nobody and nobody excludes it."""
    ctx[gaze] = ctx.payload(pointed)


def main() -> None:
    """Two visitors: one points, one does not."""
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
