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


class Shown:
    """A listener that keeps a log of what it is shown."""

    def __init__(self) -> None:
        self.log: list[tuple[str, object]] = []

    def utter(self, text: str, origin: object = None) -> None:
        self.log.append((text, origin))

    def grow(self, piece: str, origin: object = None) -> None:
        self.log.append((piece, origin))

    def fall_silent(self, origin: object = None) -> None:
        self.log.append(("silence", origin))


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


def test_a_rule_that_fails_in_the_middle_of_an_utterance_ends_the_utterance() -> None:
    story = rs.Module("story", requires=[rawio])

    @story.rule(when=rawio.input.changed, writes=(rawio.output, rawio.speaking), emits=rawio.piece)
    async def tell(ctx: rs.RuleContext) -> None:
        ctx[rawio.speaking] = True
        ctx.emit(rawio.piece, "Once ")
        await ctx.sleep(2)
        raise ValueError("the story is lost")

    @story.rule(when=rawio.input.changed.detached(), detached=True)
    async def listen(ctx: rs.RuleContext) -> None:
        raise ValueError("another rule fails")

    page = rs.Module("page", requires=[rawio])
    rawio.carry(page, page.slot("listener", Shown()))

    with simulate(story, page) as sim:
        sim.context.put(rawio.input, "a story", origin="letter")
        sim.advance(1)
        assert sim.read(rawio.speaking)
        sim.advance(1)
        assert not sim.read(rawio.speaking)
        assert [rule for rule, _ in sim.failures] == ["story:listen", "story:tell"]
        assert sim.read(page.slots[0]).log == [("Once ", "letter"), ("silence", "letter")]


def test_a_failure_before_the_first_piece_does_not_end_the_next_utterance() -> None:
    story = rs.Module("story", requires=[rawio])

    @story.rule(when=rawio.input.changed, writes=rawio.speaking, emits=rawio.piece)
    async def tell(ctx: rs.RuleContext) -> None:
        if ctx.payload(rawio.input.changed) == "a secret":
            raise ValueError("no")
        ctx[rawio.speaking] = True
        await ctx.sleep(2)
        ctx.emit(rawio.piece, "Once")
        ctx[rawio.speaking] = False

    page = rs.Module("page", requires=[rawio])
    rawio.carry(page, page.slot("listener", Shown()))

    with simulate(story, page) as sim:
        sim.say("a secret")
        sim.advance(1)
        sim.say("a story")
        sim.advance(1)
        assert sim.read(rawio.speaking)
        sim.advance(1)
        assert [words for words, _ in sim.read(page.slots[0]).log] == ["Once", "silence"]


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
