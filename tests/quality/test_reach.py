"""The floors of language understanding, on sets that are never used for tuning."""

from __future__ import annotations

import pytest

from quality import modules
from quality.measure import measure


@pytest.mark.parametrize(
    ("name", "share", "least"),
    [
        ("triples", "exact", 0.90),
        ("yesno", "right", 0.95),
        ("questions", "right", 0.95),
        ("agentqa", "F1", 0.95),
        ("emotions", "right", 0.80),
        ("genqa", "answered right", 0.50),
    ],
)
def test_text_is_understood(name: str, share: str, least: float) -> None:
    result = measure(name, getattr(modules, name))
    assert result.shares[share] >= least, "\n".join(result.misses)


def test_what_is_said_as_sure_is_seldom_wrong() -> None:
    result = measure("genqa", modules.genqa)
    assert result.shares["wrong of the sure"] <= 0.05, "\n".join(result.misses)
