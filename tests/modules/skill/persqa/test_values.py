"""The words that can be a value, and the spelling of activities."""

import pytest

from ravestate.modules.meta.nlp.analysis import analyse
from ravestate.modules.meta.nlp.pipeline import pipeline
from ravestate.modules.skill.persqa.topics import TOPICS
from ravestate.modules.skill.persqa.values import gerund, value_of

pytestmark = pytest.mark.usefixtures("reader")


@pytest.mark.parametrize(
    ("verb", "activity"),
    [
        ("edit films", "editing films"),
        ("open shops", "opening shops"),
        ("visit museums", "visiting museums"),
        ("read books", "reading books"),
        ("bake bread", "baking bread"),
        ("run marathons", "running marathons"),
        ("knit socks", "knitting socks"),
        ("forget names", "forgetting names"),
    ],
)
def test_only_stressed_syllables_double_the_last_letter(verb: str, activity: str) -> None:
    assert gerund(f"to {verb}", analyse(f"I like to {verb}.", pipeline(""))) == activity


@pytest.mark.parametrize("text", ["हिन्दी", "हिन्दी!", "«हिन्दी» ❤️"])
def test_a_name_keeps_the_sign_on_its_last_letter(text: str) -> None:
    assert value_of(text, TOPICS["name"], analyse("I am Ada.", pipeline(""))) == "हिन्दी"
