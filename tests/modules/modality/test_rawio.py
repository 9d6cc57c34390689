"""In `rawio`, each input raises a signal, even if it equals the last input. Code outside rules can write the input."""

import asyncio

import pytest

import ravestate as rs
from ravestate.modules import rawio
from ravestate.testing import simulate

echo = rs.Module("echo", requires=[rawio])


@echo.rule(when=rawio.input.changed, writes=rawio.output)
async def repeat(ctx: rs.RuleContext) -> None:
    ctx[rawio.output] = ctx.payload(rawio.input.changed)


def test_equal_inputs_raise_the_signal_each_time() -> None:
    with simulate(echo) as sim:
        sim.say("yes")
        sim.say("yes")
        assert sim.said == ["yes", "yes"]


def test_another_thread_can_write_the_input() -> None:
    async def main() -> str:
        async with rs.Context(echo) as context:
            waiting = asyncio.ensure_future(context.next(rawio.output.changed, timeout=30))
            await asyncio.to_thread(rawio.say, context, "from afar")
            return await waiting

    assert asyncio.run(main()) == "from afar"


@pytest.mark.parametrize(
    ("text", "pieces", "rest"),
    [
        ("one two", "one ", "two"),
        ("one two", "one", " two"),
        ("one two", "one two ", ""),
        ("one two ", "one two", ""),
        ("one two", " one", " two"),
        ("one…", "one ", "…"),
        ("one", "", "one"),
        ("ones", "one ", None),
        ("one", "one two", None),
        ("Hello", "uh", None),
    ],
)
def test_rest_returns_the_part_of_an_utterance_that_the_pieces_so_far_lack(
    text: str, pieces: str, rest: str | None
) -> None:
    assert rawio.rest(text, pieces) == rest
