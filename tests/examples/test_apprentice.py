"""The apprentice adds rules to a running context, and retires them later."""

import ravestate as rs
from examples.loading import example
from ravestate.testing import simulate

apprentice = example("apprentice")
PUZZLED = "Nobody has told me what to say to that."


def answers(sim, *lines: str) -> list[str]:
    for line in lines:
        sim.say(line)
    return sim.said


def test_the_apprentice_learns_and_forgets_an_answer_to_a_word() -> None:
    with simulate(apprentice) as sim:
        said = answers(sim, "Ping", "When I say ping, answer Pong!", "Ping", "Forget ping.", "Ping")
        assert said == [PUZZLED, "Understood.", "Pong!", "ping is forgotten.", PUZZLED]


def test_the_apprentice_can_learn_a_forgotten_word_again() -> None:
    with simulate(apprentice) as sim:
        answers(sim, "When I say ping, answer one", "Forget ping", "When I say ping, answer two")
        assert answers(sim, "ping")[-1] == "two"


def test_a_rule_learnt_in_one_context_is_unknown_in_another_context() -> None:
    policy = rs.compile(apprentice)
    with simulate(policy) as first:
        answers(first, "When I say ping, answer pong", "ping")
    with simulate(policy) as second:
        assert answers(second, "ping") == [PUZZLED]
    assert len(policy.rules) == len(apprentice.module.rules)
