"""Phrases with alternatives."""

import pytest

from ravestate.modules.meta.nlp.pattern import phrases


@pytest.mark.parametrize(
    ("patterns", "expected"),
    [
        ("yes; of course", ["yes", "of course"]),
        ("(it|that) is (|very) good", ["it is good", "it is very good", "that is good", "that is very good"]),
        ("; ;\n yes ;", ["yes"]),
        ("(|so)", ["so"]),
        ("", []),
    ],
)
def test_patterns(patterns: str, expected: list[str]) -> None:
    assert [" ".join(phrase) for phrase in phrases(patterns)] == expected
