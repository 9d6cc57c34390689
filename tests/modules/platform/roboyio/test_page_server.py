"""The page of the stand-in robot."""

import asyncio
import contextlib
import json
from typing import Any

import pytest
import websockets

from modules.platform.ros.networks import PATIENCE, opened
from ravestate.modules import roboyio, ros2
from ravestate.modules.platform.roboyio.page_server import PageServer
from ravestate.modules.platform.roboyio.stand_in import StandIn
from ravestate.modules.platform.ros import Bus


@pytest.mark.parametrize(
    "frame",
    [
        r'{"say": "\ud83d"}',  # JSON.stringify writes a half of an emoji like this
        r'{"people": ["\ud83d"]}',
        '{"say": "hello", "direction": ' + "9" * 400 + "}",
        "[" * 20_000,
        "no JSON",
        b"\0",
    ],
)
def test_the_robot_ignores_a_malformed_frame(frame: str | bytes, caplog: pytest.LogCaptureFixture) -> None:
    async def news(server: PageServer, *frames: str | bytes) -> list[dict[str, Any]]:
        """Return what the page shows, until it shows Ada or its connection ends."""
        found: list[dict[str, Any]] = []
        async with websockets.connect(f"{server.address.replace('http', 'ws')}ws") as page:
            for one in frames:
                await page.send(one)
            with contextlib.suppress(websockets.ConnectionClosedError):
                async for text in page:
                    found.append(json.loads(text))
                    if found[-1]["people"] == ["Ada"]:
                        break
        return found

    async def main() -> None:
        async with Bus(0) as bus, opened(ros2.make_node(ros2.Settings(backend="bus", bus=bus.address))) as node:
            robot = StandIn(roboyio.load_robot("roboy"), node)
            async with PageServer(robot, 0) as server, asyncio.timeout(PATIENCE):
                await news(server, frame, b"\0")  # the binary frame ends this connection
                assert (await news(server, '{"people": ["Ada"]}'))[-1]["people"] == ["Ada"]

    asyncio.run(main())
    assert not caplog.messages
