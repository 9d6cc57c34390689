"""`words.py` finds no fault in the repository's prose."""

from repo.words import faults


def test_all_prose_is_plain() -> None:
    found = [str(fault) for fault in faults()]
    assert not found, "\n".join(found)
