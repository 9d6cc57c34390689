"""Spoken conversations on the chat page, in a real browser whose microphone plays a recording."""

import contextlib
import re
import wave
from pathlib import Path
from typing import Any

import pytest
from playwright.async_api import Browser, Page, expect

from end_to_end.host import host
from end_to_end.stage import PHONE, Host, Stage, hide, on_stage
from end_to_end.test_access import findings
from end_to_end.test_widget import Museum
from modules.platform.webio.ears import SAGA, WORD, babble, ears, saga, story
from ravestate.modules import rawio

ANSWER = "I heard a sound, and that pleases me."
RATE = 16_000


def record(file: Path, *parts: float) -> Path:
    """Write a recording with half a minute of silence at its end.

    Each part is a number of seconds: voice if it is positive, silence if it is negative.
    """
    with wave.open(str(file), "wb") as sound:
        sound.setnchannels(1)
        sound.setsampwidth(2)
        sound.setframerate(RATE)
        for seconds in (*parts, -30.0):
            sound.writeframes(babble(seconds, RATE) if seconds > 0 else bytes(2 * round(-seconds * RATE)))
    return file


def calls(stage: Stage, recording: Path) -> contextlib.AbstractAsyncContextManager[Browser]:
    """Start a browser whose microphone plays a recording once, as soon as the page turns the microphone on."""
    return stage.devices(sound=f"{recording}%noloop")


def bar(page: Page) -> Any:
    return page.get_by_role("region", name="Voice")


def lines(page: Page) -> Any:
    return page.locator(".line")


async def turn_on(page: Page) -> None:
    await page.get_by_role("button", name="Talk with").click()
    await expect(bar(page)).to_contain_text("The microphone is on.")


def line_of(served: Host) -> Any:
    (session,) = served.sessions
    return session.line


@on_stage
async def test_a_visitor_talks_with_the_agent_by_voice(stage: Stage, tmp_path: Path) -> None:
    async with (
        calls(stage, record(tmp_path / "voice.wav", -0.5, 1.0)) as browser,
        stage.serve(ears, story, title="Elske") as served,
        stage.open(served.address, browser=browser) as page,
    ):
        await turn_on(page)
        await expect(bar(page)).to_contain_text("seconds so far")
        await expect(lines(page)).to_have_text(["You: a sound", f"Elske: {ANSWER}"])
        await expect(bar(page)).to_contain_text("Elske is speaking.")
        await expect(bar(page)).to_contain_text("The microphone is on.")  # the agent is no longer speaking
        (session,) = served.sessions
        assert session.context.read(rawio.heard) == ANSWER
        assert session.line.played == pytest.approx(len(ANSWER.split()) * WORD)
        await page.get_by_role("button", name="Turn the microphone off").click()
        await expect(bar(page)).to_have_count(0)
        assert session.line.window is None


@on_stage
async def test_a_visitor_interrupts_the_agent_by_voice_and_with_the_button(stage: Stage, tmp_path: Path) -> None:
    async with (
        calls(stage, record(tmp_path / "voice.wav", -0.5, 1.0, -2.5, 1.0)) as browser,
        stage.serve(ears, saga, title="Elske") as served,
        stage.open(served.address, browser=browser) as page,
    ):
        await turn_on(page)
        first = page.locator(".line.agent").nth(0)
        await expect(first).to_contain_text("(interrupted)")
        cut = str(await first.text_content()).split("Elske:")[1].split("(")[0].strip()
        assert cut
        assert SAGA.startswith(cut)
        second = page.locator(".line.agent").nth(1)
        await expect(second).to_have_text(f"Elske: {SAGA}")
        await page.get_by_role("button", name="Stop").click()
        await expect(second).to_contain_text("(interrupted)")
        await expect(bar(page)).to_contain_text("The microphone is on.")


@on_stage
async def test_push_to_talk_works_with_the_mouse_and_with_a_key(stage: Stage, tmp_path: Path) -> None:
    async with (
        calls(stage, record(tmp_path / "voice.wav", 20.0)) as browser,
        stage.serve(ears, saga, title="Elske") as served,
        stage.open(served.address, browser=browser) as page,
    ):
        button = page.get_by_role("button", name="Talk with Elske")
        await button.hover()
        await page.mouse.down()
        # Hold the button for a while.
        await expect(bar(page)).to_contain_text(re.compile(r"(0\.[6-9]|[1-9]\.\d) seconds so far"))
        await page.mouse.up()
        # The agent hears no more, although the recording continues.
        await expect(lines(page).nth(0)).to_have_text("You: a sound")
        await expect(page.get_by_role("button", name="Hold to talk")).to_have_attribute("aria-pressed", "false")
        await page.get_by_role("button", name="Stop").click()
        await page.get_by_role("button", name="Hold to talk").focus()
        await page.keyboard.down("Space")
        await expect(bar(page)).to_contain_text("seconds so far")
        await page.keyboard.up("Space")
        await expect(lines(page).nth(2)).to_have_text("You: a sound")
        await page.get_by_role("button", name="End voice").click()
        await expect(bar(page)).to_have_count(0)


