"""The storyteller: the user interrupts the story, and later it continues at the same place."""

from examples.loading import example
from ravestate.testing import simulate

storyteller = example("storyteller")
ALL = list(storyteller.STORY)


def test_a_story_is_told_to_its_end() -> None:
    with simulate(storyteller) as sim:
        sim.say("Tell me a story.")
        sim.advance(60)
        assert sim.said == ALL
        assert sim.read(storyteller.told) == 0


def test_the_users_words_interrupt_the_story_and_are_answered_immediately() -> None:
    with simulate(storyteller) as sim:
        sim.say("Tell me a story.")
        sim.advance(4)
        assert sim.read(storyteller.book) is True
        sim.say("Wait.")
        assert sim.said == [*ALL[:2], "Say 'story', and I go on."]
        assert sim.read(storyteller.book) is False
        sim.advance(60)
        assert len(sim.said) == 3


def test_the_story_continues_where_it_was_interrupted() -> None:
    with simulate(storyteller) as sim:
        sim.say("A story, please.")
        sim.advance(4)
        sim.say("Wait.")
        sim.say("The story!")
        sim.advance(60)
        assert sim.said[3:] == ALL[2:]
