"""People come, tell their names, agree or refuse, leave, and are recognised later.

The tests use real vectors and virtual time.
"""

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import pytest

from modules.modality.visionio.photographs import OBAMA, Stage, faces
from ravestate.errors import PlatformError
from ravestate.modules import hibye, interloc, ontology, persqa, rawio, visionio
from ravestate.modules.meta.ontology import Node
from ravestate.modules.meta.ontology.opening import open_memory
from ravestate.modules.modality.visionio import people
from ravestate.testing import simulate

pytestmark = pytest.mark.usefixtures("reader")


@contextmanager
def agent(memory: Path, *modules: Any, **settings: Any) -> Iterator[Any]:
    """Simulate an agent that sees people, greets them, and learns their names."""
    given = {
        "visionio": {"source": "", **settings},
        "ontology": {"path": str(memory)},
        "idle": {"bored_after": 1e6},
    }
    with simulate(hibye.module, persqa.module, visionio.module, *modules, settings=given) as sim:
        yield sim
        assert sim.failures == []


def present(sim: Any) -> list[str | None]:
    return list(sim.read(interloc.users).values())


def meet(sim: Any, stage: Stage, face: str, name: str, *, answer: str = "yes") -> None:
    """Play a stranger who comes, tells their name, and says whether the agent may remember their face."""
    stage.show(sim, face)
    sim.say(f"My name is {name}.")
    stage.show(sim, face, seconds=5)
    assert "emember your face" in sim.said[-1], sim.said
    sim.say(answer)
    stage.show(sim, face)


def remembered(memory: Path) -> dict[str, int]:
    """Return the number of faces of each person in a memory that no agent has open."""
    opened = open_memory(ontology.Settings(path=memory))
    try:
        return {
            str(one.get("name")): len(opened.related(one, people.RELATION).result(20))
            for one in opened.find("Person").result(20)
        }
    finally:
        opened.close().result(20)


def test_a_stranger_is_greeted_without_a_name_and_at_the_next_visit_by_name(memory: Path) -> None:
    stage = Stage()
    with agent(memory) as sim:
        stage.show(sim, "obama")
        assert len(sim.said) == 1 and present(sim) == [None]
        sim.say("My name is Barack.")
        stage.show(sim, "obama", seconds=5)
        assert present(sim) == ["Barack"]
        assert "Barack" in sim.said[-1] and "emember your face" in sim.said[-1]
        assert people_of(sim) == ("Barack",)
        sim.say("yes, of course")
        stage.show(sim, "obama", seconds=1)
        assert "know you" in sim.said[-1]
        stage.empty(sim)
        assert present(sim) == [] and sim.read(visionio.visitors) == {}
        before = len(sim.said)
        stage.show(sim, "obama2")  # another photo of the same man
        assert present(sim) == ["Barack"] and "Barack" in sim.said[before]
    with agent(memory) as sim:
        Stage().show(sim, "obama3")
        assert present(sim) == ["Barack"] and "Barack" in sim.said[0]
        assert sim.read(persqa.who)["name"] == "Barack"


def people_of(sim: Any) -> tuple[str | None, ...]:
    return tuple(one.name for one in sim.read(visionio.visitors).values())


def test_the_signal_named_carries_the_node_in_memory(memory: Path) -> None:
    heard: list[Node] = []
    listener = visionio_listener(heard)
    with agent(memory, listener) as sim:
        stage = Stage()
        stage.show(sim, "obama")
        assert heard == []
        sim.say("I'm Barack")
        stage.show(sim, "obama", seconds=1)
        assert [one["name"] for one in heard] == ["Barack"]
        assert sim.read(persqa.who).id == heard[0].id
    assert remembered(memory) == {"Barack": 0}


def visionio_listener(heard: list[Node]) -> Any:
    import ravestate as rs

    module = rs.Module("listener", requires=[visionio])

    @module.rule(when=visionio.named.max_age(None).detached(), background=True)
    async def note(ctx: rs.RuleContext) -> None:
        heard.append(ctx.payload(visionio.named))

    return module


@pytest.mark.parametrize("answer", ["no", "no, please don't", "I'd rather not"])
def test_no_face_is_kept_after_a_no(memory: Path, answer: str) -> None:
    stage = Stage()
    with agent(memory) as sim:
        meet(sim, stage, "biden", "Joe", answer=answer)
        stage.empty(sim)
        stage.show(sim, "biden")
        assert present(sim) == [None]
    assert remembered(memory) == {"Joe": 0}


