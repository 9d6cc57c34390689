"""idle notices silence and delay, in virtual time to the moment."""

import pytest

import ravestate as rs
from ravestate.modules import idle, rawio
from ravestate.testing import simulate

watch = rs.Module("watch", requires=[rawio, idle])
times = watch.slot("times", ())


@watch.rule(when=idle.bored, writes=times)
async def note(ctx: rs.RuleContext) -> None:
    ctx[times] = (*ctx[times], ctx.now)


@watch.rule(when=rawio.input.changed, writes=rawio.output)
async def answer(ctx: rs.RuleContext) -> None:
    await ctx.sleep(2.0)
    ctx[rawio.output] = "yes"


def test_silence_bores_again_and_again_when_somebody_acts_on_it() -> None:
    with simulate(watch) as sim:
        sim.say("hello")
        sim.advance(20.0)
        assert sim.read(times) == pytest.approx((7.0, 12.0, 17.0, 22.0)[:3])


def test_activity_puts_boredom_off() -> None:
    with simulate(watch, settings={"idle": {"bored_after": 3.0}}) as sim:
        sim.say("hello")
        sim.advance(4.0)
        sim.say("still here")
        sim.advance(4.9)
        assert sim.read(times) == ()
        sim.advance(0.1)
        assert sim.read(times) == pytest.approx((9.0,))


def test_silence_bores_from_the_very_start() -> None:
    with simulate(watch) as sim:
        sim.advance(12.0)
        assert sim.read(times) == pytest.approx((5.0, 10.0))


def test_whatever_happens_at_the_start_begins_the_first_stretch_of_quiet_when_it_ends() -> None:
    busy = rs.Module("busy")

    @busy.rule(when=rs.startup)
    async def warm_up(ctx: rs.RuleContext) -> None:
        await ctx.sleep(2.0)

    with simulate(watch, busy) as sim:
        sim.advance(8.0)
        assert sim.read(times) == pytest.approx((7.0,))


@pytest.mark.parametrize("begin", [0.0, 3.0, 4.9])
def test_the_first_words_put_the_first_boredom_off(begin: float) -> None:
    with simulate(watch) as sim:
        sim.advance(begin)
        sim.say("hello")
        sim.advance(8.0)
        assert sim.read(times) == pytest.approx((begin + 7.0,))


def test_nothing_is_left_when_all_is_quiet() -> None:
    with simulate(idle) as sim:
        sim.advance(60.0)
        assert sim.snapshot()["activations"] == []
