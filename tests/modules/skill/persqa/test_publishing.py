"""persqa writes the facts about the user into a slot of interloc, so other modules need not require persqa."""

from pathlib import Path

import pytest

from ravestate.modules import interloc, persqa
from ravestate.testing import simulate

pytestmark = pytest.mark.usefixtures("reader")


def test_other_modules_can_read_the_facts_about_the_user(file: Path) -> None:
    with simulate(persqa, settings={"ontology": {"path": file}}) as sim:
        sim.say("My name is Tom.")
        sim.say("I live in Hannover.")
        sim.advance(2.0)
        shared = dict(sim.read(interloc.facts))
        assert shared["home"] == ("Hannover",)
        assert shared["name"] == ("Tom",)
        sim.say("I don't live in Hannover any more.")
        sim.advance(2.0)
        assert "home" not in sim.read(interloc.facts)
    assert not sim.failures
