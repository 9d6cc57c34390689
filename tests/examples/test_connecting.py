"""The code of the page "Connect speech or a robot": a robot on the built-in bus, and speech by a program."""

import asyncio
import os
import sys
from collections.abc import Iterator
from importlib import import_module
from pathlib import Path

import pytest

import ravestate as rs
from modules.platform.ros.networks import until
from ravestate.modules import rawio, ros2
from ravestate.modules.platform.ros import Bus, quality
from repo.snippets import blocks_in, save

PAGE = Path(__file__).parents[2] / "docs" / "how-to" / "connect-speech-or-a-robot.md"


@pytest.fixture(autouse=True)
def files(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    """Save the page's files in a folder from which the tests can import them."""
    for block in blocks_in(PAGE):
        save(block, tmp_path)
    monkeypatch.setattr(sys, "path", [str(tmp_path), *sys.path])
    before = set(sys.modules)
    yield
    for name in set(sys.modules) - before:
        if str(getattr(sys.modules[name], "__file__", "")).startswith(str(tmp_path)):
            del sys.modules[name]


def test_words_from_the_robot_reach_the_agent_and_its_answers_reach_the_robot() -> None:
    robot, storyteller = import_module("robot"), import_module("storyteller")
    qos = quality(None, depth=10, latch=False)

    async def talk() -> None:
        said: list[str] = []
        async with Bus(0) as bus, asyncio.timeout(20):
            settings = {"backend": "bus", "bus": bus.address}
            node = ros2.make_node(ros2.Settings.model_validate(settings))
            node.subscribe("/say", "std_msgs/String", lambda message: said.append(message.data), latest=False, qos=qos)
            ears = node.advertise("/heard", "std_msgs/String", qos=qos)
            async with rs.Context(storyteller, robot, settings={"ros2": settings}) as context:
                await until(lambda: bus.find("subscriber", "/heard") and bus.find("subscriber", "/say"))
                for number in (1, 2):
                    answer = asyncio.ensure_future(context.next(rawio.output.changed))
                    ears.publish("Enough.")
                    assert await answer == "Good night."
                    await until(lambda: len(said) == number)  # noqa: B023
            await node.close()
        assert said == ["Good night.", "Good night."]

    asyncio.run(talk())


def test_the_class_telephone_has_every_method_of_rawio_line() -> None:
    telephone = import_module("telephone").Telephone
    assert {name for name in vars(rawio.Line) if not name.startswith("_")} <= set(dir(telephone))


def test_cancelling_say_ends_the_program_that_speaks(tmp_path: Path) -> None:
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
        asyncio.run(interrupt())  # would hang if the program did not end
