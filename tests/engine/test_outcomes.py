"""The table of outcomes has every possible end of a run (laws L18, L20, L21)."""

from __future__ import annotations

from itertools import product
from typing import get_args

import pytest

from ravestate.engine.effects import CancelReason
from ravestate.engine.outcomes import KINDS, OUTCOMES, verdict
from ravestate.engine.reasons import Outcome

TOLD = ("", *get_args(CancelReason))


def test_the_table_has_a_row_for_each_reason_of_cancellation_with_each_end() -> None:
    assert set(OUTCOMES) == set(product(TOLD, KINDS))
    assert {outcome for row in OUTCOMES.values() for outcome, _ in row} == {*Outcome}


@pytest.mark.parametrize(("told", "ended"), OUTCOMES)
def test_a_run_that_wrote_a_slot_has_answered(told: str, ended: str) -> None:
    assert verdict(told, ended, wrote=True)[1]


@pytest.mark.parametrize("told", TOLD)
def test_a_run_that_resigns_after_a_write_fails(told: str) -> None:
    assert verdict(told, "resigned", wrote=True) == ("failed", True)


@pytest.mark.parametrize("ended", KINDS)
def test_a_run_that_times_out_fails(ended: str) -> None:
    assert verdict("timeout", ended, wrote=False) == ("failed", False)
