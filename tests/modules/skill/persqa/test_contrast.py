"""A correction such as "Leipzig, not Leeds" changes the fact with the wrong value, even if other talk came between."""

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


@pytest.mark.parametrize(
    ("text", "topic", "values"),
    [
        ("Leipzig, not Leeds", "home", ("Leipzig",)),
        ("leipzig not leeds", "home", ("Leipzig",)),
        ("it's Leipzig, not Leeds", "home", ("Leipzig",)),
        ("its leipzig not leeds", "home", ("Leipzig",)),
        ("not leeds but leipzig", "home", ("Leipzig",)),
        ("no, not Leeds, Leipzig", "home", ("Leipzig",)),
        ("I said Leipzig, not Leeds", "home", ("Leipzig",)),
        ("it's not Leeds, it's Leipzig", "home", ("Leipzig",)),
        ("I live in Leipzig not Leeds", "home", ("Leipzig",)),
        ("no, it's Leipzig", "home", ("Leipzig",)),
        ("nope. York", "home", ("York",)),
        ("nah its york", "home", ("York",)),
        ("my cat is Mina, not Minka", "cat", ("Mina",)),
        ("my cats name is mina not minka", "cat", ("Mina",)),
        ("the cat is Mina, not Minka", "cat", ("Mina",)),
        ("mina not minka", "cat", ("Mina",)),
        ("her name is Cora, not Nora", "sister", ("Cora",)),
        ("Cora not Nora is my sister", "sister", ("Cora",)),
        ("im 16 not 15", "age", ("16",)),
        ("wait no im 16 not 15", "age", ("16",)),
        ("16, not 15", "age", ("16",)),
        ("siemens not bosch", "employer", ("Siemens",)),
        ("it's pasta, not pizza", "favourite food", ("pasta",)),
        ("rowing, not sewing", "hobby", ("chess", "rowing")),
        ("my name is Ida not Ada", "name", ("Ida",)),
        ("ida, not ada", "name", ("Ida",)),
    ],
)
def test_a_correction_changes_the_fact_that_has_the_wrong_value(text: str, topic: str, values: tuple[str, ...]) -> None:
    assert after(text) == {topic: values}


@pytest.mark.parametrize(
    "text",
    [
        "Rome, not Paris",
        "it's Rome, not Paris",
        "mine is St Pauli",
        "mine is Schalke",
        "Berlin, not Leeds, hosts the fair",
        "the train goes to Hull, not Leeds",
        "she lives in Hull, not Leeds",
        "my sister's cat is Mina, not Minka",
        "no, page 31",
        "no, thanks, tea please",
        "that's Minka Kelly, not Minka",
        "I'm not just 15",
    ],
)
def test_a_contrast_that_concerns_no_fact_changes_nothing(text: str) -> None:
    assert after(text) == {}


def test_a_wrong_value_of_two_facts_is_corrected_only_in_the_fact_mentioned_last() -> None:
    both = {"home": ("Leeds",), "birthplace": ("Leeds",)}
    assert after("Hull, not Leeds", both) == {}
    assert after("Hull, not Leeds", both, Talk().mentioning("birthplace", ("Leeds",))) == {"birthplace": ("Hull",)}
    assert after("I was born in Hull, not Leeds", both) == {"birthplace": ("Hull",)}


def test_a_correction_without_the_wrong_value_changes_the_only_fact_of_its_kind() -> None:
    two = {"home": ("Leeds",), "origin": ("Ghana",), "age": ("15",)}
    assert after("no, York", two) == {}
    assert after("no, 16", two) == {"age": ("16",)}
    asking = Talk().speaking("Where was the game?")  # the last question is another module's
    assert after("no, York", ADA, asking) == {}


@pytest.mark.parametrize(
    "text",
    ["nah i'm good", "no comment", "no im joking", "no, never", "I said goodbye", "Oh, sorry. Henrike.", "no, page 31"],
)
def test_words_of_another_kind_do_not_replace_the_fact_mentioned_last(text: str) -> None:
    assert after(text, ADA, Talk().mentioning("hobby", ("sewing",))) == {}


@pytest.mark.parametrize("text", ["oh boy", "wrong guy", "no brothers", "sorry, her name is Dina"])
def test_words_that_fit_none_or_several_facts_change_nothing(text: str) -> None:
    assert after(text, {**ADA, "mother": ("Anna",)}) == {}


def test_another_persons_relative_is_not_the_users_relative() -> None:
    assert after("Nora is my brother's wife, not my sister") == {"sister": ()}
    assert after("nora is my brothers wife not my sister") == {"sister": ()}


ROSA = Told("Rosa", "live", "Antwerp", "your sister Rosa lives in Antwerp", who="Rosa")


@pytest.mark.parametrize(
    "text",
    [
        "Ghent, not Antwerp",
        "she lives in Ghent, not Antwerp",
        "no its ghent not antwerp",
        "Rosa lives in Ghent not Antwerp",
    ],
)
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


def test_a_fact_that_another_module_has_mentioned_can_be_corrected(file: Path) -> None:
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
