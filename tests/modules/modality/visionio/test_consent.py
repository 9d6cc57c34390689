"""The agent keeps a face only after the person agrees, and forgets it immediately if they ask."""

from pathlib import Path
from typing import Any

import pytest

import ravestate as rs
from modules.modality.visionio.photographs import Stage, faces
from modules.modality.visionio.test_rules import agent, meet, present, remembered, remembered_now
from ravestate.modules import hibye, interloc, persqa, rawio, visionio, wildtalk
from ravestate.modules.meta.ontology import Node
from ravestate.testing import simulate

pytestmark = pytest.mark.usefixtures("reader")


def chatter() -> Any:
    """Return a module that asks about tea when its signal is raised, and this signal."""
    module = rs.Module("chatter", requires=[rawio])
    speak = module.signal("speak", input=True)

    @module.rule(when=speak, writes=rawio.output)
    async def ask(ctx: rs.RuleContext) -> None:
        ctx[rawio.output] = "Do you like tea?"

    return module, speak


def test_a_yes_to_another_question_does_not_permit_the_agent_to_keep_a_face(memory: Path) -> None:
    stage, (module, speak) = Stage(), chatter()
    with agent(memory, module) as sim:
        stage.show(sim, "biden")
        sim.say("I am Joe")
        stage.show(sim, "biden", seconds=5)
        assert "emember your face" in sim.said[-1]
        sim.emit(speak)
        stage.show(sim, "biden", seconds=1)
        assert sim.said[-1] == "Do you like tea?"
        sim.say("yes")
        stage.empty(sim)
    assert remembered(memory) == {"Joe": 0}


def test_only_visionio_answers_if_users_permit_or_request_something_about_their_face(memory: Path) -> None:
    stage = Stage()
    settings = {
        "visionio": {"source": ""},
        "ontology": {"path": str(memory)},
        "wildtalk": {"backend": "listen"},
        "idle": {"bored_after": 1e6},
    }
    with simulate(hibye, persqa, wildtalk, visionio, settings=settings) as sim:
        stage.show(sim, "obama")
        sim.say("My name is Barack.")
        stage.show(sim, "obama", seconds=5)
        for text, answer in (("yes", "know you"), ("forget my face", "face"), ("remember my face", "know you")):
            before = len(sim.said)
            sim.say(text)
            stage.show(sim, "obama", seconds=4)
            assert len(sim.said) == before + 1 and answer in sim.said[-1], sim.said[before:]


def test_a_user_whom_the_agent_no_longer_sees_can_have_their_face_forgotten(memory: Path) -> None:
    stage = Stage()
    with agent(memory) as sim:
        sim.put(interloc.users, {"page": None})
        meet(sim, stage, "obama", "Barack")
        stage.empty(sim)
        assert present(sim) == ["Barack"] and sim.read(visionio.visitors) == {}
        sim.say("forget my face")
        sim.advance(2)
        assert "forgotten" in sim.said[-1] or "deleted" in sim.said[-1]
        assert remembered_now(sim) == {"Barack": 0}


def test_the_agent_keeps_no_vector_of_a_stranger_who_has_left(memory: Path) -> None:
    stage = Stage()
    with agent(memory) as sim:
        stage.show(sim, "biden", seconds=3)
        assert sim.read(visionio.history)
        stage.empty(sim)
        assert sim.read(visionio.history) == () and sim.read(visionio.visitors) == {}


def test_the_trace_contains_no_vector_of_a_face(memory: Path) -> None:
    stage = Stage()
    with agent(memory) as sim:
        meet(sim, stage, "obama", "Barack")
        stage.empty(sim)
        text = "\n".join(map(repr, sim.trace))
    assert "Sighting(" in text and "FaceVec(" in text
    assert not any(repr(number) in text for number in faces()["obama"].vector)


def test_with_several_unseen_users_the_agent_forgets_no_face_and_says_why(memory: Path) -> None:
    with agent(memory) as sim:
        sim.put(interloc.users, {"a": interloc.Recognised("Ada", Node("Person", {"name": "Ada"})), "b": None})
        sim.say("forget my face")
        sim.advance(2)
        assert "see you" in sim.said[-1]
