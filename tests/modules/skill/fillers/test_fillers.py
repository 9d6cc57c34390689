"""fillers fills a pause, and takes nobody's turn."""

import ravestate as rs
from ravestate.modules import fillers, rawio
from ravestate.testing import simulate

slow = rs.Module("slow", requires=[rawio])
question = slow.signal("question")


@slow.rule(when=rawio.input.changed, emits=question)
async def classify(ctx: rs.RuleContext) -> None:
    await ctx.sleep(3.0)
    if "?" in ctx.payload(rawio.input.changed):
        ctx.emit(question)


@slow.rule(when=question, writes=rawio.output)
async def answer(ctx: rs.RuleContext) -> None:
    ctx[rawio.output] = "answer"


@slow.rule(when=rawio.input.changed, writes=(rawio.output, rawio.speaking))
async def talk(ctx: rs.RuleContext) -> None:
    ctx[rawio.output] = "talk"


def test_a_long_wait_is_filled_once_and_the_answer_comes_all_the_same() -> None:
    with simulate(fillers, slow) as sim:
        sim.say("What is that?")
        sim.advance(0.9)
        assert sim.said == []
        sim.advance(0.2)
        assert len(sim.said) == 1
        sim.advance(5.0)
        assert sim.said[1:] == ["answer"]


def test_a_short_wait_is_not_filled() -> None:
    with simulate(fillers, slow, settings={"idle": {"impatient_after": 4.0}}) as sim:
        sim.say("It rains.")
        sim.advance(10.0)
        assert sim.said == ["talk"]


def test_who_speaks_is_not_interrupted() -> None:
    with simulate(fillers, slow) as sim:
        sim.put(rawio.speaking, True)
        sim.say("What is that?")
        sim.advance(2.5)
        assert sim.said == []
        sim.put(rawio.speaking, False)
        assert len(sim.said) == 1