def test_the_face_of_a_person_who_does_not_answer_is_not_kept(memory: Path) -> None:
    stage = Stage()
    with agent(memory) as sim:
        stage.show(sim, "biden")
        sim.say("I am Joe")
        stage.show(sim, "biden", seconds=5)
        sim.say("the weather is nice")
        stage.show(sim, "biden", seconds=70, rate=1)
        sim.say("yes")  # too late: the question has expired
        stage.empty(sim)
    assert remembered(memory) == {"Joe": 0}


def test_several_people_are_distinguished(memory: Path) -> None:
    stage = Stage()
    with agent(memory) as sim:
        meet(sim, stage, "obama", "Barack")
        stage.empty(sim)
        meet(sim, stage, "biden", "Joe")
        stage.empty(sim)
        stage.show(sim, "obama3", "biden", "six_1")
        assert sorted(present(sim), key=str) == ["Barack", "Joe", None]
        stage.show(sim, "biden", "six_1", seconds=10, rate=2)
        assert sorted(present(sim), key=str) == ["Joe", None]
        assert len({one.node.id for one in sim.read(visionio.visitors).values()}) == 2


def test_a_face_that_is_lost_for_a_moment_still_belongs_to_the_same_visitor(memory: Path) -> None:
    stage = Stage()
    with agent(memory) as sim:
        stage.show(sim, "six_2")
        before = dict(sim.read(interloc.users))
        stage.empty(sim, seconds=3)
        stage.show(sim, "six_2")
        assert dict(sim.read(interloc.users)) == before and len(sim.said) == 1
        [one] = sim.read(visionio.visitors).values()
        assert one.tracks == {1, 2}


def test_face_vectors_from_another_module_are_used_too(memory: Path) -> None:
    """For example, a robot can have its own face recogniser."""
    ada = Node("Person", {"name": "Ada"})
    with agent(memory) as sim:
        for _ in range(3):
            sim.emit(visionio.facevec, visionio.FaceVec((0.1,) * 128, (10, 20, 50, 50), 1, ada))
            sim.advance(0.2)
        assert present(sim) == ["Ada"] and "Ada" in sim.said[0]


def test_a_face_with_a_time_in_the_future_was_seen_now(memory: Path) -> None:
    """A robot may give the time of its own clock, for example the seconds since 1970."""
    ada = Node("Person", {"name": "Ada"})
    with agent(memory) as sim:
        for _ in range(3):
            sim.emit(visionio.facevec, visionio.FaceVec((0.1,) * 128, (10, 20, 50, 50), 1, ada, time=1e9))
            sim.advance(0.2)
        sim.emit(visionio.looked, visionio.Look(1e9, (640, 480)))
        assert present(sim) == ["Ada"]
        sim.advance(5.0)
        sim.emit(visionio.looked, visionio.Look(sim.now, (640, 480)))
        assert present(sim) == [] and sim.read(visionio.history) == ()


def test_a_face_that_appears_only_for_a_moment_is_not_a_visitor(memory: Path) -> None:
    with agent(memory) as sim:
        stage = Stage()
        stage.show(sim, "obama", seconds=0.4)
        stage.empty(sim)
        assert sim.said == [] and present(sim) == []
        assert sim.read(visionio.history) == ()  # the vectors of the face have been dropped


def test_the_agent_notices_that_another_person_has_taken_someones_place(memory: Path) -> None:
    """The new face appears at the same place, so it has the same track."""
    stage = Stage()
    with agent(memory) as sim:
        meet(sim, stage, "obama", "Barack")
        stage.empty(sim)
        meet(sim, stage, "biden", "Joe")
        stage.empty(sim)
        stage.show(sim, "here=obama")
        assert present(sim) == ["Barack"]
        stage.show(sim, "here=biden", seconds=20, rate=2)
        assert present(sim) == ["Joe"]


def test_the_user_of_another_platform_gets_the_name_of_the_person_in_front_of_the_camera(memory: Path) -> None:
    stage = Stage()
    with agent(memory) as sim:
        meet(sim, stage, "obama", "Barack")
        stage.empty(sim)
    with agent(memory) as sim:
        sim.put(interloc.users, {"page": None})
        stage = Stage()
        stage.show(sim, "obama2")
        assert dict(sim.read(interloc.users)) == {"page": "Barack"}
        assert "Barack" in sim.said[-1]
        assert sim.read(persqa.who)["name"] == "Barack"
        stage.empty(sim)
        assert dict(sim.read(interloc.users)) == {"page": "Barack"}
        stage.show(sim, "biden")  # another person sits down at the page
        assert dict(sim.read(interloc.users)) == {"page": None}
        assert sim.read(persqa.who) is None


