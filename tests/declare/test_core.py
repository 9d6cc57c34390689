"""The built-in signals and flags (law L22)."""

import ravestate as rs
from ravestate.declare.core import core


def test_core_declares_its_signals_and_flags_and_no_rules() -> None:
    assert core.signals == [rs.startup, rs.shutdown, rs.error]
    assert core.slots == [rs.activity, rs.pressure]
    assert core.rules == []
    assert [s.name for s in core.signals] == ["core:startup", "core:shutdown", "core:error"]


def test_all_signals_of_core_are_inputs() -> None:
    assert all(signal.input for signal in core.signals)
    assert all(signal.input and signal.keep == "latest" for slot in core.slots for signal in slot.signals)


def test_a_failure_has_the_name_of_the_rule_and_the_exception() -> None:
    error = ValueError("x")
    failure = rs.RuleFailure("m:r", error)
    assert (failure.rule, failure.exception) == ("m:r", error)
