"""The page of the stand-in robot, and its pictures for the documentation.

To renew the pictures, run `PICTURES=docs/pictures pytest ...`.
"""

import contextlib
import os
import struct
from collections.abc import AsyncGenerator
from pathlib import Path

from playwright.async_api import expect

import ravestate as rs
from end_to_end.stage import Stage, on_stage
from ravestate.modules import emotion, rawio, roboyio, ros2
from ravestate.modules.platform.roboyio.page_server import PageServer
from ravestate.modules.platform.roboyio.stand_in import StandIn
from ravestate.modules.platform.ros import Bus

SIZE = {"width": 920, "height": 620}
guide = rs.Module("guide", requires=(rawio, emotion))


@guide.rule(when=rawio.input.changed, writes=rawio.output, emits=emotion.happy)
async def answer(ctx: rs.RuleContext) -> None:
    ctx.emit(emotion.happy)
    ctx[rawio.output] = "Hello! I am so glad that you came to see me today."


@contextlib.asynccontextmanager
async def stand_in() -> AsyncGenerator[tuple[StandIn, PageServer, Bus]]:
    async with Bus(0) as bus:
        node = ros2.make_node(ros2.Settings(backend="bus", bus=bus.address))
        robot = StandIn(roboyio.load_robot("roboy"), node)
        try:
            async with PageServer(robot, 0) as server:
                yield robot, server, bus
        finally:
            await robot.close()
            await node.close()


@on_stage
async def test_a_visitor_talks_with_the_robot(stage: Stage, tmp_path: Path) -> None:
    folder = Path(os.environ.get("PICTURES", tmp_path))
    async with (
        stand_in() as (_, server, bus),
        stage.open(server.address, viewport=SIZE, color_scheme="light") as page,
    ):
        face = page.locator("svg[role=img]")
        await expect(face).to_have_attribute("data-face", "neutral")
        settings = {"roboyio": {"bus": bus.address, "look_around": 1000.0}}
        async with rs.Context(roboyio, emotion, guide, settings=settings) as context:
            await expect(page.get_by_role("heading", name="Roboy")).to_be_visible()
            await expect(page.get_by_role("button", name="Say")).to_be_enabled()
            while context.read(roboyio.body) is None or not bus.find(
                "subscriber", "/roboy/cognition/speech/recognition"
            ):
                await context.quiet()
                await page.wait_for_timeout(20)
            await page.get_by_label("Where you stand").fill("-0.5")
            await page.get_by_label("Say something").fill("Hello, Roboy!")
            await page.keyboard.press("Enter")
            await expect(page.locator(".bubble")).to_contain_text("I am so glad")
            await expect(face).to_have_attribute("data-face", "happy")
            await expect(face).to_have_attribute("data-yaw", "0.50")
            await expect(page.locator(".heard")).to_have_text("You: Hello, Roboy!")
            await page.wait_for_timeout(400)  # let the face finish its change
            await page.screenshot(path=folder / "robot.png")
            assert context.read(rawio.input) == "Hello, Roboy!"
            await page.get_by_role("button", name="Come into view").click()
            await expect(page.get_by_role("button", name="Leave")).to_be_visible()
            await expect(page.locator("svg[role=img] rect[rx='13']")).to_have_count(
                1
            )  # this rectangle is the waving arm
            context.emit(emotion.surprised)
            await expect(face).to_have_attribute("data-face", "surprised")
            await page.wait_for_timeout(500)  # let the arm rise
            await page.screenshot(path=folder / "robot-waves.png")
    for picture in ("robot.png", "robot-waves.png"):
        head = (folder / picture).read_bytes()[:24]
        assert struct.unpack(">II", head[16:24]) == (SIZE["width"], SIZE["height"])


@on_stage
async def test_another_site_cannot_speak_to_the_robot(stage: Stage) -> None:
    async with stand_in() as (_, server, _), stage.open(server.address, complaints=True) as page:
        answer = await page.evaluate(
            """address => new Promise(done => {
                const socket = new WebSocket(address.replace("http", "ws").replace("127.0.0.1", "localhost") + "ws");
                socket.onopen = () => done("open");
                socket.onerror = () => done("refused");
            })""",
            server.address,
        )
        assert answer == "refused"