def test_a_name_that_the_user_gives_before_the_camera_is_on_applies_to_their_face(memory: Path) -> None:
    with agent(memory) as sim:
        stage = Stage()
        sim.put(interloc.users, {"page": None})
        sim.advance(1)
        sim.say("My name is Barack.")
        sim.advance(2)
        stage.show(sim, "obama")
        assert dict(sim.read(interloc.users)) == {"page": "Barack"}
        assert sim.read(visionio.visitors)["page"].name == "Barack"
        stage.show(sim, "obama", seconds=4)
        assert "emember your face" in sim.said[-1]
        sim.say("yes")
        stage.show(sim, "obama")
        stage.empty(sim)
        stage.show(sim, "biden")  # another person sits down at the page
        assert dict(sim.read(interloc.users)) == {"page": None}
    assert remembered(memory)["Barack"] >= 1


def test_the_name_that_a_platform_gives_a_user_applies_to_their_face(memory: Path) -> None:
    heard: list[Node] = []
    with agent(memory, visionio_listener(heard)) as sim:
        sim.put(interloc.users, {"page": "Barack"})
        stage = Stage()
        stage.show(sim, "obama")
        assert [one["name"] for one in heard] == ["Barack"]
        assert people_of(sim) == ("Barack",)
        assert dict(sim.read(interloc.users)) == {"page": "Barack"}


def test_a_user_can_have_their_face_forgotten(memory: Path) -> None:
    stage = Stage()
    with agent(memory) as sim:
        meet(sim, stage, "obama", "Barack")
        assert remembered_now(sim) == {"Barack": 1}
        sim.say("please forget my face")
        stage.show(sim, "obama")
        assert "face" in sim.said[-1] and remembered_now(sim) == {"Barack": 0}
        stage.empty(sim)
        stage.show(sim, "obama")
        assert present(sim) == [None]
        sim.say("forget my face")
        stage.show(sim, "obama", seconds=1)
        assert "face" in sim.said[-1]


def remembered_now(sim: Any) -> dict[str, int]:
    memory = sim.read(ontology.memory)
    return {
        str(one.get("name")): len(memory.related(one, people.RELATION).result(20))
        for one in memory.find("Person").result(20)
    }


def test_the_request_forget_me_also_removes_the_face(memory: Path) -> None:
    stage = Stage()
    with agent(memory) as sim:
        meet(sim, stage, "obama", "Barack")
        sim.say("forget me")
        stage.show(sim, "obama", seconds=1)
        sim.say("yes")
        stage.show(sim, "obama", seconds=3)
        assert remembered_now(sim) == {}
        assert people_of(sim) == (None,)
        stage.empty(sim)
        stage.show(sim, "obama")
        assert present(sim) == [None]


def test_no_data_of_a_forgotten_face_stays_in_the_files(memory: Path) -> None:
    stage = Stage()
    with agent(memory) as sim:
        meet(sim, stage, "obama", "Barack")
    text = people.packed(faces()["obama"].vector).encode()
    assert any(text in file.read_bytes() for file in memory.parent.iterdir())
    with agent(memory) as sim:
        Stage().show(sim, "obama")
        sim.say("forget my face")
        sim.advance(1)
    assert not any(text in file.read_bytes() for file in memory.parent.iterdir())


def test_a_user_can_have_their_face_remembered(memory: Path) -> None:
    stage = Stage()
    with agent(memory, ask=False) as sim:
        stage.show(sim, "hanks")
        sim.say("remember my face")
        stage.show(sim, "hanks", seconds=1)
        assert "name" in sim.said[-1]
        sim.say("My name is Tom.")
        stage.show(sim, "hanks", seconds=8)
        assert "emember your face" not in sim.said[-1]
        sim.say("remember my face")
        stage.show(sim, "hanks", seconds=1)
        assert remembered_now(sim) == {"Tom": 1}


def test_a_user_can_correct_an_agent_that_takes_them_for_another_person(memory: Path) -> None:
    stage = Stage()
    with agent(memory, threshold=1.0) as sim:  # with so high a threshold, the agent takes all men for one person
        meet(sim, stage, "obama", "Barack")
        stage.empty(sim)
        stage.show(sim, "biden")
        assert present(sim) == ["Barack"]
        sim.say("You have the wrong person.")
        stage.show(sim, "biden", seconds=3)
        assert present(sim) == [None]
        sim.say("My name is Joe")
        stage.show(sim, "biden", seconds=6)
        assert present(sim) == ["Joe"]
        sim.say("yes")
        stage.empty(sim)
        assert remembered_now(sim) == {"Barack": 1, "Joe": 1}


