"""The complete agent without a language model still answers the conversations in talks_rows.tsv well."""

from __future__ import annotations

from pathlib import Path

import pytest

from quality.talks import FLOORS, measured


@pytest.mark.parametrize("cause", FLOORS)
def test_the_share_of_fitting_answers_stays_above_the_floor(cause: str, tmp_path: Path) -> None:
    result = measured(cause, tmp_path)
    assert result.shares["right"] >= FLOORS[cause], "\n".join(result.misses)
