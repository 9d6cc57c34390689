"""``ravestate ros check``, ``topics`` and ``echo`` on the built-in bus.

The tests in ``tests/modules/platform/ros`` use real networks.
"""

import asyncio
import json
import threading
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from ravestate.cli import main
from ravestate.modules import ros2
from ravestate.modules.platform.ros import Bus, quality

AGENT = """
import ravestate as rs
from ravestate.modules import ros2

module = rs.Module("agent", requires=[ros2])
chat = ros2.subscriber(module, "chat", topic="/chat", type="std_msgs/String")
number = ros2.subscriber(module, "number", topic="/chat", type="std_msgs/Int32")
lamp = ros2.service(module, "lamp", service="/lamp", type="std_srvs/SetBool")
lost = ros2.publisher(module, "lost", topic="/lost", type="std_msgs/String")
own = ros2.publisher(module, "own", topic="/own", type="own_msgs/Thing")
"""


@pytest.fixture(scope="module")
def bus() -> Iterator[str]:
    """Run a bus in a thread, with a node that publishes the topic /chat and offers the service /lamp."""
    started, address, stop = threading.Event(), [""], threading.Event()

    async def serve(_: Any) -> dict[str, Any]:
        return {"success": True}

    async def world() -> None:
        async with Bus(0) as made:
            node = ros2.make_node(ros2.Settings(backend="bus", bus=made.address))
            chat = node.advertise("/chat", "std_msgs/String", latch=True, qos=quality("latched", depth=1, latch=True))
            chat.publish("hello")
            scan = node.advertise(
                "/scan", "sensor_msgs/LaserScan", latch=True, qos=quality("latched", depth=1, latch=True)
            )
            scan.publish({"range_max": float("inf"), "ranges": [float("nan"), 1.5] + [float("-inf")] * 98})
            node.offer("/lamp", "std_srvs/SetBool", serve)
            await node.ready.wait()
            address[0] = made.address
            started.set()
            await asyncio.to_thread(stop.wait)
            await node.close()

    thread = threading.Thread(target=asyncio.run, args=(world(),))
    thread.start()
    assert started.wait(20)
    yield address[0]
    stop.set()
    thread.join()


@pytest.fixture(autouse=True)
def one_look(monkeypatch: pytest.MonkeyPatch) -> None:
    """Let the commands look for nodes only once. On the bus, discovery takes no time."""
    monkeypatch.setattr("ravestate.cli.ros.LOOKS", 1)
    monkeypatch.setattr("ravestate.modules.platform.ros.checking.LOOKS", 1)


def ros(bus: str, *arguments: str) -> int:
    return main(["ros", *arguments, "--set", "ros2.backend=bus", "--set", f"ros2.bus={bus}"])


def test_the_action_check_lists_the_bound_slots_and_says_how_to_fix_faults(
    bus: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "agent.py").write_text(AGENT)
    assert ros(bus, "check", str(tmp_path / "agent.py")) == 1
    assert capsys.readouterr().out.splitlines() == [
        "ok       agent:chat    subscriber of /chat (std_msgs/String): 1 publisher",
        "FAULT    agent:number  subscriber of /chat (std_msgs/Int32): the other end has std_msgs/msg/String: write "
        "type='std_msgs/String'",
        "ok       agent:lamp    service of /lamp (std_srvs/SetBool): 1 server",
        "FAULT    agent:lost    publisher of /lost (std_msgs/String): no subscribers; this type is used by /chat: "
        "set `remap`, or write the name that you mean",
        "FAULT    agent:own     publisher of /own (own_msgs/Thing): there is no definition of own_msgs/msg/Thing: install "
        "its package, or name its file in ros2.definitions",
    ]


def test_the_action_check_looks_for_each_part_of_a_robot(bus: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["ros", "check", "roboyio", "--set", "roboyio.robot=turtlebot", "--set", f"roboyio.bus={bus}"]) == 1
    lines = capsys.readouterr().out.splitlines()
    assert [line.split()[1] for line in lines] == [
        f"roboyio:{part}" for part in ("hear", "direction", "people", "speak", "express", "yaw")
    ]
    assert "roboyio:speak      publisher of /speech/say (std_msgs/String): no subscribers" in lines[3]


def test_the_action_topics_lists_topics_and_services(bus: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert ros(bus, "topics", "--version", "2") == 0
    assert capsys.readouterr().out.splitlines() == [
        "topic    /chat  std_msgs/msg/String  1 publisher, 0 subscribers",
        "topic    /scan  sensor_msgs/msg/LaserScan  1 publisher, 0 subscribers",
        "service  /lamp  std_srvs/srv/SetBool  1 server",
    ]


def test_the_action_echo_prints_messages(bus: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert ros(bus, "echo", "/chat", "-n", "1") == 0
    assert json.loads(capsys.readouterr().out) == {"data": "hello"}


def test_the_action_echo_writes_null_for_numbers_that_json_lacks(bus: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert ros(bus, "echo", "/scan", "-n", "1") == 0

    def refuse(constant: str) -> None:
        raise AssertionError(f"{constant} is not JSON")

    message = json.loads(capsys.readouterr().out, parse_constant=refuse)
    assert message["range_max"] is None
    assert message["ranges"] == [None, 1.5, None, None, None, None, None, None, "... 100 values"]


def test_the_message_for_an_unknown_topic_suggests_the_nearest_name(
    bus: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert ros(bus, "echo", "/chatt", "--version", "2") == 1
    assert "there is no topic /chatt; did you mean '/chat'?" in capsys.readouterr().err


def test_without_ros_check_says_what_to_install(capsys: pytest.CaptureFixture[str]) -> None:
    code = main(["ros", "check", "--set", "ros1.python=/nowhere/1", "--set", "ros2.python=/nowhere/2"])
    out = capsys.readouterr().out
    assert code == 1
    assert "MISSING  ros1: cannot start '/nowhere/1'" in out and "MISSING  ros2: cannot start '/nowhere/2'" in out
