"""Recorded bags can be played in virtual time."""

from pathlib import Path
from typing import Any

import pytest
from rosbags.rosbag1 import Writer as Writer1
from rosbags.rosbag2 import Writer as Writer2

import ravestate as rs
from ravestate.errors import PlatformError
from ravestate.modules import ros1, ros2
from ravestate.modules.platform.ros import Types, play
from ravestate.testing import simulate

SECOND = 1_000_000_000
TALK = [(0.0, "hello"), (2.5, "how are you"), (60.0, "bye")]


def record(path: Path, version: int) -> Path:
    """Write a bag with texts on /chat, and numbers on another topic."""
    types = Types(version)  # type: ignore[arg-type]
    writer: Any = Writer1(path) if version == 1 else Writer2(path, version=9)
    with writer:
        chat = writer.add_connection("/chat", "std_msgs/msg/String", typestore=types.store)
        other = writer.add_connection("/other", "std_msgs/msg/Int32", typestore=types.store)
        for time, text in TALK:
            stamp = 1000 * SECOND + int(time * SECOND)
            writer.write(chat, stamp, bytes(types.encode(text, "std_msgs/msg/String")))
            writer.write(other, stamp + 1, bytes(types.encode(3, "std_msgs/msg/Int32")))
    return path


def listener(ros: Any) -> tuple[rs.Module, rs.Slot[Any]]:
    agent = rs.Module("agent", requires=[ros])
    chat = ros.subscriber(agent, "chat", topic="/chat", type="std_msgs/String", keep="all")
    said = agent.slot("said", (), type=tuple)

    @agent.rule(when=chat.changed, writes=said)
    async def answer(ctx: rs.RuleContext) -> None:
        await ctx.sleep(1.0)
        ctx[said] = (*ctx[said], (round(ctx.now, 6), ctx.payload(chat.changed).data))

    return agent, said


@pytest.mark.parametrize("version", [1, 2])
def test_playing_a_bag_twice_gives_the_same_trace(tmp_path: Path, version: int) -> None:
    bag = record(tmp_path / ("talk.bag" if version == 1 else "talk"), version)
    runs: list[list[str]] = []
    for _ in range(2):
        agent, said = listener(ros1 if version == 1 else ros2)
        with simulate(agent) as sim:
            assert play(sim, bag) == 3
            sim.advance(2.0)
            assert sim.read(said) == tuple((time + 1.0, text) for time, text in TALK)
            runs.append([repr(record) for record in sim.trace])
    assert runs[0] == runs[1]


def test_a_bag_without_a_topic_of_the_agent_is_refused_with_a_reason(tmp_path: Path) -> None:
    bag = record(tmp_path / "talk", 2)
    agent = rs.Module("agent", requires=[ros2])
    ros2.subscriber(agent, "camera", topic="/camera", type="sensor_msgs/Image")
    with simulate(agent) as sim:
        with pytest.raises(PlatformError, match="the bag has /chat, /other; the agent follows /camera"):
            play(sim, bag)
        with pytest.raises(PlatformError, match="there is no bag"):
            play(sim, tmp_path / "none")
        (tmp_path / "bad.bag").write_bytes(b"no bag at all")
        with pytest.raises(PlatformError, match="cannot read the bag"):
            play(sim, tmp_path / "bad.bag")
