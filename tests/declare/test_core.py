"""The built-in signals and flags (L22)."""

import ravestate as rs
from ravestate.declare.core import core


def test_core_declares_its_signals_and_flags_and_no_rules() -> None:
    assert core.signals == [rs.startup, rs.shutdown, rs.error]
    assert core.slots == [rs.activity, rs.pressure]
    assert core.rules == []
    assert [s.name for s in core.signals] == ["core:startup", "core:shutdown", "core:error"]


def test_everything_in_core_is_an_input() -> None:
    assert all(signal.input for signal in core.signals)
    assert all(signal.input and signal.keep == "latest" for slot in core.slots for signal in slot.signals)


def test_a_failure_names_rule_and_exception() -> None:
    error = ValueError("x")
    failure = rs.RuleFailure("m:r", error)
    assert (failure.rule, failure.exception) == ("m:r", error)
