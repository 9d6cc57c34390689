"""Facts about the user for modules that do not need persqa."""

from pathlib import Path

import pytest

from ravestate.modules import interloc, persqa
from ravestate.testing import simulate

pytestmark = pytest.mark.usefixtures("reader")


def test_known_facts_about_the_user_are_shared(file: Path) -> None:
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
