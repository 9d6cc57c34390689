"""A faulty goal raises an error at its declaration, and the message says what to write."""

from typing import Any

import pytest

import ravestate as rs
from ravestate.modules import agenda, rawio
from ravestate.modules.skill.agenda.goal import negated, watching

guide = rs.Module("guide", requires=[agenda])
asked = guide.signal("asked")
lit = guide.flag("lit")
number = guide.slot("number", 3)


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({}, r"say=None and intent=None: give exactly one"),
        ({"say": "a", "intent": "b"}, r"say='a' and intent='b': give exactly one"),
        ({"say": ""}, r"say='': write a text"),
        ({"say": []}, r"say=\[\]: write a text"),
        ({"say": ["a", 3]}, r"write a text, several"),
        ({"say": 3}, r"say=3"),
        ({"say": "a", "priority": 0}, r"priority=0 must be a finite number above 0"),
        ({"say": "a", "priority": True}, r"priority=True"),
        ({"say": "a", "cooldown": -1}, r"cooldown=-1"),
        ({"say": "a", "cooldown": float("inf")}, r"cooldown=inf must be a finite number"),
        ({"say": "a", "tries": 0}, r"tries=0 must be a whole number"),
        ({"say": "a", "tries": 1.5}, r"tries=1\.5"),
        ({"say": "a", "done": "("}, r"done='\(' is not a regular expression"),
        ({"say": "a", "refused": 7}, r"refused=7 is neither"),
        ({"say": "a", "done": number}, r"write done=guide:number\.changed"),
        ({"say": "a", "unless": asked}, r"contains a signal: write unless=slot\.holds"),
    ],
)
def test_a_faulty_goal_is_refused(arguments: dict[str, Any], message: str) -> None:
    module = rs.Module("guide", requires=[agenda])
    with pytest.raises(rs.DeclarationError, match=message):
        agenda.goal(module, "goal", **arguments)
    assert module.rules == []


def test_a_module_that_does_not_require_the_agenda_is_reported() -> None:
    module = rs.Module("forgetful", requires=[rawio])
    agenda.goal(module, "goal", say="a")
    with pytest.raises(rs.DeclarationErrors) as caught:
        rs.compile(module)
    assert any("requires=[agenda]" in str(fault) for fault in caught.value.exceptions)


def test_negation_follows_de_morgan() -> None:
    both = negated(lit.holds(bool) & number.holds(bool))
    assert str(both) == "guide:lit.holds(not_bool) | guide:number.holds(not_bool)"
    either = negated(lit.holds(bool) | number.holds(bool))
    assert str(either) == "guide:lit.holds(not_bool) & guide:number.holds(not_bool)"


def test_the_function_watching_detaches_every_signal_and_keeps_ages_and_predicates() -> None:
    condition = watching(asked & lit.true.min_age(2) & number.holds(bool) | lit.false)
    assert str(condition) == (
        "guide:asked.max_age(None).detached() & guide:lit:true.min_age(2.0).detached() & guide:number.holds(bool) | "
        "guide:lit:false.max_age(None).detached()"
    )
