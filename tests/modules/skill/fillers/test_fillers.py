"""The module `fillers` says a filler in a pause, and never takes the place of an answer."""

import pytest

import ravestate as rs
from ravestate.modules import fillers, idle, rawio, verbaliser
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


def test_a_long_wait_gets_one_filler_and_then_the_answer() -> None:
    with simulate(fillers, slow) as sim:
        sim.say("What is that?")
        sim.advance(0.9)
        assert sim.said == []
        sim.advance(0.2)
        assert len(sim.said) == 1
        sim.advance(5.0)
        assert sim.said[1:] == ["answer"]


def test_a_short_wait_gets_no_filler() -> None:
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


def test_a_slow_answering_rule_gets_a_filler_although_no_other_rule_waits() -> None:
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


def test_a_pause_gets_one_filler_even_if_two_causes_ask_for_one() -> None:
    with simulate(fillers, slow) as sim:
        sim.say("What is that?")
        sim.advance(1.5)
        sim.emit(idle.impatient)
        assert len(sim.said) == 1


SORRY = (
    "Sorry, I lost that. Could you say it again?",
    "Sorry, I have no answer to that. Could you put it in other words?",
)
LATE = ("This takes longer than usual. I am still thinking…", "Sorry, I am still working on it…")
model = rs.Module("model", requires=[rawio])


@model.rule(when=rawio.input.changed, writes=rawio.output, until=rawio.input.changed)
async def think(ctx: rs.RuleContext) -> rs.Resign | None:
    """Think for the seconds in the input, and then answer. If the number is negative, do not answer."""
    seconds = float(ctx.payload(rawio.input.changed))
    await ctx.sleep(abs(seconds))
    if seconds < 0:
        return rs.Resign("no idea")
    ctx[rawio.output] = "thought"
    return None


def test_the_agent_admits_a_delay_while_a_late_answer_may_still_come() -> None:
    """The agent says that it is still working. "I have no answer" would be wrong, because the answer still comes."""
    with simulate(fillers, model, settings={"fillers": {"answer_within": 15.0}}) as sim:
        sim.say("60")
        sim.advance(2.1)
        assert len(sim.said) == 1
        sim.advance(14.8)
        assert len(sim.said) == 1
        sim.advance(0.2)
        assert sim.said[1] in LATE
        sim.advance(100.0)
        assert sim.said[2:] == ["thought"]


def test_the_agent_apologises_if_a_late_answer_never_comes() -> None:
    with simulate(fillers, model) as sim:
        sim.say("-60")
        sim.advance(100.0)
        assert sim.said[1] in LATE
        assert sim.said[2] in SORRY
        assert len(sim.said) == 3


def test_the_agent_apologises_if_every_rule_resigns_after_a_filler() -> None:
    with simulate(fillers, model) as sim:
        sim.say("-4")
        sim.advance(10.0)
        assert len(sim.said) == 2
        assert sim.said[1] in SORRY
        sim.advance(100.0)
        assert len(sim.said) == 2


def test_an_answer_after_a_filler_needs_no_apology() -> None:
    with simulate(fillers, model) as sim:
        sim.say("10")
        sim.advance(100.0)
        assert sim.said[1:] == ["thought"]


def test_after_new_words_no_answer_to_the_earlier_words_is_expected() -> None:
    with simulate(fillers, model) as sim:
        sim.say("60")
        sim.advance(10.0)
        sim.say("0")
        sim.advance(100.0)
        assert sim.said[1:] == ["thought"]


def test_new_words_soon_after_a_filler_get_a_sign_of_delay() -> None:
    with simulate(fillers, model) as sim:
        sim.say("1000")
        sim.advance(2.1)
        assert len(sim.said) == 1
        sim.say("999")
        sim.advance(100.0)
        assert len(sim.said) == 2
        assert sim.said[1] in LATE


def test_new_words_soon_after_a_filler_get_their_answer_without_an_apology() -> None:
    with simulate(fillers, model) as sim:
        sim.say("1000")
        sim.advance(2.1)
        sim.say("4")
        sim.advance(100.0)
        assert sim.said[1:] == ["thought"]


def test_an_empty_text_does_not_count_as_an_answer() -> None:
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


