"""`keep_latest` keeps only the latest entries of a cache."""

from ravestate.language.recent import keep_latest


def test_the_oldest_entries_are_dropped() -> None:
    kept = {"a": 1, "b": 2, "c": 3}
    keep_latest(kept, {"d": 4}, 3)
    assert list(kept.items()) == [("b", 2), ("c", 3), ("d", 4)]


def test_an_entry_that_is_added_again_counts_as_new() -> None:
    kept = {"a": 1, "b": 2, "c": 3}
    keep_latest(kept, {"a": 5, "d": 4}, 3)
    assert list(kept.items()) == [("c", 3), ("a", 5), ("d", 4)]


def test_if_there_are_too_many_new_entries_the_last_ones_are_kept() -> None:
    kept = {"a": 1}
    keep_latest(kept, {"b": 2, "c": 3, "d": 4}, 2)
    assert kept == {"c": 3, "d": 4}
