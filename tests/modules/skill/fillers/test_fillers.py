"""fillers fills a pause, and takes no other rule's turn."""

import ravestate as rs
from ravestate.modules import fillers, idle, rawio
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
    patient = {"idle": {"impatient_after": 4.0}, "fillers": {"unanswered_after": 4.0}}
    with simulate(fillers, slow, settings=patient) as sim:
        sim.say("It rains.")
        sim.advance(10.0)
        assert sim.said == ["talk"]


def test_a_filler_neither_interrupts_speech_nor_follows_the_answer() -> None:
    with simulate(fillers, slow) as sim:
        sim.put(rawio.speaking, True)
        sim.say("What is that?")
        sim.advance(3.5)
        assert sim.said == ["answer"]
        sim.put(rawio.speaking, False)
        sim.say("It rains.")
        sim.advance(0.9)
        assert sim.said == ["answer"]


def test_an_answer_of_which_nothing_is_heard_yet_is_a_pause_although_nobody_waits() -> None:
    model = rs.Module("model", requires=[rawio])

    @model.rule(when=rawio.input.changed, writes=(rawio.output, rawio.speaking), until=rawio.input.changed)
    async def think(ctx: rs.RuleContext) -> None:
        await ctx.sleep(8.0)
        ctx[rawio.speaking] = True
        await ctx.sleep(8.0)
        ctx[rawio.output] = "thought"
        ctx[rawio.speaking] = False

    with simulate(fillers, model) as sim:
        sim.say("Hm?")
        sim.advance(1.9)
        assert sim.said == []
        sim.advance(0.2)
        assert len(sim.said) == 1
        sim.advance(30.0)
        assert sim.said[1:] == ["thought"]


def test_one_filler_is_enough_for_a_pause_that_goes_on_for_another_reason() -> None:
    with simulate(fillers, slow) as sim:
        sim.say("What is that?")
        sim.advance(1.5)
        sim.emit(idle.impatient)
        assert len(sim.said) == 1


SORRY = (
    "Sorry, I lost that. Could you say it again?",
    "Sorry, I have no answer to that. Could you put it in other words?",
)
model = rs.Module("model", requires=[rawio])


@model.rule(when=rawio.input.changed, writes=rawio.output, until=rawio.input.changed)
async def think(ctx: rs.RuleContext) -> rs.Resign | None:
    """Think for so many seconds as are said, and then answer, unless the seconds are negative."""
    seconds = float(ctx.payload(rawio.input.changed))
    await ctx.sleep(abs(seconds))
    if seconds < 0:
        return rs.Resign("no idea")
    ctx[rawio.output] = "thought"
    return None


def test_an_answer_that_takes_too_long_is_lost_in_words() -> None:
    with simulate(fillers, model, settings={"fillers": {"answer_within": 15.0}}) as sim:
        sim.say("60")
        sim.advance(2.1)
        assert len(sim.said) == 1
        sim.advance(14.8)
        assert len(sim.said) == 1
        sim.advance(0.2)
        assert sim.said[1] in SORRY
        sim.advance(100.0)
        assert sim.said[2:] == ["thought"]


def test_if_every_rule_resigns_after_a_filler_the_agent_says_so() -> None:
    with simulate(fillers, model) as sim:
        sim.say("-4")
        sim.advance(10.0)
        assert len(sim.said) == 2
        assert sim.said[1] in SORRY
        sim.advance(100.0)
        assert len(sim.said) == 2


def test_an_answer_after_a_filler_is_not_lost() -> None:
    with simulate(fillers, model) as sim:
        sim.say("10")
        sim.advance(100.0)
        assert sim.said[1:] == ["thought"]


def test_the_users_next_words_take_the_place_of_the_answer() -> None:
    with simulate(fillers, model) as sim:
        sim.say("60")
        sim.advance(10.0)
        sim.say("0")
        sim.advance(100.0)
        assert sim.said[1:] == ["thought"]


def test_words_soon_after_a_filler_are_not_left_in_silence() -> None:
    with simulate(fillers, model) as sim:
        sim.say("1000")
        sim.advance(2.1)
        assert len(sim.said) == 1
        sim.say("999")
        sim.advance(100.0)
        assert len(sim.said) == 2
        assert sim.said[1] in SORRY


def test_words_soon_after_a_filler_whose_answer_comes_are_not_lost() -> None:
    with simulate(fillers, model) as sim:
        sim.say("1000")
        sim.advance(2.1)
        sim.say("4")
        sim.advance(100.0)
        assert sim.said[1:] == ["thought"]


def test_an_empty_answer_is_none() -> None:
    mute = rs.Module("mute", requires=[rawio])

    @mute.rule(when=rawio.input.changed, writes=rawio.output)
    async def say_nothing(ctx: rs.RuleContext) -> None:
        await ctx.sleep(4.0)
        ctx[rawio.output] = " "

    with simulate(fillers, mute) as sim:
        sim.say("Hm?")
        sim.advance(100.0)
        assert sim.said[1] == " "
        assert sim.said[2] in SORRY
