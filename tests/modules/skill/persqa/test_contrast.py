"""Properties of every correction, such as "Leipzig, not Leeds".

The quality set ``changes_rows`` measures how many wordings are understood.
"""

from __future__ import annotations

from pathlib import Path

import pytest

import ravestate as rs
from modules.skill.persqa.conftest import Look
from modules.skill.persqa.test_scenarios import agent, answers
from ravestate.modules import persqa, rawio
from ravestate.modules.meta.nlp.analysis import analyse
from ravestate.modules.meta.nlp.pipeline import pipeline
from ravestate.modules.skill.persqa.profile import learn
from ravestate.modules.skill.persqa.talk import Talk
from ravestate.modules.skill.persqa.told import Told
from ravestate.modules.skill.persqa.topics import NAME
from ravestate.modules.skill.persqa.understanding import Meaning, understand
from ravestate.modules.skill.persqa.wording import Facts

pytestmark = pytest.mark.usefixtures("reader")

ADA: dict[str, tuple[str, ...]] = {
    "name": ("Ada",), "home": ("Leeds",), "age": ("15",), "employer": ("Bosch",), "favourite food": ("pizza",),
    "sister": ("Nora",), "cat": ("Minka",), "hobby": ("chess", "sewing"),
}  # fmt: skip


def meaning(text: str, known: Facts, talk: Talk | None = None, told: tuple[Told, ...] = ()) -> Meaning:
    return understand(analyse(text, pipeline("")), talk or Talk(), known, now=1.0, within=90.0, told=told)


def after(text: str, known: Facts = ADA, talk: Talk | None = None) -> dict[str, tuple[str, ...]]:
    """Return the facts that an utterance changes, with their new values."""
    found = meaning(text, known, talk)
    now = {**learn(known, found.facts).facts} if found.kind in ("told", "corrected") else dict(known)
    now[NAME] = next((one.values for one in found.facts if one.topic == NAME and not one.gone), known.get(NAME, ()))
    return {topic: now.get(topic, ()) for topic in {**known, **now} if now.get(topic, ()) != known.get(topic, ())}


NEW = {"home": "Leipzig", "age": "16", "employer": "Siemens", "favourite food": "pasta", "sister": "Cora", "cat": "Mina", "name": "Ida"}  # fmt: skip
FRAMES = ("{new}, not {old}", "it's {new}, not {old}", "no, not {old}, {new}", "not {old} but {new}")


@pytest.mark.parametrize("frame", FRAMES)
@pytest.mark.parametrize("topic", NEW)
def test_a_correction_changes_the_fact_whose_value_it_calls_wrong(topic: str, frame: str) -> None:
    """The user can type with or without capitals."""
    for case in (str, str.lower):
        text = case(frame.format(new=NEW[topic], old=ADA[topic][0]))
        assert after(text) == {topic: (NEW[topic],)}, text


def test_only_the_wrong_one_of_several_values_is_replaced() -> None:
    assert after("rowing, not sewing") == {"hobby": ("chess", "rowing")}


@pytest.mark.parametrize("topic", NEW)
def test_a_value_that_was_denied_is_never_stored(topic: str) -> None:
    """This holds for any subject, and also if the agent knows nothing about the user yet."""
    for frame in (*FRAMES, "I said {new}, not {old}", "the fair is in {new}, not {old}", "she likes {new}, not {old}"):
        for known in (ADA, {}):
            found = meaning(frame.format(new=NEW[topic], old="Rostock"), known)
            assert "rostock" not in [value.lower() for fact in found.facts if not fact.gone for value in fact.values]


def test_if_two_facts_share_the_wrong_value_only_the_fact_mentioned_last_changes() -> None:
    both = {"home": ("Leeds",), "birthplace": ("Leeds",)}
    assert after("Hull, not Leeds", both) == {}
    assert after("Hull, not Leeds", both, Talk().mentioning("birthplace", ("Leeds",))) == {"birthplace": ("Hull",)}
    assert after("I was born in Hull, not Leeds", both) == {"birthplace": ("Hull",)}


def test_a_correction_that_names_only_the_new_value_changes_the_only_fact_of_that_kind() -> None:
    two = {"home": ("Leeds",), "origin": ("Ghana",), "age": ("15",)}
    assert after("no, York", two) == {}
    assert after("no, 16", two) == {"age": ("16",)}
    asking = Talk().speaking("Where was the game?")  # the last question is another module's
    assert after("no, York", ADA, asking) == {}


def test_a_relative_of_a_relative_is_not_taken_for_a_relative_of_the_user() -> None:
    assert after("Nora is my brother's wife, not my sister") == {"sister": ()}
    assert after("nora is my brothers wife not my sister") == {"sister": ()}


@pytest.mark.parametrize(
    "text",
    ["I have a dog but no garden", "I have a sister and no time", "Anna is my friend, not my sister", "no, not Leipzig",
     "no, never in Leipzig", "sorry, not Leipzig", "no, not Leeds", "I'm not a nurse today", "I'm not just a nurse"],
)  # fmt: skip
def test_a_denial_of_something_else_removes_no_known_fact(text: str) -> None:
    known = {"home": ("Leeds",), "sister": ("Rosa",), "dog": ("Rex",), "occupation": ("nurse",)}
    changed = after(text, known, Talk().mentioning("home", ("Leeds",)))
    assert not changed.keys() & known.keys(), changed


ROSA = Told("Rosa", "live", "Antwerp", "your sister Rosa lives in Antwerp", who="Rosa")


@pytest.mark.parametrize("text", ["Ghent, not Antwerp", "she lives in Ghent, not Antwerp"])
def test_a_statement_about_a_relative_is_corrected(text: str) -> None:
    found = meaning(text, {"sister": ("Rosa",)}, told=(ROSA,))
    assert ROSA in found.gone
    assert [one.object for one in found.free if one.subject == "Rosa"] == ["Ghent"]
    assert found.facts == ()


def test_a_denied_statement_is_removed() -> None:
    assert meaning("Rosa doesn't live in Antwerp", {"sister": ("Rosa",)}, told=(ROSA,)).gone == (ROSA,)


def test_a_corrected_statement_is_recalled_and_saved(file: Path, look: Look) -> None:
    with agent(file) as sim:
        sim.say("my name is ada")
        sim.say("my sister Rosa lives in Antwerp")
        sim.say("what a day it has been")
        sim.say("she lives in Ghent, not Antwerp")
        assert "Ghent" in answers(sim, "where does Rosa live?")
        assert sim.failures == []
    assert look()["Ada"]["has_told"] == ["your sister Rosa lives in Ghent"]


def test_the_user_can_correct_a_fact_that_another_module_mentions(file: Path) -> None:
    module = rs.Module("fan", requires=[rawio])

    @module.rule(when=rawio.input.changed, writes=rawio.output, weight=9.0)
    async def praise(ctx: rs.RuleContext) -> rs.Resign | None:
        if "football" not in ctx.payload(rawio.input.changed):
            return rs.Resign("another topic")
        ctx[rawio.output] = "You must see many games in Leeds, then?"
        return None

    with agent(file, module) as sim:
        for text in (
            "I come from Ghana",
            "I live in Leeds",
            "I like tea",
            "what a day",
            "it rains again",
            "what about the football",
        ):
            sim.say(text)
        sim.say("no, Leipzig")
        known = dict(sim.read(persqa.facts))
    assert (known["home"], known["origin"]) == (("Leipzig",), ("Ghana",))
