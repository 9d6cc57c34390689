"""The game with the real recogniser: from poses, the agent guesses known activities and learns new ones."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import pytest

from modules.modality.activity.performers import performance
from ravestate.modules import activity, charades
from ravestate.testing import Simulation, simulate

pytestmark = pytest.mark.usefixtures("reader")


def act(sim: Simulation, poses: Sequence[activity.Pose]) -> None:
    """Send poses until the agent stops watching."""
    start, index, length = sim.now, 0, poses[-1].at
    while sim.read(charades.game).step in ("counting", "watching"):
        pose = poses[index % len(poses)]
        at = start + length * (index // len(poses)) + pose.at
        sim.advance(max(0.01, at - sim.now))
        sim.emit(activity.posed, activity.Pose(sim.now, pose.points))
        index += 1


def test_the_agent_guesses_an_activity_that_it_sees_and_learns_one_that_the_user_names(tmp_path: Path) -> None:
    settings = {"activity": {"folder": tmp_path}, "emotion": {"emoji": False}}
    with simulate(charades, settings=settings) as sim:
        sim.advance(0.5)
        sim.say("let's play charades")
        sim.say("I'm ready")
        act(sim, performance("rowing", 3))
        assert sim.read(charades.game).ranked[0] == "rowing"
        assert "rowing" in sim.said[-1]
        sim.say("yes")
        sim.say("yes, another one")
        sim.say("ready")
        act(sim, performance("golf", 3))
        assert "What was it?" in sim.said[-1]
        sim.say("I was playing golf")
        assert "playing golf" in sim.said[-1]
        assert "remember" in sim.said[-1]
        assert [file.name for file in tmp_path.iterdir()] == ["playing-golf-1.npz"]
        sim.say("yes")
        sim.say("ready")
        act(sim, performance("golf", 3))
        assert sim.read(charades.game).ranked[:1] == ("playing golf",)
        game = sim.read(charades.game)
        assert (game.agent, game.user) == (1, 1)
