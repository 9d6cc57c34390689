"""A spoken conversation in a browser, with the real recogniser and voice. Raveboard shows it."""

import os
import re
import wave
from itertools import cycle
from pathlib import Path
from time import monotonic
from typing import Any

from playwright.async_api import Page, expect

import ravestate as rs
from end_to_end.stage import Host, Stage, on_stage
from ravestate.board.application import INSIDE, RecordedAgent, routes
from ravestate.modules import rawio, voiceio, webio
from ravestate.modules.platform.webio.server import Server

QUESTION = "Good evening. How are you today?"
ANSWER = "I am quite well, thank you. " + "Let me tell you about the hills and the rivers of my country. " * 8
PATIENCE = 30_000  # milliseconds: models load, and recogniser and voice share the processor with the browser

guide = rs.Module("guide", requires=(rawio,))


@guide.rule(when=rawio.input.changed, writes=rawio.output)
async def answer(ctx: rs.RuleContext) -> None:
    """Talk for a long time, so that the user can interrupt."""
    ctx[rawio.output] = ANSWER


def ask_again_and_again(file: Path) -> Path:
    """Write a recording of the question and ten seconds of silence. The browser plays it in a loop."""
    with wave.open(str(file), "wb") as sound:
        sound.setnchannels(1)
        sound.setsampwidth(2)
        sound.setframerate(rawio.OUT_RATE)
        speech = voiceio.speak(QUESTION, voiceio.Settings(voice="espeak"))
        for part in (bytes(2 * rawio.OUT_RATE), speech, bytes(18 * rawio.OUT_RATE)):
            sound.writeframes(part)
    return file


async def point(board: Page, lane: str, words: str) -> None:
    """Move the pointer along a lane until a tooltip with these words appears, even if the board still draws its lanes."""
    tip = board.locator(".tip")
    ends = monotonic() + PATIENCE / 1000
    for step in cycle(
        (24, 12, 6, 3)
    ):  # coarse sweeps first, because on a busy machine a lane can move during a slow sweep
        if step == 24 and monotonic() > ends:
            break
        name = await board.get_by_text(lane, exact=True).bounding_box()
        canvas = await board.locator("canvas.main").bounding_box()
        assert name is not None
        assert canvas is not None
        for x in range(2, round(canvas["width"]), step):
            await board.mouse.move(canvas["x"] + x, name["y"] + name["height"] / 2)
            # The page draws the tooltip in its next frame.
            await board.evaluate("() => new Promise(requestAnimationFrame)")
            if await tip.count() and words in await tip.inner_text():
                return
    raise AssertionError(f"no tooltip in the lane {lane!r} has the words {words!r}")


@on_stage
async def test_a_spoken_question_is_answered_and_the_answer_can_be_interrupted(stage: Stage, tmp_path: Path) -> None:
    settings: dict[str, Any] = {
        "webio": {"port": 0, "title": "Elske"},
        # Captions while the user speaks would take computing time.
        "voiceio": {"model": "tiny.en", "voice": "espeak", "captions": 0},
    }
    agent = RecordedAgent(voiceio, guide, webio, settings=settings)
    recording = ask_again_and_again(tmp_path / "question.wav")
    async with (
        stage.devices(sound=str(recording)) as browser,
        Server(agent, routes(agent.recorders), inside=INSIDE) as server,
        stage.open(server.address, browser=browser) as page,
    ):
        await page.get_by_role("button", name="Talk with Elske").click()
        bar = page.get_by_role("region", name="Voice")
        await expect(bar).to_contain_text("The microphone is on.", timeout=PATIENCE)
        spoken = page.locator(".line.user").first
        await expect(spoken).to_contain_text(re.compile("good evening.*today", re.I), timeout=PATIENCE)
        said = page.locator(".line.agent").first
        await expect(said).to_contain_text("I am quite well")
        await expect(bar).to_contain_text("Elske is speaking.")
        await expect(said).to_contain_text("(interrupted)", timeout=PATIENCE)
        cut = str(await said.text_content()).split("Elske:")[1].split("(")[0].strip()
        assert ANSWER.startswith(cut)
        assert len(cut) < len(ANSWER)
        context = Host(server).sessions[0].context
        assert context.read(rawio.heard) == cut

        said = page.locator(".line.agent").nth(1)  # the recording asks again, and now the visitor presses the button
        await expect(said).to_contain_text("I am quite well", timeout=PATIENCE)
        await page.get_by_role("button", name="Stop").click()
        await expect(said).to_contain_text("(interrupted)")
        await page.get_by_role("button", name="Turn the microphone off").click()
        board = await page.context.new_page()
        await board.set_viewport_size({"width": 1180, "height": 560})
        await board.goto(f"{server.address}board/")
        await expect(board.get_by_text("agent speaks")).to_be_visible()
        await board.get_by_role("button", name="All", exact=True).click()
        await point(board, "user speaks", "speech of")
        await point(board, "user speaks", "end of turn")
        await point(board, "user speaks", "the user interrupts")
        await point(board, "agent speaks", "heard by the user; the rest was cut off")
        await board.mouse.move(0, 0)
        await board.screenshot(path=Path(os.environ.get("PICTURES", tmp_path)) / "board-voice.png")
