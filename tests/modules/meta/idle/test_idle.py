"""`idle` notices silence and delay at the right moment of virtual time."""

import pytest

import ravestate as rs
from ravestate.language.matcher import bundled_matcher
from ravestate.modules import idle, rawio
from ravestate.testing import simulate

watch = rs.Module("watch", requires=[rawio, idle])
times = watch.slot("times", ())
SOON = {"bored_after": 5.0, "answer_time": 12.0}
"""Settings with short silences."""


@watch.rule(when=idle.bored, writes=times)
async def note(ctx: rs.RuleContext) -> None:
    ctx[times] = (*ctx[times], ctx.now)


@watch.rule(when=rawio.input.changed, writes=rawio.output)
async def answer(ctx: rs.RuleContext) -> None:
    await ctx.sleep(2.0)
    ctx[rawio.output] = "yes"


def test_during_a_silence_the_agent_is_bored_again_and_again() -> None:
    with simulate(watch, settings={"idle": SOON}) as sim:
        sim.say("hello")
        sim.advance(20.0)
        assert sim.read(times) == pytest.approx((7.0, 12.0, 17.0, 22.0)[:3])


chatty = rs.Module("chatty", requires=[rawio, idle])


@chatty.rule(when=idle.bored, writes=rawio.output)
async def remark(ctx: rs.RuleContext) -> None:
    ctx[rawio.output] = "Are you still there?"


@chatty.rule(when=rawio.input.changed, writes=rawio.output)
async def nod(ctx: rs.RuleContext) -> None:
    ctx[rawio.output] = "I see."


def test_after_two_remarks_without_an_answer_the_agent_is_quiet_until_the_user_speaks() -> None:
    with simulate(chatty) as sim:
        sim.advance(3600.0)
        assert len(sim.said) == 2
        assert sim.read(idle.unanswered) == 2
        sim.say("I am back")
        assert sim.read(idle.unanswered) == 0
        sim.advance(3600.0)
        assert sim.said[2:] == ["I see.", *["Are you still there?"] * 2]


def test_a_setting_limits_the_remarks_in_a_row() -> None:
    with simulate(chatty, settings={"idle": {"remarks": 3}}) as sim:
        sim.advance(3600.0)
        assert len(sim.said) == 3


def test_a_key_press_shows_that_the_user_is_there() -> None:
    with simulate(chatty) as sim:
        sim.advance(3600.0)
        sim.emit(rawio.typing)
        sim.advance(3600.0)
        assert len(sim.said) == 4


def test_activity_delays_boredom() -> None:
    with simulate(watch, settings={"idle": {"bored_after": 3.0}}) as sim:
        sim.say("hello")
        sim.advance(4.0)
        sim.say("still here")
        sim.advance(4.9)
        assert sim.read(times) == ()
        sim.advance(0.1)
        assert sim.read(times) == pytest.approx((9.0,))


def test_a_silence_right_after_startup_bores_the_agent() -> None:
    with simulate(watch, settings={"idle": SOON}) as sim:
        sim.advance(12.0)
        assert sim.read(times) == pytest.approx((5.0, 10.0))


def test_the_first_silence_begins_after_the_work_at_startup() -> None:
    busy = rs.Module("busy")

    @busy.rule(when=rs.startup)
    async def warm_up(ctx: rs.RuleContext) -> None:
        await ctx.sleep(2.0)

    with simulate(watch, busy, settings={"idle": SOON}) as sim:
        sim.advance(8.0)
        assert sim.read(times) == pytest.approx((7.0,))


@pytest.mark.parametrize("begin", [0.0, 3.0, 4.9])
def test_the_first_words_delay_the_first_boredom(begin: float) -> None:
    with simulate(watch, settings={"idle": SOON}) as sim:
        sim.advance(begin)
        sim.say("hello")
        sim.advance(8.0)
        assert sim.read(times) == pytest.approx((begin + 7.0,))


@pytest.mark.parametrize("words", ["Goodbye!", "shut up", "please be quiet", "ok, see you tomorrow"])
def test_after_a_farewell_or_a_wish_for_quiet_the_agent_is_not_bored_until_the_user_speaks(words: str) -> None:
    with simulate(watch, settings={"idle": SOON}) as sim:
        sim.say(words)
        sim.advance(600.0)
        assert sim.read(times) == ()
        sim.say("hello again")
        sim.advance(7.0)
        assert len(sim.read(times)) == 1


@pytest.mark.parametrize("words", ["Goodbye!", "please be quiet"])
def test_an_unfinished_line_does_not_end_the_quiet_that_the_user_wants(words: str) -> None:
    with simulate(watch, settings={"idle": SOON}) as sim:
        sim.say(words)
        sim.advance(5.0)
        sim.emit(rawio.typing)
        sim.advance(600.0)
        assert sim.read(times) == ()


def test_without_remarks_an_unfinished_line_does_not_bore_the_agent() -> None:
    with simulate(watch, settings={"idle": {**SOON, "remarks": 0}}) as sim:
        sim.emit(rawio.typing)
        sim.advance(600.0)
        assert sim.read(times) == ()


