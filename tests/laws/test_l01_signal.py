"""L1: a signal is a named kind of event, atomic and transient; an occurrence may carry a payload."""

from typing import Any

import pytest

import ravestate as rs
from laws.short import at_rest, births, hearer


def test_a_signal_is_named_by_its_module() -> None:
    m = rs.Module("m")
    ping = m.signal("ping")
    assert ping.name == "m:ping"
    assert rs.compile(m).signals["m:ping"] is ping


def test_each_occurrence_is_one_event(play: Any) -> None:
    m = rs.Module("m")
    ping, heard = m.signal("ping", payload=int), list[int]()
    hearer(m, "hear", ping, ping, heard)
    with play(m) as sim:
        for number in range(3):
            sim.emit(ping, number)
        assert heard == [0, 1, 2]
        assert len(births(sim, ping)) == 3


@pytest.mark.parametrize("payload", [None, 0, "", False, [], {}, "text", ("a", 1)], ids=repr)
def test_a_payload_arrives_as_it_was_given(play: Any, payload: object) -> None:
    m = rs.Module("m")
    ping, heard = m.signal("ping", payload=object), list[Any]()
    hearer(m, "hear", ping, ping, heard)
    with play(m) as sim:
        sim.emit(ping, payload)
        assert len(heard) == 1
        assert heard[0] is payload


def test_an_occurrence_that_was_handled_is_gone(play: Any) -> None:
    m = rs.Module("m")
    ping = m.signal("ping")
    hearer(m, "hear", ping, ping, [])
    with play(m) as sim:
        sim.emit(ping)
        assert at_rest(sim)


def test_an_occurrence_without_a_listener_is_immediately_gone(play: Any) -> None:
    m = rs.Module("m")
    ping = m.signal("ping")
    with play(m) as sim:
        sim.emit(ping)
        assert at_rest(sim)
