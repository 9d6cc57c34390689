"""The ROS 2 platform that the documentation shows, with a stand-in for ROS; and its mouth, with a program."""

import asyncio
import os
import sys
import threading
from collections.abc import Iterator
from importlib import import_module
from pathlib import Path

import pytest

import ravestate as rs
from ravestate.modules import rawio
from repo.snippets import STAND_INS, blocks_in, save

PAGE = Path(__file__).parents[2] / "docs" / "how-to" / "connect-speech-or-a-robot.md"


@pytest.fixture(autouse=True)
def files(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    """The page's files, to be imported."""
    for block in blocks_in(PAGE):
        save(block, tmp_path)
    monkeypatch.setattr(sys, "path", [str(tmp_path), str(STAND_INS), *sys.path])
    before = set(sys.modules)
    yield
    for name in set(sys.modules) - before:
        if str(getattr(sys.modules[name], "__file__", "")).startswith((str(tmp_path), str(STAND_INS))):
            del sys.modules[name]


def test_a_robot_is_heard_and_told_what_to_say() -> None:
    robot, storyteller = import_module("robot"), import_module("storyteller")
    rclpy, string = import_module("rclpy"), import_module("std_msgs.msg").String

    async def talk() -> list[str]:
        said: list[str] = []
        async with rs.Context(storyteller, robot) as context:
            await context.next(robot.publisher.changed, timeout=10)
            node = rclpy.create_node("listener")
            node.create_subscription(string, "say", lambda message: said.append(message.data), 10)
            for _ in range(2):
                answer = asyncio.ensure_future(context.next(robot.rawio.output.changed, timeout=10))
                await asyncio.sleep(0)  # it waits
                node.create_publisher(string, "heard", 10).publish(string(data="Enough."))
                await answer
            await context.quiet()
        with pytest.raises(import_module("rclpy.executors").ExternalShutdownException):
            rclpy.spin(node)
        return said

    assert asyncio.run(talk()) == ["Good night.", "Good night."]
    assert "ros" not in [thread.name for thread in threading.enumerate()]
    assert asyncio.run(talk()) == ["Good night.", "Good night."]  # it may be begun again


def test_the_telephone_is_a_whole_line() -> None:
    telephone = import_module("telephone").Telephone
    assert {name for name in vars(rawio.Line) if not name.startswith("_")} <= set(dir(telephone))


def test_a_program_speaks_and_is_silent_when_cancelled(tmp_path: Path) -> None:
    devices = import_module("devices")
    heard, begun = tmp_path / "heard", tmp_path / "begun"
    keep = f"import sys, pathlib; pathlib.Path({str(heard)!r}).write_text(sys.stdin.read())"
    asyncio.run(devices.Program(sys.executable, "-c", keep).say("Good night."))
    assert heard.read_text() == "Good night."

    os.mkfifo(begun)
    endless = f"import pathlib, signal; pathlib.Path({str(begun)!r}).write_text('yes'); signal.pause()"

    async def interrupt() -> None:
        saying = asyncio.create_task(devices.Program(sys.executable, "-c", endless).say("Once upon a time"))
        assert await asyncio.to_thread(begun.read_text) == "yes"
        saying.cancel()
        await saying

    with pytest.raises(asyncio.CancelledError):
        asyncio.run(interrupt())  # and not never