def test_an_unfinished_line_after_words_of_sorrow_does_not_bore_the_agent() -> None:
    bundled_matcher("feelings").load()
    with simulate(watch, settings={"idle": SOON}) as sim:
        sim.say("my grandmother died last week")
        sim.advance(5.0)
        sim.emit(rawio.typing)
        sim.advance(600.0)
        assert sim.read(times) == ()


def test_a_line_typed_while_the_agent_works_does_not_bore_it_before_the_silence() -> None:
    with simulate(watch, settings={"idle": {"bored_after": 1.0, "writing_time": 1.0}}) as sim:
        sim.say("hello")  # the agent answers 2 s later
        sim.advance(0.5)
        sim.emit(rawio.typing)
        sim.advance(3.0)
        assert sim.read(times) == pytest.approx((3.0,))


def test_a_wish_for_quiet_raises_hushed() -> None:
    listener = rs.Module("listener", requires=[idle])
    count = listener.slot("count", 0)

    @listener.rule(when=idle.hushed, writes=count)
    async def hear(ctx: rs.RuleContext) -> None:
        ctx[count] += 1

    with simulate(listener) as sim:
        for words in ("stop!", "Goodbye", "It is quiet here"):
            sim.say(words)
        assert sim.read(count) == 1


def test_the_user_has_more_time_to_answer_a_question_of_the_agent() -> None:
    curious = rs.Module("curious", requires=[rawio])

    @curious.rule(when=rawio.input.changed, writes=rawio.output)
    async def ask(ctx: rs.RuleContext) -> None:
        ctx[rawio.output] = ctx.payload(rawio.input.changed)

    @curious.rule(
        when=rawio.output.changed.where(lambda text: "?" in text).detached(),
        writes=rawio.output,
        detached=True,
    )
    async def smile(ctx: rs.RuleContext) -> None:
        ctx[rawio.output] = "😊"

    waits = rs.Module("waits", requires=[idle])
    bored = waits.slot("bored", ())

    @waits.rule(when=idle.bored, writes=bored)
    async def note(ctx: rs.RuleContext) -> None:
        ctx[bored] = (*ctx[bored], ctx.now)

    with simulate(curious, waits, settings={"idle": {"bored_after": 5.0, "answer_time": 9.0}}) as sim:
        sim.say("I am fine. How are you?")
        assert sim.read(idle.asked) == "How are you?"
        sim.advance(20.0)
        assert sim.read(bored) == pytest.approx((9.0, 18.0))
        sim.say("Who? Me.")
        assert sim.read(idle.asked) == ""
        sim.advance(6.0)
        assert sim.read(bored) == pytest.approx((9.0, 18.0, 25.0))


def test_a_user_who_types_is_not_silent() -> None:
    with simulate(watch, settings={"idle": {**SOON, "writing_time": 8.0}}) as sim:
        for _ in range(20):
            sim.advance(1.0)
            sim.emit(rawio.typing)
        assert sim.read(times) == ()
        sim.advance(7.9)
        assert sim.read(times) == ()
        sim.advance(0.2)
        assert sim.read(times) == pytest.approx((28.0,))


def test_after_a_sent_line_the_user_no_longer_counts_as_typing() -> None:
    with simulate(watch, settings={"idle": {**SOON, "writing_time": 8.0}}) as sim:
        sim.advance(4.0)
        sim.emit(rawio.typing)
        sim.advance(1.0)
        sim.say("hello")  # the agent answers 2 s later
        sim.advance(7.1)
        assert sim.read(times) == pytest.approx((12.0,))
        sim.advance(1.5)
        assert sim.read(times) == pytest.approx((12.0,))


def test_a_farewell_prevents_boredom_even_if_the_agent_answers_it_immediately() -> None:
    swift = rs.Module("swift", requires=[rawio, idle])
    bored = swift.slot("bored", 0)

    @swift.rule(when=rawio.input.changed, writes=rawio.output)
    async def reply(ctx: rs.RuleContext) -> None:
        ctx[rawio.output] = "Bye."

    @swift.rule(when=idle.bored, writes=bored)
    async def count(ctx: rs.RuleContext) -> None:
        ctx[bored] += 1

    with simulate(swift) as sim:
        sim.say("Goodbye!")
        sim.advance(600.0)
        assert sim.read(bored) == 0


def test_no_activation_is_left_after_a_long_silence() -> None:
    with simulate(idle) as sim:
        sim.advance(60.0)
        assert sim.snapshot()["activations"] == []


def test_after_words_of_sorrow_the_agent_is_not_bored_for_twelve_utterances() -> None:
    bundled_matcher("feelings").load()
    with simulate(watch, settings={"idle": SOON}) as sim:
        sim.say("my grandmother died last week")
        sim.advance(600.0)
        for _ in range(11):
            sim.say("she was a baker")
            sim.advance(600.0)
        assert sim.read(times) == ()
        sim.say("I like tea")
        sim.advance(60.0)
        assert sim.read(times)


def test_by_default_the_agent_is_bored_after_a_silence_of_about_15_seconds() -> None:
    with simulate(chatty) as sim:
        sim.advance(14.0)
        assert sim.said == []
        sim.advance(2.0)
        assert sim.said == ["Are you still there?"]
