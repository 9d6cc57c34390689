"""The audio line to a page passes sound in both directions, and knows how much the loudspeaker has played."""

import asyncio

import pytest

import ravestate as rs
from modules.platform.webio.ears import ears, story, tone
from modules.platform.webio.visit import in_virtual_time, parrot, past
from ravestate.modules import rawio
from ravestate.modules.platform.webio.line import AHEAD, BLOCK, CHUNK, MOST_HEARD, PageLine, hears


class Speaker:
    """A stand-in for a browser window. It fetches sound, and the test calls `played` to report how much has played."""

    def __init__(self, line: PageLine) -> None:
        self.line = line
        self.sound = b""
        self.lost: list[str] = []

    def wake(self) -> None:
        while (sound := self.line.fetch(self)) is not None:
            assert len(sound) <= CHUNK
            self.sound += sound

    def lose_sound(self, why: str) -> None:
        self.lost.append(why)

    def played(self, seconds: float) -> None:
        self.line.report(self, self.line.stream, round(seconds * rawio.OUT_RATE))


async def taken(line: PageLine, count: int) -> list[bytes]:
    """Return the next blocks of sound that the agent hears on a line."""
    blocks = line.blocks()
    found = [await anext(blocks) for _ in range(count)]
    await blocks.aclose()
    return found


@in_virtual_time
async def test_sound_of_any_size_comes_in_blocks_of_20_ms() -> None:
    line = PageLine()
    line.take(window := Speaker(line))
    sound = bytes(range(256)) * 10
    for size in (2, BLOCK * 3, 500, 138):
        line.hear(window, sound[:size])
        sound = sound[size:]
    assert b"".join(await taken(line, 4)) == (bytes(range(256)) * 10)[: 4 * BLOCK]
    line.close()
    assert [block async for block in line.blocks()] == []


