"""The module `hibye` says hello and goodbye, once each, and answers nothing else."""

import pytest

import ravestate as rs
from ravestate.modules import hibye, idle, interloc, rawio
from ravestate.modules.meta.ontology import Node
from ravestate.modules.meta.verbaliser import PhraseBook
from ravestate.testing import Simulation, simulate

PHRASES = PhraseBook.load([hibye.__path__[0] + "/phrases.yaml"])

chatter = rs.Module("chatter", requires=[rawio])


@chatter.rule(when=rawio.input.changed, writes=rawio.output)
async def talk(ctx: rs.RuleContext) -> None:
    ctx[rawio.output] = "chatter"


def phrases(intent: str, **parameters: str) -> set[str]:
    templates = [t for t in PHRASES.templates(intent) if t.parameters <= parameters.keys()]
    return {template.text.format(**parameters) for template in templates}


def only(sim: Simulation) -> str:
    [said] = sim.said
    return said


@pytest.mark.parametrize("seed", range(5))
def test_a_user_hears_hello_on_coming_and_goodbye_on_leaving(seed: int) -> None:
    with simulate(hibye, seed=seed) as sim:
        sim.put(interloc.users, {"door": None})
        assert only(sim) in phrases("greeting")
        sim.said.clear()
        sim.put(interloc.users, {})
        assert only(sim) in phrases("farewell")


def test_a_greeting_can_contain_the_known_name() -> None:
    said: set[str] = set()
    for seed in range(20):
        with simulate(hibye, seed=seed) as sim:
            sim.put(interloc.users, {"door": "Ada"})
            said.add(only(sim))
    assert said <= phrases("greeting", name="Ada")
    assert any("Ada" in text for text in said)


def test_a_user_whom_a_platform_recognises_is_greeted_by_name() -> None:
    """The platform can recognise a user when they come, or later, while they are present without a name."""
    ada = interloc.Recognised("Ada", Node("Person", {"name": "Ada"}))
    for seed in range(5):
        with simulate(hibye, seed=seed) as sim:
            sim.put(interloc.users, {"door": ada})
            assert only(sim) in phrases("recognised", name="Ada") and "Ada" in only(sim)
        with simulate(hibye, seed=seed) as sim:
            sim.put(interloc.users, {"page": None})
            sim.said.clear()
            sim.emit(interloc.recognised, rs.Entry("page", ada))
            assert only(sim) in phrases("recognised", name="Ada")


def test_the_answer_to_hello_and_goodbye_takes_precedence_over_small_talk() -> None:
    with simulate(hibye, chatter) as sim:
        sim.say("Hello!")
        assert only(sim) in phrases("hello")
        sim.say("see you later")
        assert sim.said[1] in phrases("goodbye")
        sim.say("The weather is fine.")
        assert sim.said[2:] == ["chatter"]


def test_each_of_two_users_is_greeted() -> None:
    with simulate(hibye) as sim:
        sim.put(interloc.users, {"one": None, "two": None})
        assert len(sim.said) == 2


def test_the_phrases_are_in_the_language_of_the_setting() -> None:
    german = PhraseBook.load([hibye.__path__[0] + "/phrases.yaml"], "de")
    with simulate(hibye, settings={"verbaliser": {"language": "de-AT"}}) as sim:
        sim.say("Hallo")
        assert only(sim) in {template.text for template in german.templates("hello")}


def test_a_user_hears_goodbye_only_once() -> None:
    with simulate(hibye) as sim:
        sim.put(interloc.users, {"door": None})
        sim.say("bye")
        sim.advance(5.0)
        sim.put(interloc.users, {})
        assert len(sim.said) == 2
        sim.put(interloc.users, {"door": None})
        sim.advance(120.0)
        sim.put(interloc.users, {})
        assert len(sim.said) == 4


def test_a_user_who_was_greeted_hears_no_second_hello() -> None:
    with simulate(hibye) as sim:
        sim.put(interloc.users, {"door": None})
        sim.say("hello")
        assert sim.said[0] in phrases("greeting")
        assert sim.said[1:] and sim.said[1] in phrases("returned")


@pytest.mark.parametrize("present", [{}, {"page": None}])
def test_a_user_whose_hello_was_answered_hears_no_second_hello_when_the_camera_recognises_them(
    present: dict[str, None],
) -> None:
    """Without a platform that adds users, the voice is heard before the camera sees the user."""
    ada = interloc.Recognised("Ada", Node("Person", {"name": "Ada"}))
    with simulate(hibye) as sim:
        sim.put(interloc.users, present)
        sim.advance(120.0)
        sim.said.clear()
        sim.say("hello")
        assert only(sim) in phrases("hello")
        sim.advance(5.0)
        if present:
            sim.emit(interloc.recognised, rs.Entry("page", ada))
        else:
            sim.put(interloc.users, {"visionio:1": ada})
        assert len(sim.said) == 1
        sim.put(interloc.users, {**sim.read(interloc.users), "visionio:2": None})
        assert sim.said[1] in phrases("greeting")  # this is another person


@pytest.mark.parametrize("farewell", ["", "bye"])
def test_a_user_who_comes_after_another_user_has_left_is_greeted(farewell: str) -> None:
    with simulate(hibye) as sim:
        sim.say("hello")
        sim.put(interloc.users, {"door": None})
        assert only(sim) in phrases("hello")
        if farewell:
            sim.advance(5.0)
            sim.say(farewell)
        sim.put(interloc.users, {})
        sim.advance(5.0)
        sim.put(interloc.users, {"door": None})
        assert len(sim.said) == 3 and sim.said[2] in phrases("greeting")


def test_a_user_who_is_recognised_long_after_their_hello_is_greeted_by_name() -> None:
    ada = interloc.Recognised("Ada", Node("Person", {"name": "Ada"}))
    with simulate(hibye) as sim:
        sim.say("hello")
        sim.advance(120.0)
        sim.put(interloc.users, {"door": ada})
        assert sim.said[1] in phrases("recognised", name="Ada")


@pytest.mark.parametrize(
    ("text", "intent"),
    [
        ("good night", "goodnight"),
        ("I'm going to bed", "goodnight"),
        ("see you later", "goodbye"),
    ],
)
def test_a_user_who_goes_to_bed_hears_good_night(text: str, intent: str) -> None:
    with simulate(hibye) as sim:
        sim.say(text)
        assert only(sim) in phrases(intent)


def test_a_sad_user_hears_no_cheerful_goodbye() -> None:
    with simulate(hibye) as sim:
        sim.put(idle.sorrow, 3)
        sim.say("see you later")
        assert only(sim) in phrases("solace")
