"""The repository's prose stays plain: no faults of the kinds that `words.py` finds."""

from repo.words import faults


def test_all_prose_is_plain() -> None:
    found = [str(fault) for fault in faults()]
    assert not found, "\n".join(found)
