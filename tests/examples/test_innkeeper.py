"""The innkeeper: independent rules choose her words, her face and her hands."""

from examples.loading import example
from ravestate.testing import simulate

inn = example("innkeeper")


def state(sim) -> tuple[str, str, str]:
    return sim.said[-1], sim.read(inn.face), sim.read(inn.hands)


def test_an_insulting_order_is_refused_with_a_frown() -> None:
    with simulate(inn) as sim:
        sim.say("An ale, you stupid woman!")
        assert state(sim) == (
            "Say that again and you drink from the trough.",
            "frowning",
            "cross her arms",
        )
        assert {"innkeeper:refuse", "innkeeper:frown"} <= set(sim.fired)
        assert "innkeeper:serve" not in sim.fired


def test_an_order_is_served() -> None:
    with simulate(inn) as sim:
        sim.say("A mead please")
        assert state(sim) == ("Here you are.", "neutral", "pour mead")


def test_praise_makes_the_innkeeper_smile_and_another_rule_answers() -> None:
    with simulate(inn) as sim:
        sim.say("What a lovely inn.")
        assert state(sim) == ("If you say so. Ale, mead or water?", "smiling", "wipe the counter")


def test_the_innkeepers_frown_fades_after_a_while() -> None:
    with simulate(inn, settings={"idle": {"bored_after": 4, "answer_time": 12}}) as sim:
        sim.say("What an awful inn.")
        assert sim.read(inn.face) == "frowning"
        sim.advance(20)  # in this time, the innkeeper waits for an answer to her question
        assert sim.read(inn.face) == "neutral"