def reader(seconds: float, *, worded: bool = False, detached: bool = False) -> rs.Module:
    """Return a module with three slow rules: the first raises a signal, the second resigns, the third answers."""
    module = rs.Module("reader", requires=[rawio, verbaliser])
    read = module.signal("read")

    @module.rule(when=rawio.input.changed, emits=read)
    async def understand(ctx: rs.RuleContext) -> None:
        await ctx.sleep(seconds)
        ctx.emit(read)

    @module.rule(when=read, writes=rawio.output, weight=1.5)
    async def resign(ctx: rs.RuleContext) -> rs.Resign:
        await ctx.sleep(seconds)
        return rs.Resign("no idea")

    @module.rule(
        when=read.detached() if detached else read,
        writes=verbaliser.intent if worded else rawio.output,
        detached=detached,
    )
    async def answer(ctx: rs.RuleContext) -> None:
        await ctx.sleep(seconds)
        if worded:
            ctx[verbaliser.intent] = verbaliser.Intent("answer", phrases={"en": ["answer"]})
        else:
            ctx[rawio.output] = "answer"

    return module


@pytest.mark.parametrize("seconds", [1.5, 4.0, 25.0])
@pytest.mark.parametrize("worded", [False, True])
@pytest.mark.parametrize("detached", [False, True])
def test_no_apology_comes_before_an_answer(seconds: float, worded: bool, detached: bool) -> None:
    """Slow understanding, a rule that resigns, and an intent that has no words yet are no reasons to apologise."""
    with simulate(fillers, reader(seconds, worded=worded, detached=detached)) as sim:
        sim.say("What?")
        sim.advance(200.0)
        assert [text for text in sim.said if text in ("answer", *SORRY)] == ["answer"]


both = rs.Module("both", requires=[rawio])


@both.rule(when=rawio.input.changed, writes=rawio.output)
async def ponder(ctx: rs.RuleContext) -> rs.Resign | None:
    """Answer after the seconds in the input, even if the user speaks meanwhile. If the number is negative, resign."""
    seconds = float(ctx.payload(rawio.input.changed))
    await ctx.sleep(abs(seconds))
    if seconds < 0:
        return rs.Resign("no idea")
    ctx[rawio.output] = f"after {seconds:g}"
    return None


@pytest.mark.parametrize("first", ["10", "30"])
def test_the_answer_to_the_first_words_does_not_answer_the_second(first: str) -> None:
    """After the filler for their second words, the user expects an answer. No rule has one, so the agent apologises."""
    with simulate(fillers, both) as sim:
        sim.say(first)
        sim.advance(5.9)
        sim.say("-40")
        sim.advance(100.0)
        assert f"after {first}" in sim.said
        assert sim.said[-1] in SORRY
        assert len([text for text in sim.said if text in SORRY]) == 1


def test_words_after_which_the_user_says_more_get_no_apology() -> None:
    with simulate(fillers, both) as sim:
        sim.say("-10")
        sim.advance(3.0)
        sim.say("1")
        sim.advance(100.0)
        assert sim.said[1:] == ["after 1"]


def test_a_rule_that_waits_at_startup_triggers_no_filler() -> None:
    module = rs.Module("early", requires=[rawio])
    never = module.signal("never")

    @module.rule(when=rs.startup, writes=rawio.output)
    async def say(ctx: rs.RuleContext) -> rs.Resign:
        return rs.Resign("there is nothing to say")

    @module.rule(when=rs.startup & never, emits=never, writes=rawio.output)
    async def prefer(ctx: rs.RuleContext) -> None: ...

    @module.rule(when=rs.startup, emits=never)
    async def wait(ctx: rs.RuleContext) -> rs.Resign:
        await ctx.sleep(8.0)
        return rs.Resign("there is nothing to wait for")

    with simulate(fillers, module) as sim:
        sim.advance(30.0)
        assert sim.said == []


def test_an_old_answer_does_not_end_the_wait_for_the_next() -> None:
    module = rs.Module("turns", requires=[rawio])

    @module.rule(when=rawio.input.changed, writes=rawio.output)
    async def answer_late(ctx: rs.RuleContext) -> rs.Resign | None:
        if ctx.payload(rawio.input.changed) == "first?":
            await ctx.sleep(10.0)
            ctx[rawio.output] = "first answer"
            return None
        await ctx.sleep(60.0)
        return rs.Resign("no answer")

    with simulate(fillers, module) as sim:
        sim.say("first?")
        sim.advance(9.5)
        sim.say("second?")
        sim.advance(70.0)
        after = sim.said[sim.said.index("first answer") + 1 :]
        assert after  # the text of a filler, of a notice of delay, or of an apology