def test_a_user_can_correct_a_wrong_name_for_their_face_in_memory(memory: Path) -> None:
    """The agent moves the face from the person with the wrong name to the person with the right name."""
    stage = Stage()
    with agent(memory) as sim:
        meet(sim, stage, "obama", "Joe")
        stage.empty(sim)
    with agent(memory) as sim:
        stage = Stage()
        stage.show(sim, "obama3")
        assert present(sim) == ["Joe"]
        sim.say("I am not Joe, that is not me.")
        stage.show(sim, "obama3", seconds=3)
        assert sim.said[-1].endswith("?") and present(sim) == [None]
        assert remembered_now(sim) == {"Joe": 0}
        sim.say("Barack")
        stage.show(sim, "obama3", seconds=6)
        assert present(sim) == ["Barack"] and "emember your face" in sim.said[-1]
        sim.say("yes")
        stage.empty(sim)
        stage.show(sim, "obama")
        assert present(sim) == ["Barack"]
        assert remembered_now(sim) == {"Joe": 0, "Barack": 1}


def test_a_user_can_take_back_a_name_that_they_have_told(memory: Path) -> None:
    stage = Stage()
    with agent(memory) as sim:
        meet(sim, stage, "obama", "Joe")
        sim.say("I'm not Joe.")
        stage.show(sim, "obama", seconds=3)
        assert sim.said[-1].endswith("?") and present(sim) == [None]
        assert remembered_now(sim) == {}


def test_two_people_with_equal_names_and_similar_faces_become_one(memory: Path) -> None:
    """The agent did not recognise Barack, for example in bad light, so memory has a second person with his name."""
    stage = Stage()
    with agent(memory) as sim:
        meet(sim, stage, "obama", "Barack")
        stage.empty(sim)
        first = sim.read(ontology.memory).find("Person").result(20)[0]
    with agent(memory, threshold=0.05) as sim:
        stage = Stage()
        stage.show(sim, "obama3")
        assert present(sim) == [None]
        memory_now = sim.read(ontology.memory)
        double = memory_now.create("Person", name="Barack").result(20)
        [key] = sim.read(interloc.users)
        sim.put(interloc.users, {key: interloc.Recognised("Barack", double)})
        sim.say("remember my face")
        stage.show(sim, "obama3", seconds=1)
        everybody = memory_now.find("Person").result(20)
        assert [one.id for one in everybody] == [double.id] != [first.id]
        assert len(memory_now.related(double, people.RELATION).result(20)) == 2


def test_after_visits_the_agent_keeps_new_views_of_a_person_who_agreed(memory: Path) -> None:
    stage = Stage()
    with agent(memory) as sim:
        meet(sim, stage, "obama", "Barack")
        stage.empty(sim)
        for name in (*OBAMA[1:], *OBAMA):
            stage.show(sim, name)
            stage.empty(sim)
        count = remembered_now(sim)["Barack"]
        assert 2 <= count <= len(OBAMA)  # a photo that was shown twice adds no view


def test_without_memory_people_come_and_go_but_have_no_names(tmp_path: Path, caplog: pytest.LogCaptureFixture) -> None:
    blocked = tmp_path / "no"
    blocked.write_text("a file where a folder should be")
    stage = Stage()
    with agent(blocked / "memory.lbug") as sim:
        stage.show(sim, "obama")
        assert present(sim) == [None]
        sim.say("remember my face")
        stage.show(sim, "obama", seconds=1)
        stage.empty(sim)
        assert present(sim) == []


def test_a_missing_camera_is_reported_once_and_the_conversation_continues(
    memory: Path, caplog: pytest.LogCaptureFixture, monkeypatch: pytest.MonkeyPatch
) -> None:
    from ravestate.modules.modality.visionio import watching

    monkeypatch.setattr(watching, "default_camera", lambda: None)
    with agent(memory, source="default") as sim:
        sim.say("hello")
        sim.advance(5)
        assert sim.said
    assert caplog.text.count("there is no camera") == 1


def test_missing_packages_are_reported_with_the_command_that_installs_them(
    memory: Path, caplog: pytest.LogCaptureFixture, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    from ravestate.modules.modality.visionio import eye

    def missing(_: object) -> str:
        raise PlatformError("visionio needs the packages of the eyes: `make eyes` sets them up")

    monkeypatch.setattr(eye, "eyes_python", missing)
    with agent(memory, source=str(tmp_path)) as sim:
        sim.say("hello")
        sim.advance(5)
        assert sim.said
    assert caplog.text.count("`make eyes`") == 1


def test_the_agent_still_answers_when_it_sees_many_faces(memory: Path) -> None:
    stage = Stage()
    everybody = [f"{number}-{name}={name}" for number in range(2) for name in faces()]
    with agent(memory) as sim:
        stage.show(sim, *everybody, seconds=4)
        assert len(sim.read(interloc.users)) == 9  # several photos of a person count as one person
        sim.say("hello")
        stage.show(sim, *everybody, seconds=1)
        assert sim.read(rawio.output)