@on_stage
async def test_on_a_phone_every_button_is_large_enough_for_a_finger(stage: Stage, tmp_path: Path) -> None:
    async with (
        calls(stage, record(tmp_path / "voice.wav", -0.5, 1.0)) as browser,
        stage.serve(ears, saga, title="Elske") as served,
        stage.open(served.address, browser=browser, **PHONE) as page,
    ):
        await page.get_by_role("button", name="Talk with Elske").tap()
        stop = page.get_by_role("button", name="Stop")
        await expect(stop).to_be_visible()
        for button in await page.get_by_role("button").all():
            box = await button.bounding_box()
            assert box is not None
            assert min(box["width"], box["height"]) >= 44, await button.text_content()
            assert box["x"] >= 0
            assert box["x"] + box["width"] <= 360
        assert await page.evaluate("document.documentElement.scrollWidth") == 360
        assert await findings(page) == []
        await expect(lines(page).nth(1)).to_be_in_viewport()
        await stop.tap()
        await expect(page.locator(".line.agent")).to_contain_text("(interrupted)")


@on_stage
async def test_the_microphone_goes_off_when_the_page_goes_to_the_background(stage: Stage, tmp_path: Path) -> None:
    async with (
        calls(stage, record(tmp_path / "voice.wav")) as browser,
        stage.serve(ears, story, title="Elske") as served,
        stage.open(served.address, browser=browser) as page,
    ):
        await turn_on(page)
        await hide(page)
        await expect(page.get_by_role("alert")).to_have_text("The microphone is off: the page was in the background.")
        await expect(bar(page)).to_have_count(0)
        assert line_of(served).window is None


@on_stage
async def test_after_a_lost_connection_the_microphone_is_still_on(stage: Stage, tmp_path: Path) -> None:
    async with (
        calls(stage, record(tmp_path / "voice.wav", -0.5, 1.0, -3.0, 1.0)) as browser,
        stage.serve(ears, story, title="Elske") as served,
        stage.open(served.address, browser=browser, complaints=True) as page,
    ):
        await turn_on(page)
        await expect(bar(page)).to_contain_text("Elske is speaking.")
        served.drop()
        await expect(bar(page)).to_contain_text("The microphone is on.")
        await expect(page.locator(".line.user")).to_have_count(2)
        await expect(bar(page)).to_contain_text("Elske is speaking.")


@on_stage
async def test_turning_the_microphone_on_in_one_window_turns_it_off_in_the_other(stage: Stage, tmp_path: Path) -> None:
    async with (
        calls(stage, record(tmp_path / "voice.wav")) as browser,
        stage.serve(ears, story, title="Elske") as served,
        stage.open(served.address, browser=browser) as page,
    ):
        await turn_on(page)
        kept = await page.evaluate("sessionStorage.getItem('ravestate')")
        second = await page.context.new_page()
        await second.add_init_script(f"sessionStorage.setItem('ravestate', {kept!r})")
        await second.goto(served.address)
        await turn_on(second)
        await expect(page.get_by_role("alert")).to_contain_text("the microphone is on in another window")
        assert line_of(served).window is not None


@on_stage
async def test_a_visitor_can_speak_in_the_widget_on_another_site(stage: Stage, tmp_path: Path) -> None:
    async with (
        calls(stage, record(tmp_path / "voice.wav", -0.5, 1.0)) as browser,
        Museum().serve() as museum,
        stage.serve(ears, story, title="Elske", origins=(museum.origin,)) as served,
    ):
        museum.chat = served.address
        async with stage.open(museum.origin, browser=browser) as page:
            button = page.get_by_role("button", name="Ask us")
            await button.click()
            chat = page.frame_locator("iframe[title='Ask us']")
            await chat.get_by_role("button", name="Talk with Elske").click()
            await expect(chat.locator(".line")).to_have_text(["You: a sound", f"Elske: {ANSWER}"])
            await button.click()  # this closes the chat, so the agent no longer hears the visitor
            await expect(chat.get_by_role("region", name="Voice")).to_have_count(0)
            assert line_of(served).window is None


@on_stage
async def test_a_visitor_who_refuses_the_microphone_gets_advice_and_can_turn_it_on_later(stage: Stage) -> None:
    async with (
        stage.launch("--use-fake-device-for-media-stream", "--deny-permission-prompts") as browser,
        stage.serve(ears, story, title="Elske") as served,
        stage.open(served.address, browser=browser) as page,
    ):
        await page.get_by_role("button", name="Talk with Elske").click()
        await expect(page.get_by_role("alert")).to_contain_text("The microphone is not allowed.")
        await expect(bar(page)).to_have_count(0)
        await page.context.grant_permissions(["microphone"])
        await turn_on(page)
        await expect(page.get_by_role("alert")).to_have_count(0)


@on_stage
async def test_without_a_microphone_the_page_says_what_to_do(stage: Stage) -> None:
    async with stage.serve(ears, story) as served, stage.open(served.address, permissions=["microphone"]) as page:
        await page.get_by_role("button", name="Talk with").click()
        await expect(page.get_by_role("alert")).to_contain_text("There is no microphone. Connect one")


@on_stage
async def test_over_plain_http_the_page_says_that_it_needs_https(stage: Stage) -> None:
    token = "open sesame, please"
    async with (
        stage.launch("--host-resolver-rules=MAP guide.example 127.0.0.1") as browser,
        stage.serve(ears, story, token=token) as served,
        stage.open(f"{served.address.replace('127.0.0.1', 'guide.example')}#token={token}", browser=browser) as page,
    ):
        await page.get_by_role("button", name="Talk with").click()
        await expect(page.get_by_role("alert")).to_contain_text("only over https")


@on_stage
async def test_the_page_of_an_agent_that_cannot_hear_has_no_microphone_button(stage: Stage) -> None:
    async with stage.serve(host, title="Elske") as served, stage.open(served.address) as page:
        await expect(lines(page)).to_have_text("Elske: Good evening.")
        await expect(page.get_by_role("button", name="Talk with")).to_have_count(0)
