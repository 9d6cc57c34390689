"""Run servers and Chromium for browser tests, on a loop in a separate thread.

Playwright needs a running loop in its thread; other tests need a thread without a running loop.
"""

from __future__ import annotations

import asyncio
import contextlib
import functools
import os
import shutil
import threading
from collections.abc import AsyncGenerator, Callable, Coroutine, Iterator
from pathlib import Path
from typing import Any

from playwright.async_api import Browser, Page, Playwright, async_playwright, expect

from ravestate.modules import webio
from ravestate.modules.platform.webio.server import Server
from ravestate.runtime.agent import Agent

__all__ = ["PHONE", "Host", "Stage", "hide", "on_stage"]

LIMIT = 180
"""The time after which a test fails (seconds)."""

expect.set_options(timeout=30_000)  # milliseconds; long, so that the tests also pass on a slow machine

PHONE = {"viewport": {"width": 360, "height": 640}, "has_touch": True, "is_mobile": True}
CHROMIUM = ("chromium", "chromium-browser")
SHELL = "chromium-headless-shell"
"""Chromium without windows is three times as fast. But it cannot deny a page the microphone or the camera."""
FLAGS = [
    "--no-sandbox",  # for tests that run as root, in a container
    "--disable-gpu",
    "--disable-quic",
    "--no-first-run",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
]
"""Most of these flags keep Chromium from contacting other servers."""


async def hide(page: Page) -> None:
    """Put a page in the background, as if the visitor had opened another tab."""
    await page.evaluate(
        "Object.defineProperty(document, 'visibilityState', {value: 'hidden'});"
        "document.dispatchEvent(new Event('visibilitychange'))"
    )


class Host:
    """A server with an agent's page. A test can interrupt the network between the server and its clients."""

    def __init__(self, server: Server) -> None:
        self.server = server
        self.address = server.address

    @property
    def app(self) -> Any:
        """The application, with its conversations in ``app.state.sessions``."""
        return self.server.app

    @property
    def sessions(self) -> list[Any]:
        """The running conversations."""
        return list(self.app.state.sessions)

    def drop(self) -> None:
        """Lose all connections, as when the network fails."""
        uvicorn = self.server.uvicorn
        assert uvicorn is not None
        for connection in list(uvicorn.server_state.connections):
            connection.transport.abort()

    @contextlib.contextmanager
    def away(self) -> Iterator[None]:
        """Lose all connections, and refuse new connections until the ``with`` block ends."""
        access = self.app.state.access
        access.refusal = lambda headers: "away"
        self.drop()
        try:
            yield
        finally:
            del access.refusal


class Stage:
    """Chromium, and the loop that controls it. Close it after use."""

    def __init__(self) -> None:
        self._loop = asyncio.new_event_loop()
        self._thread = threading.Thread(target=self._loop.run_forever, name="stage")
        self._thread.start()
        self._over = contextlib.AsyncExitStack()
        self._playwright: Playwright = self.run(self._over.enter_async_context(async_playwright()))
        self.browser: Browser = self.run(self._over.enter_async_context(self.launch(windows=False)))

    @contextlib.asynccontextmanager
    async def launch(self, *flags: str, windows: bool = True) -> AsyncGenerator[Browser]:
        """Start Chromium with additional flags. Without `windows`, prefer the headless shell."""
        names = CHROMIUM if windows else (SHELL, *CHROMIUM)
        found = os.environ.get("CHROMIUM") or next(filter(None, map(shutil.which, names)), None)
        if found is None:
            raise AssertionError(
                "the browser tests need Chromium: apt-get install chromium, or set CHROMIUM=/path/to/chromium"
            )
        browser = await self._playwright.chromium.launch(executable_path=found, args=[*FLAGS, *flags])
        try:
            yield browser
        finally:
            await browser.close()

    def devices(self, *, sound: str = "", film: Path | None = None) -> contextlib.AbstractAsyncContextManager[Browser]:
        """Start Chromium with a microphone and a camera that play files. Pages can use both without asking.

        Args:
            sound: The recording that the microphone repeats. If the name ends in ``%noloop``, it plays once.
            film: The video that the camera repeats.
        """
        flags = ["--use-fake-device-for-media-stream", "--use-fake-ui-for-media-stream"]
        if sound:
            flags.append(f"--use-file-for-fake-audio-capture={sound}")
        if film is not None:
            flags.append(f"--use-file-for-fake-video-capture={film}")
        return self.launch(*flags)

    def run(self, work: Coroutine[Any, Any, Any]) -> Any:
        """Run a coroutine on the loop of the stage; return its result."""

        async def limited() -> Any:
            async with asyncio.timeout(LIMIT):
                return await work

        return asyncio.run_coroutine_threadsafe(limited(), self._loop).result()

    def close(self) -> None:
        """Close Chromium, and end the loop."""
        self.run(self._over.aclose())
        self._loop.call_soon_threadsafe(self._loop.stop)
        self._thread.join()
        self._loop.close()

    @contextlib.asynccontextmanager
    async def serve(self, *modules: Any, **settings: Any) -> AsyncGenerator[Host]:
        """Serve the chat page of an agent with these modules and settings of `webio`."""
        agent = Agent(*modules, webio, settings={"webio": {"port": 0, **settings}})
        async with Server(agent) as server:
            yield Host(server)

    @contextlib.asynccontextmanager
    async def open(
        self, address: str, *, complaints: bool = False, browser: Browser | None = None, **options: Any
    ) -> AsyncGenerator[Page]:
        """Open a page in a new window, which shares no data with other windows.

        Args:
            address: The address of the page.
            browser: The browser; by default, the one that all tests share.
            complaints: Whether the browser may report errors (e.g. a lost connection). Otherwise an error fails the test.
            options: Options of the window, e.g. `PHONE`.
        """
        window = await (browser or self.browser).new_context(reduced_motion="reduce", **options)
        heard: list[str] = []
        try:
            page = await window.new_page()
            page.set_default_timeout(15_000)
            page.on("pageerror", lambda error: heard.append(f"{error}"))
            page.on("console", lambda said: heard.append(said.text) if said.type == "error" else None)
            await page.goto(address)
            yield page
        finally:
            await window.close()
        assert complaints or not heard, heard


def on_stage(test: Callable[..., Coroutine[Any, Any, None]]) -> Callable[..., None]:
    """Run an async test function on the loop of the stage. The stage is its first argument."""

    @functools.wraps(test)
    def run(stage: Stage, **fixtures: Any) -> None:
        stage.run(test(stage, **fixtures))

    return run
