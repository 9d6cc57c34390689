"""Forgetting a person: the agent's answers, and the effects on memory and on other modules."""

from __future__ import annotations

from pathlib import Path

import pytest

from modules.skill.persqa.conftest import Look
from modules.skill.persqa.test_scenarios import agent, answers, meant
from ravestate.modules import persqa

pytestmark = pytest.mark.usefixtures("reader")


def files_of(file: Path) -> bytes:
    return b"".join(one.read_bytes() for one in sorted(file.parent.iterdir()) if one.is_file())


def test_nothing_of_a_forgotten_person_stays_on_disk(file: Path) -> None:
    with agent(file) as sim:
        sim.say("my name is Zwentibold and i live in Quakenbrueck")
        sim.say("my sister is called Ermintrude")
        sim.say("I painted a basilisk")
    assert all(word in files_of(file) for word in (b"Zwentibold", b"Quakenbrueck", b"Ermintrude", b"basilisk"))
    with agent(file) as sim:
        sim.say("my name is Zwentibold")
        said = answers(sim, "forget me")
        assert meant(said, "forget_ask") and "your home" in said and "your sister" in said and "1 other thing" in said
        said = answers(sim, "yes")
        assert meant(said, "forgotten") and "your home" in said
        assert "persqa:listen" in sim.fired and dict(sim.read(persqa.told)) == {}
    left = files_of(file)
    assert not any(word in left for word in (b"Zwentibold", b"Quakenbrueck", b"Ermintrude", b"basilisk"))


def test_the_agent_asks_whom_to_forget_if_it_has_not_recognised_the_user(file: Path, look: Look) -> None:
    with agent(file) as sim:
        sim.say("my name is ada and i live in hannover")
    with agent(file, confirm=True) as sim:
        assert meant(answers(sim, "please forget me"), "forget_who")
        assert meant(answers(sim, "ada"), "vouch_home")
        assert meant(answers(sim, "hannover"), "forget_ask")
        assert meant(answers(sim, "yes"), "forgotten")
    assert look() == {}


def test_a_user_cannot_make_the_agent_forget_another_person(file: Path, look: Look) -> None:
    with agent(file) as sim:
        sim.say("my name is ada and i live in hannover")
    with agent(file, confirm=True) as sim:
        sim.say("forget me")
        sim.say("ada")
        assert meant(answers(sim, "bremen"), "forget_nobody")
    assert look()["Ada"] == {"lives_in": ["Hannover"]}


def test_other_modules_learn_that_a_person_was_forgotten(file: Path) -> None:
    import ravestate as rs

    listener = rs.Module("listener", requires=[persqa])
    heard = listener.slot("heard", False)

    @listener.rule(when=persqa.forgotten.detached(), writes=heard)
    async def hear(ctx: rs.RuleContext) -> None:
        ctx[heard] = True

    with agent(file, listener) as sim:
        sim.say("my name is ada")
        sim.say("forget me")
        assert not sim.read(heard)
        sim.say("yes")
        assert sim.read(heard)


@pytest.mark.parametrize(
    "text",
    [
        "actually, keep my name",
        "please keep it",
        "do what you like",
        "I love it here",
        "I guess so",
        "yes, but keep my name",
        "forget it",
        "ok, no",
        "ok, stop",
        "yes, leave it",
        "you can stop",
        "you bet it's late",
    ],
)
def test_only_a_plain_yes_deletes_anything(file: Path, look: Look, text: str) -> None:
    with agent(file) as sim:
        sim.say("my name is ada and i live in hannover")
        assert meant(answers(sim, "forget me"), "forget_ask")
        sim.say(text)
    assert look() == {"Ada": {"lives_in": ["Hannover"]}}
