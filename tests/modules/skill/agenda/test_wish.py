"""Goals that come from the settings, for example from an agent's file."""

import logging
from typing import Any

import pytest

import ravestate as rs
from ravestate.modules import agenda, rawio
from ravestate.testing import Simulation, simulate


def agent(*wishes: dict[str, Any], **settings: Any) -> Simulation:
    return simulate(agenda, settings={"agenda": {"goals": wishes, **settings}, "idle": {"remarks": 100}})


def test_goals_in_the_settings_are_pursued_like_goals_in_code() -> None:
    with agent(
        {"name": "ice_cream", "say": "Do you know my ice cream?"},
        {"name": "game", "say": ["A game?", "Come on!"], "priority": 2, "done": "yes|sure", "tries": 2},
        gap=0,
    ) as sim:
        sim.advance(18.0)
        assert sim.said == ["A game?", "Do you know my ice cream?"]
        sim.advance(60.0)
        assert sim.said[2:] == ["Come on!"]
        sim.say("sure")
        states = {name: state.status for name, state in sim.read(agenda.goals).items()}
        assert states == {"agenda:game": "done", "agenda:ice_cream": "done"}
        assert sim.explain("agenda:game").retired
    assert not sim.failures


@pytest.mark.parametrize(
    ("wish", "message"),
    [
        ({"name": "a b", "say": "x"}, "agenda.goals.0.name = 'a b'"),
        ({"name": "a"}, "agenda.goals.0.say"),
        ({"name": "a", "say": ""}, "agenda.goals.0.say"),
        ({"name": "a", "say": []}, "agenda.goals.0.say"),
        ({"name": "a", "say": "x", "done": "("}, "is not a regular expression"),
        ({"name": "a", "say": "x", "done": "(?i)yes"}, "global flags not at the start"),
        ({"name": "a", "say": "x", "done": "yes)|(no"}, "is not a regular expression"),
        ({"name": "a", "say": "x", "done": True}, 'write "yes"'),
        ({"name": "a", "say": "x", "refused": False}, 'write "no"'),
        ({"name": "a", "say": "x", "priority": 0}, "agenda.goals.0.priority = 0"),
        ({"name": "a", "say": "x", "cooldown": 0}, "agenda.goals.0.cooldown = 0"),
        ({"name": "a", "say": "x", "priority": float("inf")}, "agenda.goals.0.priority = inf"),
        ({"name": "a", "say": "x", "cooldown": float("inf")}, "agenda.goals.0.cooldown = inf"),
        ({"name": "a", "say": "x", "wish": 1}, "no such setting"),
    ],
)
def test_a_faulty_goal_in_the_settings_is_refused_before_the_agent_runs(wish: dict[str, Any], message: str) -> None:
    with pytest.raises(rs.DeclarationErrors) as caught:
        agent(wish)
    assert any(message in str(fault) for fault in caught.value.exceptions)


def test_two_goals_with_the_same_name_are_refused() -> None:
    with pytest.raises(rs.DeclarationErrors) as caught:
        agent({"name": "a", "say": "x"}, {"name": "a", "say": "y"})
    assert "two goals are named 'a'" in str(caught.value.exceptions[0])


def test_a_goal_with_the_name_of_a_rule_is_reported_and_the_agent_keeps_running(
    caplog: pytest.LogCaptureFixture,
) -> None:
    with (
        caplog.at_level(logging.CRITICAL, "ravestate"),
        agent({"name": "take_initiative", "say": "x"}) as sim,
    ):
        [(rule, error)] = sim.failures
        assert rule == "agenda:adopt_wishes"
        assert isinstance(error, rs.DeclarationErrors)
        sim.say("hello")
        sim.advance(20.0)
        assert sim.said == []
        assert sim.read(rawio.input) == "hello"