@in_virtual_time
async def test_if_the_agent_reads_no_sound_only_the_newest_sound_is_kept() -> None:
    line = PageLine()
    line.take(window := Speaker(line))
    for number in range(30):
        line.hear(window, bytes([number]) * 32_000)
    blocks = await taken(line, MOST_HEARD // BLOCK)
    assert blocks[0] == bytes([25]) * BLOCK
    assert blocks[-1] == bytes([29]) * BLOCK


@in_virtual_time
async def test_after_the_microphone_goes_off_the_agent_hears_silence() -> None:
    line = PageLine()
    line.take(window := Speaker(line))
    line.hear(window, b"\x01" * BLOCK)
    line.leave(window)
    line.hear(window, b"\x02" * BLOCK)  # too late: this window no longer has the line
    blocks = await taken(line, 101)
    assert blocks == [b"\x01" * BLOCK, *[bytes(BLOCK)] * 100]


@in_virtual_time
async def test_the_attribute_played_is_the_reported_position_plus_a_short_estimate() -> None:
    line = PageLine()
    line.take(window := Speaker(line))
    line.play(tone(3.0))
    assert len(window.sound) == AHEAD * 2
    assert line.played == 0.0
    await past(1.0)
    assert line.played == 0.0  # the window has not reported that the sound plays
    window.played(0.5)
    assert line.played == 0.5
    await past(0.1)
    assert line.played == 0.6  # the line assumes that the loudspeaker has continued
    await past(1.0)
    assert line.played == 0.7  # it assumes this only for a short time without a report
    window.played(0.6)
    assert line.played == 0.7  # the position never decreases
    window.played(1.0)
    window.played(1.0)
    await past(1.0)
    assert line.played == 1.0  # two equal reports: the loudspeaker does not play
    assert len(window.sound) == 2 * 2 * AHEAD


@in_virtual_time
async def test_a_window_cannot_report_more_sound_than_it_has_received() -> None:
    line = PageLine()
    line.take(window := Speaker(line))
    line.play(tone(1.0))
    window.played(1000.0)
    assert line.played == 1.0
    await line.drained()


@in_virtual_time
async def test_a_line_is_drained_once_everything_has_been_played() -> None:
    line = PageLine()
    await line.drained()
    line.take(window := Speaker(line))
    line.play(tone(0.5))
    line.play(tone(0.5))
    waiting = asyncio.create_task(line.drained())
    window.played(0.9)
    await past(0.0)
    assert not waiting.done()
    window.played(1.0)
    await waiting


@in_virtual_time
async def test_the_method_stop_drops_the_remaining_sound_and_keeps_the_position() -> None:
    line = PageLine()
    line.take(window := Speaker(line))
    line.play(tone(3.0))
    window.played(0.5)
    stream = line.stream
    line.stop()
    await line.drained()
    assert (line.stream, line.played) == (stream + 1, 0.5)
    line.report(window, stream, 24_000)  # a late report about the dropped stream
    assert line.played == 0.5
    window.sound = b""
    line.play(tone(1.0))
    assert window.sound == tone(1.0)
    window.played(0.25)
    assert line.played == 0.75


@in_virtual_time
async def test_only_one_window_has_the_line_and_the_other_gets_a_message() -> None:
    line = PageLine()
    line.take(one := Speaker(line))
    line.take(one)
    line.play(tone(1.0))
    line.take(other := Speaker(line))
    assert (one.lost, other.lost) == (["the microphone is on in another window"], [])
    line.hear(one, bytes([1]) * BLOCK)
    line.hear(other, bytes([2]) * BLOCK)
    assert await taken(line, 1) == [bytes([2]) * BLOCK]
    line.play(tone(0.5))
    assert other.sound == tone(0.5)
    line.leave(one)  # this window has already lost the line
    assert line.window is other


@in_virtual_time
async def test_without_a_window_all_sound_immediately_counts_as_played() -> None:
    line = PageLine()
    line.play(tone(1.5))
    await line.drained()
    assert line.played == 1.5
    line.take(window := Speaker(line))
    assert window.sound == b""


@in_virtual_time
async def test_a_window_that_does_not_play_its_sound_loses_the_line() -> None:
    line = PageLine()
    line.take(window := Speaker(line))
    listening = asyncio.create_task(anext(line.blocks()))
    await past(60.0)
    assert window.lost == []  # there is no sound to play
    line.play(tone(3.0))
    await past(4.0)
    window.played(0.1)
    await past(4.0)
    assert line.window is window
    await past(2.0)
    assert (line.window, window.lost) == (None, ["the sound does not play"])
    await line.drained()
    await listening


@in_virtual_time
async def test_a_window_gets_a_message_if_the_agent_does_not_read_the_sound() -> None:
    left: list[int] = []
    line = PageLine(lambda: left.append(1))
    line.take(window := Speaker(line))
    await past(29.0)
    assert window.lost == []
    await past(2.0)
    assert (window.lost, left) == (["the agent cannot hear at the moment"], [1])


@in_virtual_time
async def test_a_closed_line_yields_no_blocks_and_plays_nothing() -> None:
    line = PageLine()
    line.take(window := Speaker(line))
    blocks = [asyncio.create_task(anext(line.blocks(), None)) for _ in range(2)]
    await past(0.0)
    line.close()
    line.play(tone(1.0))
    assert (await asyncio.gather(*blocks), window.sound) == ([None, None], b"")


@pytest.mark.parametrize(("modules", "able"), [((ears, story), True), ((parrot, rawio), False)])
def test_an_agent_can_hear_if_a_rule_uses_the_line(modules: tuple[rs.Module, ...], able: bool) -> None:
    assert hears(rs.compile(*modules)) is able


def test_an_agent_can_hear_if_a_rule_only_reads_the_line() -> None:
    deaf = rs.Module("deaf", requires=(rawio,))

    @deaf.rule(when=rawio.output.changed, reads=rawio.sound)
    async def play(ctx: rs.RuleContext) -> None: ...

    assert hears(rs.compile(deaf))
