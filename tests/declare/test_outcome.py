"""The outcomes that a rule can return or raise."""

import pytest

import ravestate as rs


@pytest.mark.parametrize("outcome", [rs.Resign, rs.Retire])
def test_an_outcome_carries_its_reason_and_can_be_raised(outcome: type[rs.Resign] | type[rs.Retire]) -> None:
    assert (outcome("no need").reason, str(outcome("no need")), outcome().reason) == (
        "no need",
        "no need",
        "",
    )
    with pytest.raises(rs.RavestateError, match="no need"):
        raise outcome("no need")
