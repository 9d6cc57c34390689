"""The accessibility of the chat page, checked by axe, and the size of its scripts."""

import asyncio
import gzip
import json
from pathlib import Path

import pytest
from playwright.async_api import Page, expect

from end_to_end.host import Cue, host, storyteller
from end_to_end.stage import PHONE, Stage, on_stage
from ravestate.modules.platform.webio.application import PAGE

AXE = Path(__file__).parents[2] / "frontend" / "node_modules" / "axe-core" / "axe.min.js"
SCRIPT = 60_000
"""The maximum size of all scripts of the page, compressed (bytes)."""


async def findings(page: Page) -> list[str]:
    """Return axe's serious and critical findings."""
    if not AXE.exists():
        raise AssertionError("the accessibility tests need axe-core: run npm ci --prefix frontend")
    # The page forbids other scripts, so run axe as the browser's developer tools would.
    await page.evaluate(AXE.read_text(encoding="utf-8"))
    found = await page.evaluate("axe.run({resultTypes: ['violations']})")
    return [
        json.dumps([violation["id"], violation["help"], [node["html"] for node in violation["nodes"]]])
        for violation in found["violations"]
        if violation["impact"] in ("serious", "critical")
    ]


@pytest.mark.parametrize("scheme", ["light", "dark"])
@pytest.mark.parametrize("size", [{}, PHONE], ids=["desk", "phone"])
@on_stage
async def test_axe_finds_nothing_serious_in_any_state_of_the_page(
    stage: Stage, scheme: str, size: dict[str, object]
) -> None:
    Cue.thought, Cue.told = asyncio.Event(), asyncio.Event()
    options = {"color_scheme": scheme, **size}
    async with (
        stage.serve(host, storyteller, title="Elske") as served,
        stage.open(served.address, complaints=True, **options) as page,
    ):
        field, found = page.get_by_label("What you say to Elske"), []

        async def check(state: str) -> None:
            found.extend(f"{state}: {finding}" for finding in await findings(page))

        await expect(page.get_by_text("Good evening.")).to_be_visible()
        await check("greeted")
        await field.fill("Tell me a story.")
        await field.press("Enter")
        await expect(page.locator(".typing")).to_be_visible()
        await check("thinking")
        Cue.thought.set()
        await expect(page.locator(".partial")).to_be_visible()
        await check("speaking")
        Cue.told.set()
        await expect(page.locator(".partial")).to_be_hidden()
        with served.away():
            await field.fill("Are you there?")
            await field.press("Enter")
            await expect(page.get_by_text("The connection is lost.")).to_be_visible()
            await check("lost")
        await page.get_by_role("button", name="Leave").click()
        await check("leaving")
        await page.get_by_role("dialog").get_by_role("button", name="Leave").click()
        await expect(page.get_by_role("button", name="Begin a new conversation")).to_be_visible()
        await check("left")
        assert not found, "\n".join(found)


@on_stage
async def test_axe_finds_nothing_serious_on_a_page_that_asks_for_a_token(stage: Stage) -> None:
    async with (
        stage.serve(host, token="open sesame, please") as served,
        stage.open(served.address) as page,
    ):
        await expect(page.get_by_label("Token")).to_be_visible()
        assert await findings(page) == []


@on_stage
async def test_the_page_loads_only_small_scripts_and_only_from_its_own_server(stage: Stage) -> None:
    async with stage.serve(host) as served, stage.open(served.address) as page:
        await expect(page.get_by_text("Good evening.")).to_be_visible()
        loaded = await page.evaluate("performance.getEntriesByType('resource').map((entry) => entry.name)")
        assert all(address.startswith(served.address) for address in loaded), loaded
        scripts = [PAGE / address.removeprefix(served.address) for address in loaded if address.endswith(".js")]
        assert 0 < sum(len(gzip.compress(script.read_bytes())) for script in scripts) < SCRIPT
