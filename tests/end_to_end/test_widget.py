"""The widget: the chat on another site's page."""

import asyncio
import contextlib
from collections.abc import AsyncGenerator

import pytest
from playwright.async_api import expect

from end_to_end.host import host, watcher
from end_to_end.stage import PHONE, Stage, on_stage

PAGE = """<!doctype html><html lang="en"><title>A museum</title><meta name="viewport" content="width=device-width">
<link rel="icon" href="data:,">
<h1>Our museum</h1><script src="%swidget.js" data-title="Ask us" defer></script></html>"""


class Museum:
    """Another web site, which embeds the chat."""

    def __init__(self) -> None:
        self.origin = ""
        self.chat = ""

    @contextlib.asynccontextmanager
    async def serve(self) -> AsyncGenerator["Museum"]:
        """Serve the only page of the site."""
        server = await asyncio.start_server(self._answer, "127.0.0.1", 0)
        async with server:
            self.origin = f"http://localhost:{server.sockets[0].getsockname()[1]}"
            yield self

    async def _answer(self, reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        await reader.readuntil(b"\r\n\r\n")
        body = (PAGE % self.chat).encode()
        # This strict policy allows neither inline styles nor inline scripts.
        policy = f"default-src 'none'; script-src {self.chat}; frame-src {self.chat}; img-src data:"
        writer.write(
            f"HTTP/1.1 200 OK\r\ncontent-type: text/html\r\ncontent-length: {len(body)}\r\n"
            f"content-security-policy: {policy}\r\nconnection: close\r\n\r\n".encode()
            + body
        )
        await writer.drain()
        writer.close()


@on_stage
async def test_the_widget_opens_and_closes_the_chat_on_another_site(stage: Stage) -> None:
    async with (
        Museum().serve() as museum,
        stage.serve(host, title="Elske", origins=(museum.origin,)) as served,
    ):
        museum.chat = served.address
        async with stage.open(museum.origin) as page:
            button = page.get_by_role("button", name="Ask us")
            await expect(button).to_have_attribute("aria-expanded", "false")
            assert served.sessions == []  # no conversation begins before the click
            await button.click()
            await expect(button).to_have_attribute("aria-expanded", "true")
            chat = page.frame_locator("iframe[title='Ask us']")
            field = chat.get_by_label("What you say to Elske")
            await field.fill("hello")
            await field.press("Enter")
            await expect(chat.get_by_text("You said: hello")).to_be_visible()
            await field.press("Escape")
            await expect(button).to_be_focused()
            await expect(field).to_be_hidden()
            await button.click()
            await expect(chat.get_by_text("You said: hello")).to_be_visible()
            await chat.get_by_role("button", name="Close").click()
            await expect(field).to_be_hidden()


@on_stage
async def test_on_another_site_the_agent_learns_that_the_visitor_is_typing(stage: Stage) -> None:
    async with (
        Museum().serve() as museum,
        stage.serve(watcher, title="Elske", origins=(museum.origin,)) as served,
    ):
        museum.chat = served.address
        async with stage.open(museum.origin) as page:
            await page.get_by_role("button", name="Ask us").click()
            chat = page.frame_locator("iframe[title='Ask us']")
            await chat.get_by_label("What you say to Elske").press("H")
            await expect(chat.get_by_text("You are writing.")).to_be_visible()


@on_stage
async def test_on_a_phone_the_widget_takes_the_whole_screen(stage: Stage) -> None:
    async with (
        Museum().serve() as museum,
        stage.serve(host, title="Elske", origins=(museum.origin,)) as served,
    ):
        museum.chat = served.address
        async with stage.open(museum.origin, **PHONE) as page:
            await page.get_by_role("button", name="Ask us").click()
            frame = await page.locator("iframe").bounding_box()
            assert frame is not None
            size = await page.evaluate("[innerWidth, innerHeight]")
            assert [frame["width"], frame["height"]] == size


@on_stage
async def test_a_site_without_permission_cannot_embed_the_chat_and_the_console_says_why(
    stage: Stage, caplog: pytest.LogCaptureFixture
) -> None:
    async with Museum().serve() as museum, stage.serve(host, title="Elske") as served:
        museum.chat = served.address
        why = f"page of {museum.origin} may not embed the chat: add it to the setting webio.origins"
        async with stage.open(museum.origin, complaints=True) as page:
            async with page.expect_console_message(lambda said: why in said.text):
                await page.get_by_role("button", name="Ask us").click()
            assert served.sessions == []
        assert [record.getMessage() for record in caplog.records] == [f"a {why}"]
