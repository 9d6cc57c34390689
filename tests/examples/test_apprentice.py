"""The apprentice adds rules to a running context, and retires them again."""

import ravestate as rs
from examples.loading import example
from ravestate.testing import simulate

apprentice = example("apprentice")
PUZZLED = "Nobody has told me what to say to that."


def answers(sim, *lines: str) -> list[str]:
    for line in lines:
        sim.say(line)
    return sim.said


def test_a_word_is_learnt_and_forgotten() -> None:
    with simulate(apprentice) as sim:
        said = answers(sim, "Ping", "When I say ping, answer Pong!", "Ping", "Forget ping.", "Ping")
        assert said == [PUZZLED, "Understood.", "Pong!", "ping is forgotten.", PUZZLED]


def test_a_forgotten_word_may_be_learnt_anew() -> None:
    with simulate(apprentice) as sim:
        answers(sim, "When I say ping, answer one", "Forget ping", "When I say ping, answer two")
        assert answers(sim, "ping")[-1] == "two"


def test_another_context_has_learnt_nothing() -> None:
    policy = rs.compile(apprentice)
    with simulate(policy) as first:
        answers(first, "When I say ping, answer pong", "ping")
    with simulate(policy) as second:
        assert answers(second, "ping") == [PUZZLED]
    assert len(policy.rules) == len(apprentice.module.rules)
