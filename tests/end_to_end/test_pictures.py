"""The documentation's picture of the chat page. To renew it, run `PICTURES=docs/pictures pytest ...`."""

import os
import struct
from pathlib import Path

from playwright.async_api import expect

import ravestate as rs
from end_to_end.stage import Stage, on_stage
from ravestate.modules import interloc, rawio

guide = rs.Module("guide", requires=(rawio, interloc))


@guide.rule(when=interloc.users.added, writes=rawio.output)
async def greet(ctx: rs.RuleContext) -> None:
    ctx[rawio.output] = "Good evening. I am the keeper of this house. What brings you here?"


@guide.rule(when=rawio.input.changed, writes=rawio.output)
async def answer(ctx: rs.RuleContext) -> None:
    if "?" in ctx.payload(rawio.input.changed):
        ctx[rawio.output] = (
            "Vermeer, in 1665. For the turban he used ultramarine, ground from lapis lazuli, which cost more than gold."
        )
    else:
        ctx[rawio.output] = "I like this room best as well."


@on_stage
async def test_the_picture_of_the_chat_can_be_taken(stage: Stage, tmp_path: Path) -> None:
    picture = Path(os.environ.get("PICTURES", tmp_path)) / "chat.png"
    size = {"width": 920, "height": 560}
    async with (
        stage.serve(guide, title="Elske") as served,
        stage.open(served.address, viewport=size, color_scheme="light") as page,
    ):
        await expect(page.get_by_text("What brings you here?")).to_be_visible()
        field = page.get_by_label("What you say to Elske")
        for number, text in enumerate(("It is quiet here.", "Who painted the girl with the pearl?"), start=1):
            await field.fill(text)
            await field.press("Enter")
            await expect(page.locator(".line.agent")).to_have_count(1 + number)
        await page.evaluate("document.fonts.ready")
        await page.screenshot(path=picture)
    head = picture.read_bytes()[:24]
    assert head.startswith(b"\x89PNG")
    assert struct.unpack(">II", head[16:24]) == (size["width"], size["height"])
